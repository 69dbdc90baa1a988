// `verify-all` of a ledger and of a folder: threads, shards and Slurm's tasks give one answer, and
// nothing that is read is written over.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "engine/base/file.h"
#include "tests/ui/program.h"

namespace cavum::ui {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

const std::string k_recordings = std::string(CAVUM_SOURCE_DIR) + "/tests/replay/sessions/";

class VerifyAll : public testing_ui::Program {
 protected:
  [[nodiscard]] auto verify_all(const std::string& line) const { return run("verify-all " + line); }
};

/// A ledger of three filed sessions.
class VerifyAllOfALedger : public VerifyAll {
 protected:
  void SetUp() override {
    VerifyAll::SetUp();
    const std::string task = std::string(CAVUM_SOURCE_DIR) + "/tests/replay/block_cavity.toml";
    ASSERT_EQ(run("ledger init " + path("L") + " --school Dentistry").exit_code, 0);
    const auto sat = run("cohort simulate " + task + " --ledger " + path("L") + " --sessions " +
                         path("S") + " --n 3");
    ASSERT_EQ(sat.exit_code, 0) << sat.err;
    for (const auto& f : fs::directory_iterator(path("L/sessions")))
      files_.push_back(f.path().string());
    std::sort(files_.begin(), files_.end());
    ASSERT_EQ(files_.size(), 3u);
  }
  /// What a maker says, and the lines of its --out.
  struct Answer {
    int exit_code = 0;
    json ledger_findings;
    std::string lines, said;
  };
  [[nodiscard]] Answer answer(const std::string& options) const {
    const auto r = verify_all(path("L") + " --json --out " + path("lines") + options);
    const json j = json::parse(r.out, nullptr, false);
    EXPECT_FALSE(j.is_discarded()) << r.out << r.err;
    return {r.exit_code, j.is_discarded() ? json() : j["ledger"]["findings"],
            read_text_file(path("lines")), r.out};
  }
  /// Of shards, each made by a process of its own.
  [[nodiscard]] Answer by_shards(const std::string& options) const {
    for (const char* k : {"1", "2"})
      EXPECT_EQ(verify_all(path("L") + " --shard " + k + "/2 --out " +
                           path(std::string(k) + ".part") + options)
                    .exit_code,
                0);
    Answer merged = answer(options + " --merge " + path("2.part") + " " + path("1.part"));
    for (const char* k : {"1.part", "2.part"}) fs::remove(path(k));
    return merged;
  }
  /// Of Slurm's tasks, run one after the other by an sbatch of the test's own.
  [[nodiscard]] Answer by_tasks(const std::string& options) const {
    fs::create_directories(path("bin"));
    write_text_file(
        path("bin/sbatch"),
        "#!/bin/sh\nfor word; do case $word in --array=0-*) last=${word#--array=0-};; esac; script=$word; done\n"
        "for task in $(seq 0 \"$last\"); do SLURM_ARRAY_TASK_ID=$task sh \"$script\" >&2 || exit 1; done\necho 7\n");
    write_text_file(path("bin/squeue"), "#!/bin/sh\n");
    for (const char* program : {"bin/sbatch", "bin/squeue"})
      fs::permissions(path(program), fs::perms::owner_all);
    const std::string before = std::getenv("PATH");
    setenv("PATH", (path("bin") + ":" + before).c_str(), 1);
    Answer tasks = answer(options + " --slurm --sessions-per-task 1 --work " + path("slurm"));
    setenv("PATH", before.c_str(), 1);
    fs::remove_all(path("slurm"));
    return tasks;
  }
  void expect_one_answer(const std::string& options, int exit_code) const {
    const Answer threads = answer(options), shards = by_shards(options), tasks = by_tasks(options);
    EXPECT_EQ(tasks.exit_code, exit_code) << tasks.said;
    EXPECT_EQ(threads.ledger_findings, tasks.ledger_findings);
    EXPECT_EQ(threads.lines, tasks.lines);
    EXPECT_EQ(threads.exit_code, exit_code) << threads.said;
    EXPECT_EQ(shards.exit_code, exit_code) << shards.said;
    EXPECT_EQ(threads.ledger_findings, shards.ledger_findings);
    EXPECT_EQ(threads.lines, shards.lines);
    std::vector<std::string> names;
    std::istringstream lines(threads.lines);
    for (std::string line; std::getline(lines, line);)
      names.push_back(json::parse(line).at("session"));
    EXPECT_EQ(names.size(), 3u);
    EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
  }
  std::vector<std::string> files_;
};

TEST_F(VerifyAllOfALedger, ThreadsShardsAndTasksGiveOneAnswer) {
  expect_one_answer("", 0);
  fs::remove(files_[1]);
  fs::copy_file(files_[0], files_[2],
                fs::copy_options::overwrite_existing);  // a session, and another one than was filed
  for (const char* options : {"", " --mark"}) {
    expect_one_answer(options, 1);
    const json findings = answer(options).ledger_findings;
    ASSERT_EQ(findings.size(), 2u) << findings;
    EXPECT_EQ((std::set{findings[0]["group"], findings[1]["group"]}),
              (std::set<json>{"file_gone", "file_changed"}))
        << findings;
  }
}

TEST_F(VerifyAllOfALedger, AMissingPartIsNoBadExam) {
  ASSERT_EQ(verify_all(path("L") + " --shard 1/2 --out " + path("1.part")).exit_code, 0);
  const auto half = verify_all(path("L") + " --json --merge " + path("1.part"));
  EXPECT_EQ(half.exit_code, 1) << half.out;
  const json told = json::parse(half.out);
  EXPECT_EQ(told["sound"], 2) << told;
  EXPECT_EQ(told["missing"].size(), 1u) << told;
  EXPECT_TRUE(told["ledger"]["findings"].empty()) << told;
  EXPECT_NE(half.err.find("2/2"), std::string::npos) << "the part that is missing: " << half.err;
  fs::remove(files_[0]);  // of shard 1: that is one
  EXPECT_EQ(
      json::parse(
          verify_all(path("L") + " --json --merge " + path("1.part")).out)["ledger"]["findings"]
          .at(0)["group"],
      "file_gone");
}

TEST_F(VerifyAllOfALedger, NothingIsWrittenIntoIt) {
  for (const std::string& place : {path("L/ledger.db"), path("L/lines"), files_[0]})
    for (const char* option : {" --out ", " --work ", " --shard 1/2 --out "}) {
      const Bytes before = fs::exists(place) ? read_file(place) : Bytes();
      const auto r = verify_all(path("L") + option + place);
      EXPECT_EQ(r.exit_code, 2) << option << place << r.out;
      EXPECT_NE(r.err.find(place), std::string::npos) << r.err;
      EXPECT_TRUE(fs::exists(place) ? read_file(place) == before : before.empty()) << place;
    }
}

TEST_F(VerifyAll, WritesOverNothingThatItReads) {
  fs::create_directories(path("K/ex"));
  for (const char* name : {"K/1.cavum", "K/ex/2.cavum"})
    fs::copy_file(k_recordings + "block_expert.cavum", path(name));
  fs::create_hard_link(path("K/1.cavum"), path("other"));
  fs::create_symlink(path("K/ex/2.cavum"), path("link"));
  write_text_file(path("part"), "");
  write_text_file(path("rubric.toml"), "[rubric]\n");
  const Bytes whole = read_file(path("K/1.cavum"));
  const std::string K = path("K");
  for (const std::string& line :
       {" --out " + path("K/1.cavum"), " --shard 1/8 --out " + path("K/ex/2.cavum"),
        " --out " + path("other"), " --mark --out " + path("link"),
        " --shard 1/8 --out " + path("link"), " --out " + path("K/new.cavum"), " --work " + K,
        " --work " + path("K/ex"), " --merge " + path("part") + " --out " + path("part"),
        " --rubric " + path("rubric.toml") + " --out " + path("rubric.toml")}) {
    const auto r = verify_all(K + line);
    EXPECT_EQ(r.exit_code, 2) << line << r.out << r.err;
    for (const char* name : {"K/1.cavum", "K/ex/2.cavum"})
      ASSERT_EQ(read_file(path(name)), whole) << line;
  }
  EXPECT_EQ(read_text_file(path("rubric.toml")), "[rubric]\n");
  EXPECT_EQ(verify_all(K + " --mark --out " + path("lines") + " --work " + path("w")).exit_code, 0)
      << "elsewhere it may";
}

}  // namespace
}  // namespace cavum::ui
