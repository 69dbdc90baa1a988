// A class sits an exam by the commands of the README: tickets, exams, filing, release, exports, an appeal, and somebody who is forgotten.
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
  std::string scenario() const { return std::string(CAVUM_SOURCE_DIR) + "/tests/replay/block_cavity.toml"; }
  json tickets(const std::string& more = "") {
    const auto r = run("ledger ticket " + path("L") + " " + scenario() + " --candidates " + path("class.csv") +
                       " --from 2020-01-01T00:00Z --until 2190-01-01T00:00Z --out " + path("tickets") + " --json" + more);
    EXPECT_EQ(r.exit_code, 0) << r.err;
    return json::parse(r.out)["tickets"];
  }
  testing_ui::Ran sit(const std::string& ticket, const std::string& out, const std::string& more = "") {
    return run("exam " + scenario() + " --ticket " + ticket + " --operator expert --quiet --out " + path(out) + more);
  }
};

TEST_F(LedgerVerbs, AClassFromTicketToGradebook) {
  const json issued = tickets(" --extra-time-percent 25");
  ASSERT_EQ(issued.size(), 2u);
  for (int i = 0; i < 2; ++i) ASSERT_EQ(sit(issued[static_cast<std::size_t>(i)]["file"], "e" + std::to_string(i) + ".cavum").exit_code, 0);
  const auto twice = sit(issued[0]["file"], "twice.cavum");
  EXPECT_EQ(twice.exit_code, 2);
  EXPECT_NE(twice.err.find("was used at this station on "), std::string::npos) << twice.err;
  EXPECT_FALSE(fs::exists(path("twice.cavum")));
  const auto graded = json::parse(run("grade " + path("e0.cavum") + " --json").out);
  EXPECT_EQ(graded["accommodations"]["extra_time_percent"], 25.0) << graded["accommodations"];

  const auto hands = run("ledger add " + path("L") + " " + path("e0.cavum"));
  EXPECT_EQ(hands.exit_code, 1);
  EXPECT_NE(hands.out.find("no candidate's hand moved this exam, but 'expert'"), std::string::npos) << hands.out;
  ASSERT_EQ(
      run("ledger add " + path("L") + " " + path("e0.cavum") + " " + path("e1.cavum") + " --simulated --receipts " + path("receipts")).exit_code, 0);
  const auto again = run("ledger add " + path("L") + " " + path("e0.cavum") + " --simulated");
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_NE(again.out.find("submitted before"), std::string::npos) << again.out;
  EXPECT_EQ(run("ledger verify " + path("L") + " --replay --receipt " + path("receipts/receipt-3.json")).exit_code, 0);

  ASSERT_EQ(run("ledger export " + path("L") + " --format moodle --out " + path("none.csv")).exit_code, 0);
  EXPECT_EQ(read_text_file(path("none.csv")), "ID number\n") << "nothing is released yet";
  EXPECT_NE(
      run("ledger export " + path("L") + " --format moodle --overwrite --out " + path("none.csv")).out.find("no result is released; 2 are pending"),
      std::string::npos);
  ASSERT_EQ(run("ledger release " + path("L") + " --candidate 4711").exit_code, 0);
  const auto plain = run("ledger export " + path("L") + " --format moodle --out " + path("plain.csv"));
  ASSERT_EQ(plain.exit_code, 0);
  EXPECT_EQ(read_text_file(path("plain.csv")), "ID number\n") << "an operator sat under the candidate's ticket: nobody's grade";
  EXPECT_NE(plain.out.find("1 released result of a simulated operator is left out"), std::string::npos) << plain.out;
  const std::string moodle = "ledger export " + path("L") + " --format moodle --with-simulated --out ";
  ASSERT_EQ(run(moodle + path("m.csv")).exit_code, 0);
  const std::string gradebook = read_text_file(path("m.csv")), sat_by = issued[0]["candidate"];
  EXPECT_NE(gradebook.find("\nSIMULATED " + sat_by + "," + graded["score"]["points"].dump() + ",\"SIMULATED (operator expert"), std::string::npos)
      << gradebook;
  for (const std::string& no : {std::string("4711"), std::string("4712"), issued[1]["candidate"].get<std::string>()})
    EXPECT_EQ(gradebook.find(no), std::string::npos) << no;

  write_text_file(path("kind.toml"),
                  "[rubric]\nrule = \"compensatory\"\npass_percent = 10\n[[rubric.criteria]]\nid = \"removed\"\nmetric = "
                  "\"target_removed_percent\"\nfull = 50\nzero = 0\npoints = 10\n");
  const auto regraded = run("ledger regrade " + path("L") + " --session 3 --rubric " + path("kind.toml") + " --reason appeal --json");
  ASSERT_EQ(regraded.exit_code, 0) << regraded.err;
  EXPECT_EQ(json::parse(regraded.out)["after"]["points"], 10.0);
  write_text_file(path("hard.toml"),
                  "[rubric]\nrule = \"compensatory\"\npass_percent = 90\n[[rubric.criteria]]\nid = \"removed\"\nmetric = "
                  "\"target_removed_percent\"\nfull = 200\nzero = 0\npoints = 100\n");
  const auto told = run("ledger regrade " + path("L") + " --session 3 --rubric " + path("hard.toml") + " --reason appeal");
  EXPECT_NE(told.out.find(": pass, 10.0 of 10 before; fail, "), std::string::npos) << told.out;
  EXPECT_NE(told.out.find(" of 100 now"), std::string::npos) << told.out;
  const auto shown = json::parse(run("ledger show " + path("L") + " --json").out);
  EXPECT_EQ(shown["sessions"][0]["regraded"], true);
  EXPECT_EQ(shown["sessions"][0]["released"], false) << "the new result waits for its release";
  EXPECT_EQ(shown["sessions"][0]["shown"], true) << "and the old one is out";
  EXPECT_NE(run("ledger show " + path("L")).out.find("pending, an earlier result is out"), std::string::npos);

  ASSERT_EQ(run(moodle + path("again.csv")).exit_code, 0);
  EXPECT_EQ(read_text_file(path("again.csv")), gradebook) << "until then the old one stands";
  expect_refused("ledger export " + path("L") + " --format moodle --out " + path("m.csv"), {"is there already"});
  EXPECT_NE(run("ledger candidates " + path("L")).out.find("4711, Ann Lee"), std::string::npos);

  ASSERT_EQ(run("ledger forget " + path("L") + " --candidate 4712").exit_code, 0);
  EXPECT_EQ(run("ledger verify " + path("L") + " --replay --receipt " + path("receipts/receipt-4.json")).exit_code, 0);

  ASSERT_EQ(run("ledger export " + path("L") + " --format json --out " + path("all.json")).exit_code, 0);
  EXPECT_EQ(run("ledger verify " + path("L") + " --results " + path("all.json")).exit_code, 0);
  std::string results = read_text_file(path("all.json"));
  results.replace(results.find("\"released\":false"), 16, "\"released\":true ");
  write_text_file(path("all.json"), results);
  const auto changed = run("ledger verify " + path("L") + " --results " + path("all.json"));
  EXPECT_EQ(changed.exit_code, 1);
  EXPECT_NE(changed.out.find("all.json: the school's signature on the results does not hold"), std::string::npos) << changed.out;
}

TEST_F(LedgerVerbs, WhatATicketDoesNotPromiseDoesNotBegin) {
  const std::string ticket = tickets()[0]["file"];
  const auto refused = [&](const std::string& command, const std::string& because) {
    expect_refused(command, {because});
    EXPECT_FALSE(fs::exists(path("x.cavum"))) << command;
  };
  const std::string sit_it = "exam " + scenario() + " --operator expert --out " + path("x.cavum") + " --ticket ";
  refused(sit_it + ticket + " --candidate somebody", "the ticket");
  refused(sit_it + ticket + " --extra-time-percent 50", "says itself what is granted");
  refused(sit_it + ticket + " --model paper", "force_model.toml is not the one");
  refused(sit_it + path("class.csv"), "is no ticket");
  auto changed = json::parse(read_text_file(ticket));
  changed["ticket"]["candidate"] = "C-AAAA-AAAA-AAAA";
  write_text_file(path("changed.ticket"), changed.dump());
  refused(sit_it + path("changed.ticket"), "changed after the school signed it");
  const auto late = run("ledger ticket " + path("L") + " " + scenario() +
                        " --candidate 4713 --from 2020-01-01T00:00Z --until 2020-01-02T00:00Z --out " + path("old.ticket"));
  ASSERT_EQ(late.exit_code, 0) << late.err;
  refused(sit_it + path("old.ticket"), "the ticket is good from 2020-01-01T00:00:00Z to 2020-01-02T00:00:00Z");
  write_text_file(path("home/school.pub"), std::string(64, 'a') + "\n");
  refused(sit_it + ticket, "ticket of another school");
  fs::remove(path("home/school.pub"));
  refused(sit_it + ticket, "knows no school yet");
}

TEST_F(LedgerVerbs, SayWhatIsWrongAndWhatToDo) {
  expect_refused("ledger init " + path("L"), {"holds a ledger already"});
  expect_refused("ledger add " + path("none") + " " + path("x.cavum"), {"there is no ledger", "cavum ledger init"});
  expect_refused("ledger ticket " + path("L") + " " + scenario() + " --candidate 1 --from yesterday --until 2030-01-01T00:00Z --out " + path("t"),
                 {"'yesterday' is no time"});
  expect_refused("ledger ticket " + path("L") + " " + scenario() + " --from 2020-01-01T00:00Z --until 2030-01-01T00:00Z --out " + path("t"),
                 {"for whom"});
  expect_refused("ledger release " + path("L"), {"whose results"});
  expect_refused("ledger show " + path("L/none"), {"holds no ledger"});
  expect_refused("ledger verify ''", {"no folder named"});
  expect_refused("ledger init " + path("L2") + " --school " + std::string(255, 'x'), {"--school", "longer than 254 bytes"});
  expect_refused("ledger release " + path("L") + " --session 0", {"is no session's entry"});
  expect_refused("ledger release " + path("L") + " --all --key " + path("nokey"), {"key is not there", "restore it"});
  EXPECT_FALSE(fs::exists(path("nokey")));
  write_text_file(path("twice.csv"), "id\n1\n1\n");
  expect_refused("ledger ticket " + path("L") + " " + scenario() + " --candidates " + path("twice.csv") +
                     " --from 2020-01-01T00:00Z --until 2190-01-01T00:00Z --out " + path("t"),
                 {"twice.csv:3", "second time"});
  expect_refused("ledger release " + path("L") + " --candidate nobody", {"has no session in this ledger"});
  expect_refused("ledger regrade " + path("L") + " --session 0 --rubric x.toml --reason r", {"is no session's entry"});
  expect_refused("ledger forget " + path("L") + " --candidate nobody", {"not among the identities"});
  expect_refused("ledger export " + path("L") + " --format moodle --out " + path("L/ledger.db"), {"also what is read"});
}

TEST_F(LedgerVerbs, ALedgerWhoseMakingWasCutOffIsMadeByRunningItAgain) {
  write_text_file(path("L/identities.db"), "");
  EXPECT_EQ(run("ledger verify " + path("L")).exit_code, 1);
  const auto again = run("ledger init " + path("L") + " --school Dentistry");
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(run("ledger verify " + path("L")).exit_code, 0);
  EXPECT_EQ(run("ledger init " + path("L") + " --school Dentistry").exit_code, 2) << "what is whole is not made again";
  EXPECT_EQ(tickets().size(), 2u);
}

TEST_F(LedgerVerbs, APipeBesideTheLedgerIsNotWaitedFor) {
  ASSERT_EQ(::mkfifo(path("L/ledger.db-journal").c_str(), 0600), 0);
  EXPECT_EQ(run("ledger verify " + path("L")).exit_code, 0) << "from the file as it lies there";
  const auto adding = run("ledger station " + path("L") + " --invite Seat");
  EXPECT_EQ(adding.exit_code, 2);
  EXPECT_NE(adding.err.find("ledger.db-journal: is no regular file"), std::string::npos) << adding.err;
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
  EXPECT_NE(r.out.find("gives the recorded events and the sealed result again"), std::string::npos);
  EXPECT_NE(r.out.find("is known to its ledger only: anybody can sign a recording"), std::string::npos);
  EXPECT_TRUE(j["findings"].empty());
  const auto other = run("verify " + path("e.cavum") + " --school-key " + std::string(64, 'a'));
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_NE(other.out.find("ticket of another school"), std::string::npos);
  // and so without an option, by the school that this computer knows
  const std::string own = read_text_file(path("home/school.pub"));
  write_text_file(path("home/school.pub"), std::string(64, 'a') + "\n");
  EXPECT_EQ(run("verify " + path("e.cavum")).exit_code, 1);
  fs::remove(path("home/school.pub"));
  const auto unknown = run("verify " + path("e.cavum"));
  EXPECT_EQ(unknown.exit_code, 0);
  EXPECT_NE(unknown.out.find("is your school's was not compared"), std::string::npos) << unknown.out;
  EXPECT_EQ(r.out.find("was not compared"), std::string::npos);
  write_text_file(path("home/school.pub"), own);
}

TEST_F(LedgerVerbs, AnExamThatWasClosedIsNotTakenUpAgainFromItsBeginning) {
  const json issued = tickets();
  const std::string out = path("a.cavum"), cut = path("cut.cavum");
  ASSERT_EQ(sit(issued[0]["file"], "a.cavum").exit_code, 0);
  std::filesystem::copy(out, cut);
  write_text_file(path("cut.py"),
                  "import sqlite3, sys\nd = sqlite3.connect(sys.argv[1])\nfor t in ('seal', 'result'): d.execute('delete from ' + t)\n"
                  "d.execute('delete from event where chunk > 3')\nd.execute('delete from chunk where seq > 3')\n"
                  "d.execute(\"delete from artifact where name = 'final_tooth.cvt'\")\nd.commit()\n");
  ASSERT_EQ(std::system(("python3 " + path("cut.py") + " " + cut).c_str()), 0);
  const auto again = run("exam --resume --end --quiet --out " + cut);
  EXPECT_EQ(again.exit_code, 2) << again.out;
  EXPECT_NE(again.err.find("was closed at this station"), std::string::npos) << again.err;
  // without the station's memory it is taken up again, and the file says so
  std::filesystem::remove(path("home/used_tickets"));
  ASSERT_EQ(run("exam --resume --end --quiet --out " + cut).exit_code, 0);
  const auto told = run("verify " + cut);
  EXPECT_EQ(told.exit_code, 1);
  EXPECT_NE(told.out.find("did not remember beginning it"), std::string::npos) << told.out;
  const auto reported = run("report " + cut + " --out " + path("cut.html"));  // says so before its verdict
  ASSERT_EQ(reported.exit_code, 0) << reported.err;
  EXPECT_NE(reported.err.find("cut.cavum: does not hold: "), std::string::npos) << reported.err;
  const std::string page = read_text_file(path("cut.html"));
  EXPECT_LT(page.find("This session does not hold"), page.find("class='verdict "));
  const auto refused = run("ledger add " + path("L") + " " + cut + " --simulated");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.out.find("NOT FILED"), std::string::npos) << refused.out;
  EXPECT_NE(refused.out.find("did not remember beginning it"), std::string::npos) << refused.out;
  EXPECT_EQ(run("ledger add " + path("L") + " " + out + " --simulated").exit_code, 0) << "the one that was sat";
  // shown for an appeal, it contests the first: neither is released with the others
  ASSERT_EQ(run("ledger add " + path("L") + " " + cut + " --simulated --with-findings").exit_code, 1);
  const auto shown = run_json("ledger show " + path("L"));
  EXPECT_EQ(shown["sessions"][0]["contested_by"], json::array({shown["sessions"][1]["seq"]}));
  EXPECT_EQ(run_json("ledger release " + path("L") + " --all"), (json{{"released", 0}, {"kept_back", 2}, {"to_decide", 0}}));
  const std::string release = "ledger release " + path("L") + " --with-findings ", first = shown["sessions"][0]["seq"].dump(),
                    second = shown["sessions"][1]["seq"].dump();
  expect_refused(release + "--candidate 4711", {"entries " + first + " and " + second, "--session"});
  EXPECT_EQ(run_json(release + "--session " + first), (json{{"released", 1}, {"kept_back", 0}, {"to_decide", 0}}));
  expect_refused(release + "--session " + second, {"was chosen before and alone counts"});
  EXPECT_EQ(run_json("ledger show " + path("L"))["sessions"][0]["chosen"], true);
}

TEST_F(LedgerVerbs, ALedgerThatWasEditedIsShownWithAWarning) {
  tickets();
  const auto sound = run("ledger show " + path("L"));
  EXPECT_EQ(sound.exit_code, 0);
  EXPECT_EQ(sound.err, "");
  write_text_file(path("edit.py"),
                  "import sqlite3, sys\nd = sqlite3.connect(sys.argv[1])\nd.execute('drop trigger entry_stays')\n"
                  "d.execute(\"update entry set text = replace(text, 'C-', 'D-') where seq = 1\")\nd.commit()\n");
  ASSERT_EQ(std::system(("python3 " + path("edit.py") + " " + path("L/ledger.db")).c_str()), 0);
  for (const char* more : {"", " --json"}) {
    const auto edited = run("ledger show " + path("L") + more);
    EXPECT_EQ(edited.exit_code, 1);
    EXPECT_NE(edited.err.find("WARNING: this ledger does not hold"), std::string::npos) << edited.err;
    EXPECT_NE(edited.err.find("cavum ledger verify " + path("L")), std::string::npos) << edited.err;
  }
  EXPECT_FALSE(json::parse(run("ledger show " + path("L") + " --json").out)["findings"].empty());
}

TEST_F(LedgerVerbs, VerifyChecksWhatItCanAndNamesWhatItCannot) {
  tickets();
  fs::copy(path("L"), path("cut"), fs::copy_options::recursive);
  write_text_file(path("drop.py"), "import sqlite3, sys\nsqlite3.connect(sys.argv[1]).execute('drop table entry')\n");
  ASSERT_EQ(std::system(("python3 " + path("drop.py") + " " + path("cut/ledger.db")).c_str()), 0);
  const auto cut = run("ledger verify " + path("cut"));
  EXPECT_EQ(cut.exit_code, 1);
  EXPECT_NE(cut.out.find("table entry: was taken out"), std::string::npos) << cut.out;
  EXPECT_EQ(cut.out.find("entries of ,"), std::string::npos) << cut.out;
  expect_refused("ledger candidates " + path("cut"), {"table entry: was taken out", "nothing is told of"});
  fs::remove(path("L/identities.db"));
  const auto r = run("ledger verify " + path("L"));
  EXPECT_EQ(r.exit_code, 0) << r.err;
  EXPECT_NE(r.out.find("verified, 3 entries"), std::string::npos) << r.out;
  EXPECT_NE(r.out.find("not checked: whether names were exchanged among the identities, or taken out: " + path("L/identities.db") + " is not there"),
            std::string::npos)
      << r.out;
  const std::string own = read_text_file(path("home/school.pub"));
  write_text_file(path("home/school.pub"), std::string(64, 'a') + "\n");
  const auto other = run("ledger verify " + path("L") + " --json");
  EXPECT_EQ(other.exit_code, 1);
  const auto findings = json::parse(other.out)["findings"];
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_NE(findings[0].get<std::string>().find("of another school than " + path("home/school.pub")), std::string::npos) << findings;
  write_text_file(path("home/school.pub"), own);
  write_text_file(path("r.json"), "this is no JSON");
  const auto receipt = run("ledger verify " + path("L") + " --receipt " + path("r.json"));
  EXPECT_EQ(receipt.exit_code, 1);
  EXPECT_NE(receipt.out.find("is no receipt, for it is not JSON"), std::string::npos) << receipt.out;
  EXPECT_EQ(receipt.out.find("json.exception"), std::string::npos) << receipt.out;
}

TEST_F(LedgerVerbs, ACandidatesNumberIsBounded) {
  const std::string endless(5000, 'x'), bound = "is longer than a candidate's number or address (5000 bytes)";
  expect_refused("exam " + scenario() + " --operator expert --out " + path("x.cavum") + " --candidate " + endless, {bound, "254 at most"});
  expect_refused("ledger ticket " + path("L") + " " + scenario() + " --from 2020-01-01T00:00Z --until 2190-01-01T00:00Z --out " + path("t") +
                     " --candidate " + endless,
                 {bound});
  expect_refused("ledger release " + path("L") + " --candidate " + endless, {bound});
  expect_refused("ledger forget " + path("L") + " --candidate " + endless, {bound});
  EXPECT_FALSE(fs::exists(path("x.cavum")));
  const auto help = run("ledger regrade --help");
  EXPECT_NE(help.out.find("kept for ever"), std::string::npos) << help.out;
  EXPECT_NE(help.out.find("no names"), std::string::npos) << help.out;
}

TEST_F(LedgerVerbs, NoExportIsWrittenOverAKeyOrIdentities) {
  for (const std::string& kept : {path("home/school.key"), path("L/identities.db"), path("L/ledger.db")}) {
    const std::string before = read_text_file(kept);
    const auto r = run("ledger export " + path("L") + " --format moodle --overwrite --out " + kept);
    EXPECT_EQ(r.exit_code, 2) << kept << r.out;
    EXPECT_EQ(read_text_file(kept), before) << kept;
  }
}

}  // namespace
}  // namespace cavum::ui
