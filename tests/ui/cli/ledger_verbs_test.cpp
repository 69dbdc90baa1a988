// A class sits an exam by the commands of the README: tickets, exams, filing, release, exports, an
// appeal, and somebody who is forgotten.
#include <sys/stat.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/ui/program.h"

namespace cavum::ui {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class LedgerVerbs : public testing_ui::Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    ASSERT_EQ(run("ledger init " + path("L") + " --school Dentistry").exit_code, 0);
    write_text_file(path("class.csv"), "id,name\n4711,Ann Lee\n4712,Bob Ray\n");
  }
  std::string scenario() const { return CAVUM_SOURCE_DIR "/tests/replay/block_cavity.toml"; }
  json tickets(const std::string& more = "") {
    const auto r =
        run("ledger ticket " + path("L") + " " + scenario() + " --candidates " + path("class.csv") +
            " --from 2020-01-01T00:00Z --until 2190-01-01T00:00Z --out " + path("tickets") +
            " --json" + more);
    EXPECT_EQ(r.exit_code, 0) << r.err;
    return json::parse(r.out)["tickets"];
  }
  /// Whether all of `parts` stand in `text`, in that order.
  static bool in_order(const std::string& text, const std::vector<std::string>& parts) {
    std::size_t at = 0;
    return std::all_of(parts.begin(), parts.end(), [&](const std::string& p) {
      return (at = text.find(p, at)) != std::string::npos;
    });
  }
  static std::string groups_in(const json& findings) {
    std::string groups;
    for (const json& f : findings)
      groups += (groups.empty() ? "" : " ") + f.at("group").get<std::string>();
    return groups;
  }
  testing_ui::Ran sit(const std::string& ticket, const std::string& out,
                      const std::string& more = "") {
    return run("exam " + scenario() + " --ticket " + ticket + " --operator expert --quiet --out " +
               path(out) + more);
  }
};

TEST_F(LedgerVerbs, AClassFromTicketToGradebook) {
  const json issued = tickets(" --extra-time-percent 25");
  ASSERT_EQ(issued.size(), 2u);
  for (int i = 0; i < 2; ++i)
    ASSERT_EQ(sit(issued[static_cast<std::size_t>(i)]["file"], "e" + std::to_string(i) + ".cavum")
                  .exit_code,
              0);
  const auto twice = sit(issued[0]["file"], "twice.cavum");
  EXPECT_EQ(twice.exit_code, 2);
  EXPECT_NE(twice.err.find(path("e0.cavum")), std::string::npos)
      << "what it was used for: " << twice.err;
  EXPECT_FALSE(fs::exists(path("twice.cavum")));
  const auto graded = json::parse(run("grade " + path("e0.cavum") + " --json").out);
  EXPECT_EQ(graded["accommodations"]["extra_time_percent"], 25.0) << graded["accommodations"];

  const auto hands = run("ledger add " + path("L") + " " + path("e0.cavum"));
  EXPECT_EQ(hands.exit_code, 1);
  EXPECT_NE(hands.out.find("'expert'"), std::string::npos) << "whose hand moved it: " << hands.out;
  ASSERT_EQ(run("ledger add " + path("L") + " " + path("e0.cavum") + " " + path("e1.cavum") +
                " --simulated --receipts " + path("receipts"))
                .exit_code,
            0);
  EXPECT_EQ(run("ledger add " + path("L") + " " + path("e0.cavum") + " --simulated").exit_code, 1)
      << "it was submitted before";
  EXPECT_EQ(
      run("ledger verify " + path("L") + " --replay --receipt " + path("receipts/receipt-3.json"))
          .exit_code,
      0);

  ASSERT_EQ(
      run("ledger export " + path("L") + " --format moodle --out " + path("none.csv")).exit_code,
      0);
  EXPECT_EQ(read_text_file(path("none.csv")), "ID number\n") << "nothing is released yet";
  EXPECT_NE(
      run("ledger export " + path("L") + " --format moodle --overwrite --out " + path("none.csv"))
          .out.find(" 2 "),
      std::string::npos)
      << "so many are pending";
  ASSERT_EQ(run("ledger release " + path("L") + " --candidate 4711").exit_code, 0);
  const auto plain =
      run("ledger export " + path("L") + " --format moodle --out " + path("plain.csv"));
  ASSERT_EQ(plain.exit_code, 0);
  EXPECT_EQ(read_text_file(path("plain.csv")), "ID number\n")
      << "an operator sat under the candidate's ticket: nobody's grade";
  EXPECT_NE(plain.out.find("1 "), std::string::npos) << "so many are left out: " << plain.out;
  const std::string moodle =
      "ledger export " + path("L") + " --format moodle --with-simulated --out ";
  ASSERT_EQ(run(moodle + path("m.csv")).exit_code, 0);
  const std::string gradebook = read_text_file(path("m.csv")), sat_by = issued[0]["candidate"];
  EXPECT_NE(gradebook.find("\nSIMULATED " + sat_by + "," + graded["score"]["points"].dump() +
                           ",\"SIMULATED (operator expert"),
            std::string::npos)
      << gradebook;
  for (const std::string& no :
       {std::string("4711"), std::string("4712"), issued[1]["candidate"].get<std::string>()})
    EXPECT_EQ(gradebook.find(no), std::string::npos) << no;

  write_text_file(
      path("kind.toml"),
      "[rubric]\nrule = \"compensatory\"\npass_percent = 10\n[[rubric.criteria]]\nid = \"removed\"\nmetric = "
      "\"target_removed_percent\"\nfull = 50\nzero = 0\npoints = 10\n");
  const auto regraded = run("ledger regrade " + path("L") + " --session 3 --rubric " +
                            path("kind.toml") + " --reason appeal --json");
  ASSERT_EQ(regraded.exit_code, 0) << regraded.err;
  EXPECT_EQ(json::parse(regraded.out)["after"]["points"], 10.0);
  write_text_file(
      path("hard.toml"),
      "[rubric]\nrule = \"compensatory\"\npass_percent = 90\n[[rubric.criteria]]\nid = \"removed\"\nmetric = "
      "\"target_removed_percent\"\nfull = 200\nzero = 0\npoints = 100\n");
  const auto told = run("ledger regrade " + path("L") + " --session 3 --rubric " +
                        path("hard.toml") + " --reason appeal");
  EXPECT_TRUE(in_order(told.out, {"pass", "10.0", "10", "fail", "100"})) << told.out;
  const auto shown = json::parse(run("ledger show " + path("L") + " --json").out);
  EXPECT_EQ(shown["sessions"][0]["regraded"], true);
  EXPECT_EQ(shown["sessions"][0]["released"], false) << "the new result waits for its release";
  EXPECT_EQ(shown["sessions"][0]["shown"], true) << "and the old one is out";

  ASSERT_EQ(run(moodle + path("again.csv")).exit_code, 0);
  EXPECT_EQ(read_text_file(path("again.csv")), gradebook) << "until then the old one stands";
  expect_refused("ledger export " + path("L") + " --format moodle --out " + path("m.csv"),
                 {path("m.csv")});
  EXPECT_NE(run("ledger candidates " + path("L")).out.find("4711, Ann Lee"), std::string::npos);

  ASSERT_EQ(run("ledger forget " + path("L") + " --candidate 4712").exit_code, 0);
  EXPECT_EQ(
      run("ledger verify " + path("L") + " --replay --receipt " + path("receipts/receipt-4.json"))
          .exit_code,
      0);

  ASSERT_EQ(
      run("ledger export " + path("L") + " --format json --out " + path("all.json")).exit_code, 0);
  EXPECT_EQ(run("ledger verify " + path("L") + " --results " + path("all.json")).exit_code, 0);
  std::string results = read_text_file(path("all.json"));
  results.replace(results.find("\"released\":false"), 16, "\"released\":true ");
  write_text_file(path("all.json"), results);
  const auto changed = run("ledger verify " + path("L") + " --json --results " + path("all.json"));
  EXPECT_EQ(changed.exit_code, 1);
  const json found = json::parse(changed.out)["findings"];
  EXPECT_TRUE(std::any_of(found.begin(), found.end(), [&](const json& f) {
    return f["group"] == "signature_invalid" && f["where"] == path("all.json");
  })) << changed.out;
}

TEST_F(LedgerVerbs, WhatATicketDoesNotPromiseDoesNotBegin) {
  const std::string ticket = tickets()[0]["file"];
  const auto refused = [&](const std::string& command, const std::string& because) {
    expect_refused(command, {because});
    EXPECT_FALSE(fs::exists(path("x.cavum"))) << command;
  };
  const std::string sit_it =
      "exam " + scenario() + " --operator expert --out " + path("x.cavum") + " --ticket ";
  refused(sit_it + ticket + " --candidate somebody", "--candidate somebody");
  refused(sit_it + ticket + " --extra-time-percent 50", ticket);
  refused(sit_it + ticket + " --model paper", "force_model.toml");
  refused(sit_it + path("class.csv"), "class.csv");
  auto changed = json::parse(read_text_file(ticket));
  changed["ticket"]["candidate"] = "C-AAAA-AAAA-AAAA";
  write_text_file(path("changed.ticket"), changed.dump());
  refused(sit_it + path("changed.ticket"), "changed.ticket");
  const auto late =
      run("ledger ticket " + path("L") + " " + scenario() +
          " --candidate 4713 --from 2020-01-01T00:00Z --until 2020-01-02T00:00Z --out " +
          path("old.ticket"));
  ASSERT_EQ(late.exit_code, 0) << late.err;
  refused(sit_it + path("old.ticket"), "2020-01-02T00:00:00Z");
  write_text_file(path("home/school.pub"), std::string(64, 'a') + "\n");
  refused(sit_it + ticket, ticket);
  fs::remove(path("home/school.pub"));
  refused(sit_it + ticket, path("home/school.pub"));
}

TEST_F(LedgerVerbs, SayWhatIsWrongAndWhere) {
  const std::string L = path("L"), ticket = "ledger ticket " + L + " " + scenario() +
                                            " --until 2190-01-01T00:00Z --out " + path("t");
  write_text_file(path("twice.csv"), "id\n1\n1\n");
  for (const auto& [command, where] : std::vector<std::pair<std::string, std::string>>{
           {"init " + L, L},
           {"add " + path("none") + " " + path("x.cavum"), path("none")},
           {"release " + L, ""},
           {"show " + path("L/none"), path("L/none")},
           {"verify ''", ""},
           {"init " + path("L2") + " --school " + std::string(255, 'x'), "--school"},
           {"release " + L + " --session 0", " 0"},
           {"release " + L + " --all --key " + path("nokey"), path("nokey")},
           {"release " + L + " --candidate nobody", "nobody"},
           {"regrade " + L + " --session 0 --rubric x.toml --reason r", "--session 0"},
           {"forget " + L + " --candidate nobody", "nobody"},
           {"export " + L + " --format moodle --out " + path("L/ledger.db"), path("L/ledger.db")}})
    expect_refused("ledger " + command, {where});
  expect_refused(ticket + " --candidate 1 --from yesterday", {"'yesterday'"});
  expect_refused(ticket + " --from 2020-01-01T00:00Z", {});
  expect_refused(ticket + " --from 2020-01-01T00:00Z --candidates " + path("twice.csv"),
                 {"twice.csv:3", "'1'"});
  EXPECT_FALSE(fs::exists(path("nokey")));
}

TEST_F(LedgerVerbs, ALedgerWhoseMakingWasCutOffIsMadeByRunningItAgain) {
  write_text_file(path("L/identities.db"), "");
  EXPECT_EQ(run("ledger verify " + path("L")).exit_code, 1);
  const auto again = run("ledger init " + path("L") + " --school Dentistry");
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(run("ledger verify " + path("L")).exit_code, 0);
  EXPECT_EQ(run("ledger init " + path("L") + " --school Dentistry").exit_code, 2)
      << "what is whole is not made again";
  EXPECT_EQ(tickets().size(), 2u);
}

TEST_F(LedgerVerbs, APipeBesideTheLedgerIsNotWaitedFor) {
  ASSERT_EQ(::mkfifo(path("L/ledger.db-journal").c_str(), 0600), 0);
  EXPECT_EQ(run("ledger verify " + path("L")).exit_code, 0) << "from the file as it lies there";
  const auto adding = run("ledger station " + path("L") + " --invite Seat");
  EXPECT_EQ(adding.exit_code, 2);
  EXPECT_NE(adding.err.find("ledger.db-journal: "), std::string::npos) << adding.err;
}

TEST_F(LedgerVerbs, OneRecordingThatCannotBeFiledKeepsNoOtherFromIt) {
  const auto all = tickets();
  fs::create_directory(path("in"));
  ASSERT_EQ(sit(all[0]["file"], "in/b.cavum").exit_code, 0);
  write_text_file(path("in/a.cavum"), "no recording");
  const auto r = run("ledger add " + path("L") + " " + path("in") + " --simulated --json");
  EXPECT_EQ(r.exit_code, 1);
  const auto files = json::parse(r.out)["sessions"];
  ASSERT_EQ(files.size(), 2u);
  EXPECT_EQ(files[0]["filed"], false);
  EXPECT_EQ(files[1]["filed"], true) << r.out;
}

TEST_F(LedgerVerbs, VerifySaysWhatIsProvedAndWhatIsNot) {
  ASSERT_EQ(sit(tickets()[0]["file"], "e.cavum").exit_code, 0);
  const auto r = run("verify " + path("e.cavum") + " --json");
  ASSERT_EQ(r.exit_code, 0) << r.out;
  const auto j = json::parse(r.out);
  EXPECT_EQ(j["verified"], true);
  EXPECT_EQ(j["proved"].size(), 5u);
  EXPECT_TRUE(j["findings"].empty());
  const auto other =
      run("verify " + path("e.cavum") + " --json --school-key " + std::string(64, 'a'));
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_EQ(groups_in(json::parse(other.out)["findings"]), "ticket_invalid") << other.out;
  // and so without an option, by the school that this computer knows
  const std::string own = read_text_file(path("home/school.pub"));
  write_text_file(path("home/school.pub"), std::string(64, 'a') + "\n");
  EXPECT_EQ(run("verify " + path("e.cavum")).exit_code, 1);
  fs::remove(path("home/school.pub"));
  const json unknown = run_json("verify " + path("e.cavum"));
  EXPECT_EQ(unknown["remarks"].size(), j["remarks"].size() + 1)
      << "whether the ticket is your school's was not compared: " << unknown;
  write_text_file(path("home/school.pub"), own);
}

TEST_F(LedgerVerbs, AnExamThatWasClosedIsNotTakenUpAgainFromItsBeginning) {
  const json issued = tickets();
  const std::string out = path("a.cavum"), cut = path("cut.cavum");
  ASSERT_EQ(sit(issued[0]["file"], "a.cavum").exit_code, 0);
  std::filesystem::copy(out, cut);
  write_text_file(
      path("cut.py"),
      "import sqlite3, sys\nd = sqlite3.connect(sys.argv[1])\nfor t in ('seal', 'result'): d.execute('delete from ' + t)\n"
      "d.execute('delete from event where chunk > 3')\nd.execute('delete from chunk where seq > 3')\n"
      "d.execute(\"delete from artifact where name = 'final_tooth.cvt'\")\nd.commit()\n");
  ASSERT_EQ(std::system(("python3 " + path("cut.py") + " " + cut).c_str()), 0);
  const auto again = run("exam --resume --end --quiet --out " + cut);
  EXPECT_EQ(again.exit_code, 2) << again.out;
  EXPECT_NE(again.err.find(out), std::string::npos) << "for which it was closed: " << again.err;
  // without the station's memory it is taken up again, and the file says so
  std::filesystem::remove(path("home/used_tickets"));
  ASSERT_EQ(run("exam --resume --end --quiet --out " + cut).exit_code, 0);
  const auto told = run("verify --json " + cut);
  EXPECT_EQ(told.exit_code, 1);
  EXPECT_EQ(groups_in(json::parse(told.out)["findings"]), "station_changed")
      << "it did not remember beginning it: " << told.out;
  const auto reported =
      run("report " + cut + " --out " + path("cut.html"));  // says so before its verdict
  ASSERT_EQ(reported.exit_code, 0) << reported.err;
  EXPECT_NE(reported.err.find(cut), std::string::npos) << reported.err;
  const std::string page = read_text_file(path("cut.html"));
  EXPECT_LT(page.find("data-kind='does_not_hold'"), page.find("class='verdict "));
  const auto refused = run("ledger add " + path("L") + " " + cut + " --simulated --json");
  EXPECT_EQ(refused.exit_code, 1);
  const json refusal = json::parse(refused.out)["sessions"][0];
  EXPECT_EQ(refusal["filed"], false);
  EXPECT_EQ(refusal["findings"], json::parse(told.out)["findings"]);
  EXPECT_EQ(run("ledger add " + path("L") + " " + out + " --simulated").exit_code, 0)
      << "the one that was sat";
  // shown for an appeal, it contests the first: neither is released with the others
  ASSERT_EQ(run("ledger add " + path("L") + " " + cut + " --simulated --with-findings").exit_code,
            1);
  const auto shown = run_json("ledger show " + path("L"));
  EXPECT_EQ(shown["sessions"][0]["contested_by"], json::array({shown["sessions"][1]["seq"]}));
  EXPECT_EQ(run_json("ledger release " + path("L") + " --all"),
            (json{{"released", 0}, {"withheld", 2}, {"to_decide", 0}}));
  const std::string release = "ledger release " + path("L") + " --with-findings ",
                    first = shown["sessions"][0]["seq"].dump(),
                    second = shown["sessions"][1]["seq"].dump();
  expect_refused(release + "--candidate 4711", {"--candidate", " " + first + " ", " " + second});
  EXPECT_EQ(run_json(release + "--session " + first),
            (json{{"released", 1}, {"withheld", 0}, {"to_decide", 0}}));
  expect_refused(release + "--session " + second, {" " + second, " " + first});
  EXPECT_EQ(run_json("ledger show " + path("L"))["sessions"][0]["chosen"], true);
}

TEST_F(LedgerVerbs, ALedgerThatWasEditedIsShownWithAWarning) {
  tickets();
  const auto sound = run("ledger show " + path("L"));
  EXPECT_EQ(sound.exit_code, 0);
  EXPECT_EQ(sound.err, "");
  write_text_file(
      path("edit.py"),
      "import sqlite3, sys\nd = sqlite3.connect(sys.argv[1])\nd.execute('drop trigger entry_stays')\n"
      "d.execute(\"update entry set text = replace(text, 'C-', 'D-') where seq = 1\")\nd.commit()\n");
  ASSERT_EQ(std::system(("python3 " + path("edit.py") + " " + path("L/ledger.db")).c_str()), 0);
  for (const char* more : {"", " --json"}) {
    const auto edited = run("ledger show " + path("L") + more);
    EXPECT_EQ(edited.exit_code, 1);
    EXPECT_NE(edited.err.find(path("L")), std::string::npos) << edited.err;
  }
  EXPECT_EQ(json::parse(run("ledger show " + path("L") + " --json").out)["findings"].at(0)["group"],
            "schema_differs");
}

TEST_F(LedgerVerbs, VerifyChecksWhatItCanAndNamesWhatItCannot) {
  tickets();
  fs::copy(path("L"), path("cut"), fs::copy_options::recursive);
  write_text_file(
      path("drop.py"),
      "import sqlite3, sys\nsqlite3.connect(sys.argv[1]).execute('drop table entry')\n");
  ASSERT_EQ(std::system(("python3 " + path("drop.py") + " " + path("cut/ledger.db")).c_str()), 0);
  const auto cut = run("ledger verify --json " + path("cut"));
  EXPECT_EQ(cut.exit_code, 1);
  const json of_cut = json::parse(cut.out);
  EXPECT_EQ(of_cut["findings"].at(0)["group"], "schema_differs")
      << "the table that was taken out: " << of_cut;
  EXPECT_EQ(of_cut["school"], "");
  expect_refused("ledger candidates " + path("cut"), {path("cut")});
  fs::remove(path("L/identities.db"));
  const json r = run_json("ledger verify " + path("L"));
  EXPECT_EQ(r["entries"], 3);
  EXPECT_EQ(groups_in(r["not_checked"]), "identities_changed") << r;
  const std::string own = read_text_file(path("home/school.pub"));
  write_text_file(path("home/school.pub"), std::string(64, 'a') + "\n");
  const auto other = run("ledger verify " + path("L") + " --json");
  EXPECT_EQ(other.exit_code, 1);
  const auto findings = json::parse(other.out)["findings"];
  ASSERT_EQ(groups_in(findings), "other_school");
  EXPECT_NE(findings[0]["text"].get<std::string>().find(path("home/school.pub")), std::string::npos)
      << findings;
  write_text_file(path("home/school.pub"), own);
  write_text_file(path("r.json"), "this is no JSON");
  const auto receipt = run("ledger verify " + path("L") + " --receipt " + path("r.json"));
  EXPECT_EQ(receipt.exit_code, 1);
  EXPECT_NE(receipt.out.find(path("r.json")), std::string::npos) << receipt.out;
  EXPECT_EQ(receipt.out.find("json.exception"), std::string::npos) << receipt.out;
}

TEST_F(LedgerVerbs, ACandidatesNumberIsBounded) {
  const std::string endless = " --candidate " + std::string(5000, 'x'), L = path("L");
  for (const std::string& command :
       {"exam " + scenario() + " --operator expert --out " + path("x.cavum"),
        "ledger ticket " + L + " " + scenario() +
            " --from 2020-01-01T00:00Z --until 2190-01-01T00:00Z --out " + path("t"),
        "ledger release " + L, "ledger forget " + L})
    expect_refused(command + endless, {"5000", "254"});
  EXPECT_FALSE(fs::exists(path("x.cavum")));
}

TEST_F(LedgerVerbs, NoExportIsWrittenOverAKeyOrIdentities) {
  for (const std::string& kept :
       {path("home/school.key"), path("L/identities.db"), path("L/ledger.db")}) {
    const std::string before = read_text_file(kept);
    const auto r = run("ledger export " + path("L") + " --format moodle --overwrite --out " + kept);
    EXPECT_EQ(r.exit_code, 2) << kept << r.out;
    EXPECT_EQ(read_text_file(kept), before) << kept;
  }
}

}  // namespace
}  // namespace cavum::ui
