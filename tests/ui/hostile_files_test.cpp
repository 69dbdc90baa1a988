// Files from strangers, and programs at the same time: what the built program writes, where, for
// whom, and what it lets reach the terminal.
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "engine/base/text.h"
#include "engine/session/sqlite.h"
#include "grading/marking/session_input.h"
#include "grading/result/result_json.h"
#include "scenarios/operators/simulated_exam.h"
#include "tests/ui/program.h"

namespace cavum::ui {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class HostileFiles : public testing_ui::Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    ASSERT_EQ(run("ledger init " + path("L") + " --school Dentistry").exit_code, 0);
  }
  std::string scenario() const {
    return std::string(CAVUM_SOURCE_DIR) + "/tests/replay/block_cavity.toml";
  }
  std::string ticket_for(const std::string& who, const std::string& out) const {
    return "ledger ticket " + path("L") + " " + scenario() + " --candidate " + who +
           " --from 2020-01-01T00:00Z --until 2190-01-01T00:00Z --out " + path(out);
  }
  testing_ui::Ran sit(const std::string& who, const std::string& out) const {
    return run("exam " + scenario() + " " + who + " --operator expert --quiet --out " + path(out));
  }
  /// A session that holds, with `text` as its verdict, the kind of an event, the candidate and the
  /// device: of a program other than this one.
  void seal_with(const std::string& file, const std::string& text) const {
    scenarios::ExamOptions options;
    options.candidate = options.source.name = text;
    options.position_quantum_mm = OmniModel{}.quantum_mm;
    const auto setup = scenarios::prepare_exam(scenario(), options);
    auto candidate = scenarios::make_simulated_candidate(*setup, "expert", 7, OmniModel{});
    const auto exam = scenarios::Exam::start(*setup, file, candidate.start_mm());
    scenarios::run_exam(*exam, candidate);
    exam->recorder().add_event(1, Announced{{1, text}});
    exam->recorder().flush();
    grading::ExamContexts grounds(*setup);
    const auto graded = grading::load_for_grading(SessionReader(file), exam->tooth_now(), grounds);
    json result = grading::to_json(grading::grade(graded->input(), graded->rubric));
    result["verdict"] = text;
    result["criteria"][0]["id"] = text;
    exam->close(result.dump());
  }
  /// Changes a database as somebody with an SQLite shell would.
  void edit(const std::string& name, const std::string& sql) const {
    Database db = Database::open(path(name), false);
    db.run(sql.c_str());
    EXPECT_GT(db.integer("SELECT total_changes()"), 0) << sql;
  }
  /// What was printed has no command for a terminal in it, and no line that begins with what should
  /// stand within one.
  static void expect_tame(const testing_ui::Ran& r, const std::string& what) {
    for (const std::string& text : {r.out, r.err}) {
      EXPECT_EQ(terminal_text(text), text) << what << ": " << text;
      EXPECT_EQ(text.find('\r'), std::string::npos) << what << ": " << text;
      EXPECT_EQ(("\n" + text).find("\nFORGED"), std::string::npos) << what << ": " << text;
    }
  }
};

TEST_F(HostileFiles, WhatIsTheSchoolsIsItsUsersAloneWhateverTheUmask) {
  const ::mode_t before = ::umask(0);
  ASSERT_EQ(run("ledger init " + path("open/L2") + " --school Dentistry").exit_code, 0);
  ASSERT_EQ(run(ticket_for("4711", "t.ticket")).exit_code, 0);
  write_text_file(path("class.csv"), "id,name\n4712,Bob Ray\n");
  ASSERT_EQ(
      run("ledger ticket " + path("L") + " " + scenario() + " --candidates " + path("class.csv") +
          " --from 2020-01-01T00:00Z --until 2190-01-01T00:00Z --out " + path("tickets"))
          .exit_code,
      0);
  ASSERT_EQ(sit("--ticket " + path("t.ticket"), "s.cavum").exit_code, 0);
  const auto added = run("ledger add " + path("L") + " " + path("s.cavum") +
                         " --simulated --with-findings --receipts " + path("receipts"));
  EXPECT_FALSE(fs::is_empty(path("receipts"))) << added.out << added.err;
  for (const char* format : {"moodle", "lti", "json", "csv"})
    EXPECT_EQ(run("ledger export " + path("L") + " --format " + format + " --out " +
                  path(std::string("export-") + format))
                  .exit_code,
              0);
  EXPECT_EQ(
      run("ledger receipt " + path("L") + " --entry 0 --out " + path("receipt.json")).exit_code, 0);
  EXPECT_EQ(
      run("report " + path("s.cavum") + " --no-replay --out " + path("report.html")).exit_code, 0);
  ::umask(before);

  const fs::path ours = path("");
  std::size_t seen = 0;
  for (const auto& entry : fs::recursive_directory_iterator(ours)) {
    const std::string name = fs::relative(entry.path(), ours).string();
    if (name == "out" || name == "err" || name == "class.csv" || name == "report.html" ||
        name == "home/school.pub")
      continue;
    struct stat info {};
    ASSERT_EQ(::stat(entry.path().c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 0777u, entry.is_directory() ? 0700u : 0600u) << name;
    ++seen;
  }
  EXPECT_GE(seen, 18u);
  struct stat report {};
  ASSERT_EQ(::stat(path("report.html").c_str(), &report), 0);
  EXPECT_EQ(report.st_mode & 0777u, 0666u) << "a report is the user's, by the user's umask";
}

TEST_F(HostileFiles, TwentyProgramsThatAddAtOnceAllAdd) {
  constexpr int k_programs = 20;
  constexpr auto k_held =
      std::chrono::seconds(3);  // longer than the first of them need to ask for it
  std::vector<::pid_t> children;
  Database held = Database::open(path("L/ledger.db"), false);
  held.run("PRAGMA journal_mode = WAL; BEGIN IMMEDIATE");
  for (int i = 0; i < k_programs; ++i) {
    const std::string number = std::to_string(i);
    const ::pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      const std::string command = std::string(CAVUM_BINARY) + " " +
                                  ticket_for("student-" + number, "t" + number + ".ticket") + " >" +
                                  path("out" + number) + " 2>&1";
      ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
      ::_exit(127);
    }
    children.push_back(child);
  }
  std::this_thread::sleep_for(k_held);
  held.run("COMMIT");
  held.close();
  for (int i = 0; i < k_programs; ++i) {
    int status = 0;
    ASSERT_EQ(::waitpid(children[static_cast<std::size_t>(i)], &status, 0),
              children[static_cast<std::size_t>(i)]);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0)
        << read_text_file(path("out" + std::to_string(i)));
    EXPECT_TRUE(fs::exists(path("t" + std::to_string(i) + ".ticket")));
  }
  const json verified = run_json("ledger verify " + path("L"));
  EXPECT_EQ(verified["entries"], 1 + k_programs);
  EXPECT_EQ(verified["findings"], json::array());
  EXPECT_EQ(run_json("ledger candidates " + path("L"))["candidates"].size(),
            static_cast<std::size_t>(k_programs));
}

TEST_F(HostileFiles, ACandidateWithSlashesIsNoPath) {
  ASSERT_EQ(sit("--candidate ../../x", "deep.cavum").exit_code, 0);
  const auto added = run("ledger add " + path("L") + " " + path("deep.cavum") +
                         " --without-ticket --simulated --with-findings --json");
  ASSERT_EQ(json::parse(added.out)["sessions"][0]["filed"], true) << added.out << added.err;
  ASSERT_EQ(run("ledger release " + path("L") + " --session 1 --with-findings").exit_code, 0);
  fs::create_directories(path("a/b"));
  const auto reports = run("ledger report " + path("L") + " --out " + path("a/b/reports"));
  EXPECT_EQ(reports.exit_code, 0) << reports.out << reports.err;
  EXPECT_TRUE(fs::exists(path("a/b/reports"))) << reports.err;
  std::vector<std::string> written;
  for (const auto& entry : fs::recursive_directory_iterator(path("a")))
    if (entry.is_regular_file()) written.push_back(entry.path().string());
  ASSERT_EQ(written.size(), 1u);
  EXPECT_EQ(fs::path(written[0]).parent_path().string(), path("a/b/reports"));
}

TEST_F(HostileFiles, NoTextOfAFileCommandsTheTerminal) {
  const std::string mark = "VERDICT", evil =
                                          "\\u001b[2J\\u0007\\n"
                                          "FORGED \\u009b31m\\u202e\\r" +
                                          mark;
  seal_with(path("s.cavum"), json::parse("\"" + evil + "\""));
  std::string printed;
  for (const std::string verb : {"grade ", "grade --json ", "grade --why removed ", "verify ",
                                 "verify --json ", "replay --verify ", "replay --verify --json "}) {
    const auto r = run(verb + path("s.cavum"));
    expect_tame(r, verb);
    printed += r.out + r.err;
  }
  EXPECT_NE(printed.find(mark), std::string::npos)
      << "what was planted is shown, tamed: " << printed;

  const auto added = run("ledger add " + path("L") + " " + path("s.cavum") +
                         " --without-ticket --simulated --with-findings");
  expect_tame(added, "ledger add");
  for (const char* trigger : {"entry_stays", "entry_is_kept"})
    edit("L/ledger.db", std::string("DROP TRIGGER ") + trigger +
                            "; CREATE TABLE IF NOT EXISTS z (x); INSERT INTO z VALUES (1)");
  edit("L/ledger.db",
       "UPDATE entry SET text = replace(text, '\"candidate\":\"', '\"candidate\":\"" + evil + "')");
  std::string shown;
  for (const std::string verb :
       {"ledger show ", "ledger show --json ", "ledger verify ", "ledger verify --json "}) {
    const auto r = run(verb + path("L"));
    EXPECT_EQ(r.exit_code, 1) << verb;
    expect_tame(r, verb);
    shown += r.out + r.err;
  }
  EXPECT_NE(shown.find(mark), std::string::npos) << shown;

  for (const std::string verb : {"grade ", "verify ", "replay --verify "}) {  // a name of a file
    fs::copy_file(path("s.cavum"), path("\x1b[31m\nFORGED.cavum"),
                  fs::copy_options::overwrite_existing);
    expect_tame(run(verb + "'" + path("\x1b[31m\nFORGED.cavum") + "'"), verb + "of a hostile name");
  }
}

}  // namespace
}  // namespace cavum::ui
