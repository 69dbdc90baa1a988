#include "grading/records/ledger.h"

#include <sys/wait.h>
#include <unistd.h>

#include <iostream>
#include <random>

#include "engine/base/csv.h"
#include "grading/records/candidate_id.h"
#include "grading/records/exports.h"
#include "grading/records/ledger_error.h"
#include "grading/records/ledger_schema.h"
#include "tests/engine/support/basics.h"
#include "tests/grading/records/school.h"

namespace cavum::records {
namespace {

using namespace testing_ledger;
using nlohmann::json;
using testing_basics::code_of;
using testing_basics::tells;
using testing_basics::text_of;
using testing_basics::thrown_by;

/// Whether all of `parts` stand in `text`, in that order.
bool holds(const std::string& text, const std::vector<std::string>& parts) {
  std::size_t at = 0;
  return std::all_of(parts.begin(), parts.end(), [&](const std::string& p) {
    return (at = text.find(p, at)) != std::string::npos;
  });
}

TEST(Ledger, EveryReceiptHoldsForEveryLaterLedger) {
  const School school;
  Ledger ledger = school.ledger();
  std::vector<json> receipts;
  for (int i = 0; i < 20; ++i) {
    const auto seq = ledger
                         .append([&](const LedgerContent&) {
                           return ForgetEntry{"C-" + std::to_string(i), {}};
                         })
                         .seq;
    receipts.push_back(ledger.receipt(seq));
  }
  const LedgerContent content = read_ledger(school.places());
  ASSERT_TRUE(content.findings.empty()) << content.findings[0].message();
  EXPECT_EQ(content.entries.size(), 20u + k_first_entries);
  for (const auto& r : receipts) {
    const auto findings = check_receipt(r, content.public_key, &content);
    EXPECT_TRUE(findings.empty()) << findings[0].message();
  }
  EXPECT_FALSE(check_receipt(receipts[3], std::string(64, '0'), nullptr).empty())
      << "another school's key";
}

TEST(Ledger, TwoProgramsAddToOneLedger) {
  const School school;
  Ledger first = school.ledger(), second = school.ledger();
  for (int i = 0; i < 5; ++i) {
    first.append([](const LedgerContent&) { return ForgetEntry{"a", {}}; });
    second.append([](const LedgerContent&) { return ForgetEntry{"b", {}}; });
  }
  const LedgerContent content = read_ledger(school.places());
  EXPECT_TRUE(content.findings.empty());
  EXPECT_EQ(content.entries.size(), 10u + k_first_entries);
}

TEST(Ledger, WhatThrowsWhileEnteringLeavesNothing) {
  const School school;
  Ledger ledger = school.ledger();
  EXPECT_THROW(
      ledger.append([](const LedgerContent&) -> Entry { throw Error("a", msg("b"), msg("c")); }),
      Error);
  ledger.append([](const LedgerContent&) { return ForgetEntry{"a", {}}; });
  EXPECT_EQ(read_ledger(school.places()).entries.size(), 1u + k_first_entries);
  EXPECT_TRUE(check_ledger(school.places(), false).findings.empty());
}

TEST(Ledger, AnotherSchoolsKeyIsRefused) {
  const School school;
  EXPECT_THROW(Ledger(school.ledger_folder(), load_signing_key(school.file("other.key"), "school")),
               Error);
  EXPECT_THROW(static_cast<void>(load_signing_key(school_key_path(), "station")), Error)
      << "a school's key is no station's";
}

TEST(Ledger, OfAnotherFormatIsRefused) {
  const School school;
  Database db = Database::open(school.places().database(), false);
  db.run("PRAGMA user_version = 99");
  db.close();
  EXPECT_THROW(school.ledger(), Error);
  EXPECT_THROW(static_cast<void>(read_ledger(school.places())), Error);
}

TEST(Ledger, TheTablesRefuseChanges) {
  const School school;
  Database db = Database::open(school.places().database(), false);
  for (const char* sql : {"UPDATE entry SET text = 'x'", "DELETE FROM entry",
                          "UPDATE note SET size = 7", "DELETE FROM note"})
    EXPECT_THROW(db.run(sql), DatabaseError) << sql;
}

TEST(Identities, AreForgottenWithoutATraceAndProofsStay) {
  const School school;
  const std::string session = school.sit(school.ticket("ann.lee@school.example"));
  Ledger ledger = school.ledger();
  ASSERT_TRUE(file_session(ledger, session).seq);
  const std::string pseudonym = read_registry(ledger.content()).sessions.at(0).candidate;
  {
    Identities identities(school.places().identities());
    EXPECT_EQ(identities.of_pseudonym(pseudonym)->id, "ann.lee@school.example");
    EXPECT_TRUE(identities.forget(pseudonym));
    EXPECT_FALSE(identities.forget(pseudonym));
  }
  EXPECT_TRUE(check_ledger(school.places(), true).findings.empty());
  // no byte of the name in any file of the school
  for (const auto& f : std::filesystem::recursive_directory_iterator(
           std::filesystem::path(school.ledger_folder()).parent_path())) {
    if (!f.is_regular_file()) continue;
    const Bytes bytes = read_file(f.path().string());
    EXPECT_EQ(std::string(bytes.begin(), bytes.end()).find("ann.lee"), std::string::npos)
        << f.path();
  }
  EXPECT_NE(Identities(school.places().identities())
                .enrol("ann.lee@school.example", "", "exam", School::key()),
            pseudonym)
      << "who comes back is somebody new";
}

TEST(Identities, PseudonymsTellNothingAndDiffer) {
  const School school;
  Identities identities(school.places().identities());
  std::set<std::string> seen;
  for (int i = 0; i < 300; ++i) {
    const std::string p =
        identities.enrol("student " + std::to_string(i), "", "exam", School::key());
    EXPECT_EQ(p.size(), 16u);
    EXPECT_TRUE(seen.insert(p).second);
    EXPECT_EQ(identities.enrol("student " + std::to_string(i), "", "exam", School::key()), p)
        << "the same as before";
  }
  EXPECT_THROW(identities.enrol("", "", "exam", School::key()), Error);
  EXPECT_THROW(identities.enrol("a\nb", "", "exam", School::key()), Error);
}

/// Two candidates have sat it, and the first one's result is released; each test works on a copy.
class Released : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new School();
    Ledger ledger = shared_->ledger();
    for (const char* who : {"4711", "4712"})
      ASSERT_TRUE(file_session(ledger, shared_->sit(shared_->ticket(who),
                                                    who[3] == '1' ? "expert" : "novice"))
                      .seq);
    ASSERT_EQ(read_registry(ledger.content()).sessions.at(0).seq, k_first_entries + 1);
    ledger.append([](const LedgerContent&) { return ReleaseEntry{{k_first_entries + 1}}; });
  }
  static void TearDownTestSuite() { delete shared_; }
  School school_{*shared_};
  LedgerContent content_ = read_ledger(school_.places());
  Registry registry_ = read_registry(content_);

 private:
  static inline School* shared_ = nullptr;
};

TEST_F(Released, OnlyWhatWasReleasedReachesTheGradebookByName) {
  Identities identities(school_.places().identities());
  int left_out = -1;
  const std::string csv = moodle_csv(registry_, identities, left_out, english_text);
  EXPECT_EQ(left_out, 0);
  EXPECT_NE(csv.find("\n4711,"), std::string::npos) << csv;
  EXPECT_EQ(csv.find("4712"), std::string::npos);
  EXPECT_EQ(csv.find("C-"), std::string::npos) << "no pseudonym beside a name";
  const auto& released = registry_.sessions.at(0);
  EXPECT_NE(csv.find("4711," + released.result->at("score").at("points").dump() + ","),
            std::string::npos)
      << csv;

  const json scores = lti_scores(registry_, identities, english_text);
  ASSERT_EQ(scores.size(), 2u);
  for (const auto& s : scores) {
    EXPECT_EQ(s["resourceId"], "block_cavity");
    const json& score = s["score"];
    if (score["userId"] == "4711") {
      EXPECT_EQ(score["gradingProgress"], "FullyGraded");
      EXPECT_EQ(score["scoreGiven"], released.result->at("score").at("points"));
    } else {
      EXPECT_EQ(score["userId"], "4712");
      EXPECT_FALSE(score.contains("scoreGiven"));
      EXPECT_TRUE(score["gradingProgress"] == "Pending" ||
                  score["gradingProgress"] == "PendingManual");
    }
  }
}

TEST_F(Released, AFailureThatPointsDoNotDecideIsNoPassInAnyGradebook) {
  Identities identities(school_.places().identities());
  const auto export_of = [&](const std::function<void(json&)>& change) {
    Registry registry = registry_;
    json& shown = registry.sessions.at(0).shown.change();
    shown["score"] = {{"points", 86.0}, {"max", 100.0}, {"pass_percent", 60.0}};
    change(shown);
    int left_out = 0;
    const std::string csv = moodle_csv(registry, identities, left_out, english_text);
    const json scores = lti_scores(registry, identities, english_text);
    const auto mine = std::find_if(scores.begin(), scores.end(),
                                   [](const json& s) { return s["score"]["userId"] == "4711"; });
    return std::pair(csv, (*mine)["score"]);
  };
  const auto [critical_csv, critical_lti] = export_of([](json& r) {
    r["verdict"] = "fail";
    r["criteria"][0]["critical_failed"] = true;
  });
  const std::string id = registry_.sessions.at(0).shown->at("criteria").at(0).at("id");
  EXPECT_TRUE(holds(critical_csv, {"\n4711,0,fail", id, ",86", "86.0", "100"})) << critical_csv;
  EXPECT_EQ(critical_lti["scoreGiven"], 0);
  EXPECT_TRUE(holds(critical_lti["comment"], {"fail", id}));

  const auto [single_csv, single_lti] = export_of([](json& r) { r["verdict"] = "fail"; });
  EXPECT_NE(single_csv.find("\n4711,0,fail,86"), std::string::npos)
      << "one criterion below the mark, none makes up for it: " << single_csv;
  EXPECT_EQ(single_lti["scoreGiven"], 0);
  const auto [passed_csv, passed_lti] = export_of([](json& r) { r["verdict"] = "pass"; });
  EXPECT_NE(passed_csv.find("\n4711,86.0,pass,86.0"), std::string::npos) << passed_csv;
  EXPECT_EQ(passed_lti["scoreGiven"], 86.0);
  const auto [low_csv, low_lti] = export_of([](json& r) {
    r["verdict"] = "fail";
    r["score"]["points"] = 41.5;
  });
  EXPECT_NE(low_csv.find("\n4711,41.5,fail,41.5"), std::string::npos)
      << "too few points stay what they are: " << low_csv;
  EXPECT_EQ(low_lti["scoreGiven"], 41.5);
}

/// What Moodle's row and the platform's score of candidate 4711 are after a released regrade.
struct Told {
  std::vector<std::string> heading, row;
  json score;
  [[nodiscard]] std::string field(const std::string& name) const {
    const auto at = std::find(heading.begin(), heading.end(), name);
    return at == heading.end() ? "no column " + name
                               : row.at(static_cast<std::size_t>(at - heading.begin()));
  }
};
Told told_of(const Registry& registry, Identities& identities) {
  int left_out = 0;
  Told out;
  const auto table =
      parse_csv(moodle_csv(registry, identities, left_out, english_text), "moodle.csv");
  out.heading = table.at(0).fields;
  for (const auto& r : table)
    if (r.fields[0] == "4711") out.row = r.fields;
  for (const auto& s : lti_scores(registry, identities, english_text))
    if (s["score"]["userId"] == "4711") out.score = s["score"];
  return out;
}

TEST_F(Released, AFailureByAnotherPassMarkIsNoPassByTheExamsOwn) {
  Identities identities(school_.places().identities());
  Registry registry = registry_;
  FiledSession& s = registry.sessions.at(0);
  s.shown.change()["score"]["points"] = 80.752695;
  s.shown.change()["score"]["pass_percent"] = 90.0;
  s.shown.change()["verdict"] = "fail";
  ASSERT_EQ(s.filed->at("score").at("pass_percent"), 60.0);
  const Told failed = told_of(registry, identities);
  EXPECT_EQ(failed.field("block_cavity"), "0");
  EXPECT_EQ(failed.field("block_cavity points"), "80.752695");
  EXPECT_EQ(failed.score["scoreGiven"], 0);
  for (const std::string& words :
       {failed.field("block_cavity feedback"), failed.score["comment"].get<std::string>()})
    EXPECT_TRUE(holds(words, {"90 %", "60 %", "80.8", "100"})) << words;
  s.shown.change()["score"]["points"] =
      59.0;  // no pass by the exam's own mark either: it stays what it is
  EXPECT_EQ(told_of(registry, identities).field("block_cavity"), "59.0");
  s.shown.change()["score"]["pass_percent"] = 50.0;
  s.shown.change()["verdict"] = "pass";
  const Told passed = told_of(registry, identities);
  EXPECT_EQ(passed.field("block_cavity"), "60.0")
      << "a platform whose pass mark is the exam's would read 59 as a failure";
  EXPECT_EQ(passed.score["scoreGiven"], 60.0);
  EXPECT_EQ(passed.field("block_cavity points"), "59.0");
  EXPECT_TRUE(holds(passed.field("block_cavity feedback"), {"50 %", "60 %", "59.0", "100", "60"}))
      << passed.field("block_cavity feedback");
}

TEST_F(Released, AResultOutOfAnotherMaximumIsBroughtToTheExamsOwn) {
  Identities identities(school_.places().identities());
  Registry registry = registry_;
  registry.sessions.at(1).shown =
      registry.sessions.at(1).result;  // another candidate, marked by the exam's own rubric
  FiledSession& s = registry.sessions.at(0);
  s.shown.change()["score"] = {{"points", 10.0}, {"max", 20.0}, {"pass_percent", 40.0}};
  s.shown.change()["verdict"] = "pass";
  s.shown.change()["criteria"] = json::array({{{"id", "removed"}, {"points", 4.0}, {"max", 10.0}},
                                              {{"id", "other"}, {"points", 6.0}, {"max", 10.0}}});
  const Told told = told_of(registry, identities);
  EXPECT_EQ(told.field("block_cavity"), "60.0")
      << "passed, so no less than the exam's own pass mark";
  EXPECT_EQ(told.field("block_cavity points"), "50.0");
  EXPECT_EQ(told.field("block_cavity removed"), "")
      << "points of another rubric are no points of this one";
  EXPECT_EQ(told.field("block_cavity other"), "no column block_cavity other");
  EXPECT_EQ(told.score["scoreGiven"], 60.0);
  EXPECT_EQ(told.score["scoreMaximum"], 100.0);
  EXPECT_TRUE(holds(told.field("block_cavity feedback"), {"10.0", "20"}));
  s.shown.change()["verdict"] = "fail";  // by the other rubric's single-criterion rule: 50 of 100
                                         // is short of 60, and over its own 40 %
  EXPECT_EQ(told_of(registry, identities).field("block_cavity"), "0");
}

TEST_F(Released, TheLastReleasedAttemptStandsUntilANewerOneIsReleased) {
  Identities identities(school_.places().identities());
  Registry registry = registry_;
  FiledSession later = registry.sessions.at(0);
  later.seq = later.result_seq = 90;
  later.released = false;
  later.shown = json();
  later.shown_seq = 0;
  later.result.change()["score"]["points"] = 73.5;
  later.received_utc_ns += 1'000'000'000;
  registry.sessions.push_back(later);
  const double first = registry.sessions.at(0).shown->at("score").at("points").get<double>();
  Told told = told_of(registry, identities);
  EXPECT_EQ(std::stod(told.field("block_cavity")), first);
  EXPECT_EQ(told.score["gradingProgress"], "FullyGraded");
  EXPECT_EQ(told.score["scoreGiven"], first);
  const std::string before = told.score["timestamp"];
  FiledSession& released = registry.sessions.back();
  released.shown = released.result;
  released.released_utc_ns = registry.sessions.front().released_utc_ns + 5'000'000'000;
  told = told_of(registry, identities);
  EXPECT_EQ(told.field("block_cavity"), "73.5");
  EXPECT_EQ(told.score["scoreGiven"], 73.5);
  EXPECT_GT(told.score["timestamp"].get<std::string>(), before) << "a platform keeps the later one";
}

TEST_F(Released, WhatASimulatedOperatorSatIsNobodysGrade) {
  // the same candidate has sat it, and afterwards an operator sat under the ticket
  FiledSession operated = registry_.sessions.at(0);
  operated.seq = operated.shown_seq = operated.result_seq = 90;
  operated.simulated = "expert";
  operated.shown.change()["score"]["points"] = operated.result.change()["score"]["points"] = 99.5;
  registry_.sessions.push_back(operated);
  EXPECT_EQ(released_simulated(registry_), 1u);
  Identities identities(school_.places().identities());
  int left_out = 0;
  const std::string own = registry_.sessions.at(0).shown->at("score").at("points").dump();
  const std::string plain = moodle_csv(registry_, identities, left_out, english_text);
  EXPECT_NE(plain.find("\n4711," + own + ","), std::string::npos)
      << "the candidate's own attempt counts, though it is older: " << plain;
  EXPECT_EQ(plain.find("99.5"), std::string::npos);
  EXPECT_EQ(lti_scores(registry_, identities, english_text).dump().find("99.5"), std::string::npos);

  const std::string marked = moodle_csv(registry_, identities, left_out, english_text, true);
  EXPECT_NE(marked.find("\n4711," + own + ","), std::string::npos) << marked;
  EXPECT_NE(marked.find("\nSIMULATED " + operated.candidate + ",99.5,\"SIMULATED (operator expert"),
            std::string::npos)
      << marked;
  int users = 0;
  for (const auto& entry : lti_scores(registry_, identities, english_text, true)) {
    const json& score = entry["score"];
    const bool student = score["userId"] == "4711" || score["userId"] == "4712";
    users += student ? 1 : 0;
    EXPECT_NE(student, score.value("comment", "").starts_with("SIMULATED")) << score;
    if (!student) {
      EXPECT_EQ(score["userId"], "simulated:" + operated.candidate);
      EXPECT_EQ(score["scoreGiven"], 99.5);
    }
  }
  EXPECT_EQ(users, 2);
}

TEST_F(Released, ARegradeStandsBesideTheOldResultAndWaitsForItsRelease) {
  Ledger ledger = school_.ledger();
  json better = *registry_.sessions.at(0).result;
  better["score"]["points"] = 12.5;
  ledger.append(
      [&](const LedgerContent&) {
        return RegradeEntry{k_first_entries + 1, make_opening(better), {}, ""};
      },
      "appeal");
  auto registry = read_registry(ledger.content());
  EXPECT_FALSE(registry.sessions.at(0).released);
  EXPECT_EQ(registry.sessions.at(0).result->at("score").at("points"), 12.5);
  EXPECT_EQ(registry.sessions.at(0).shown, registry_.sessions.at(0).result)
      << "until then the old one stands";
  Identities identities(school_.places().identities());
  int left_out = 0;
  EXPECT_NE(moodle_csv(registry, identities, left_out, english_text)
                .find("\n4711," + registry_.sessions.at(0).result->at("score").at("points").dump()),
            std::string::npos);
  EXPECT_EQ(ledger.content().entries.at(k_first_entries + 1).as<SessionEntry>()->result.value,
            registry_.sessions.at(0).result)
      << "the sealed result stays";
  ledger.append(
      [&](const LedgerContent&) { return ReleaseEntry{{registry.sessions.at(0).result_seq}}; });
  EXPECT_TRUE(read_registry(ledger.content()).sessions.at(0).released);
  ledger.append([&](const LedgerContent&) { return ReleaseEntry{{99}}; });
  expect_kinds(check_ledger(school_.places(), false).findings,
               {Kind::entry_contradicts});  // it releases a result that does not count
}

/// What is said of `check` of a school's ledger, with what is at hand.
LedgerCheck check_all(const School& school) {
  LedgerCheck check = check_ledger(school.places(), false);
  check_owner(check, school.places(), read_ledger(school.places()), school_key_path(),
              school_public_key_path());
  return check;
}

TEST(CheckLedger, SaysWhatItCouldNotCheckAndChecksTheRest) {
  const School school;
  school.ticket("4711");
  EXPECT_TRUE(check_all(school).findings.empty());
  EXPECT_TRUE(check_all(school).not_checked.empty())
      << "with the key, the identities and the witness at hand";
  const std::string identities = school.places().identities(), key = school_key_path(),
                    known = school_public_key_path();
  std::filesystem::rename(identities, identities + ".away");
  LedgerCheck check = check_all(school);
  EXPECT_TRUE(check.findings.empty()) << check.findings[0].message();
  expect_finding(check.not_checked, Kind::identities_changed, {identities});
  test::tamper(school.places().database(), "DROP TRIGGER entry_stays; UPDATE entry SET seq = seq");
  expect_finding(check_all(school).findings, Kind::schema_differs,
                 {"entry_stays"});  // the rest is checked all the same
  write_text_file(identities, "no database");
  expect_finding(check_all(school).findings, Kind::file_unreadable, {"identities.db"});
  std::filesystem::remove(identities);
  std::filesystem::rename(identities + ".away", identities);

  std::filesystem::rename(key, key + ".away");
  expect_kinds(check_all(school).not_checked,
               {Kind::identities_changed});  // whose the ledger is, school.pub says
  std::filesystem::remove(known);
  expect_kinds(check_all(school).not_checked, {Kind::other_school, Kind::identities_changed});
  std::filesystem::remove_all(
      std::filesystem::path(witness_path(read_ledger(school.places()).id)).parent_path());
  expect_kinds(check_all(school).not_checked,
               {Kind::older_copy, Kind::other_school, Kind::identities_changed});
}

TEST(CheckLedger, ATableThatWasTakenOutIsNamedAndTheRestIsChecked) {
  for (const std::string table : {"document", "note", "entry"}) {
    const School school;
    school.ticket("4711");
    write_text_file(school.places().session("stray"), "x");
    {
      Database db = Database::open(school.places().database(), false);
      db.run(("DROP TABLE " + table).c_str());
    }
    const LedgerCheck check = check_all(school);
    expect_finding(check.findings, Kind::schema_differs, {"table " + table});
    EXPECT_EQ(text_of(words_of(check.findings)).find("no such table"), std::string::npos)
        << "in the database's own words";
    EXPECT_EQ(read_ledger(school.places()).entries.size(),
              table == "entry" ? 0u : k_first_entries + 1)
        << table;
    EXPECT_EQ(text_of(words_of(check.remarks)).find("stray") != std::string::npos, table != "entry")
        << "without entries nothing is said of the files";
    const auto adding = thrown_by([&] { static_cast<void>(school.ledger()); }),
               telling = thrown_by([&] {
                 static_cast<void>(Ledger(school.ledger_folder(), School::key(), LedgerUse::tell));
               });
    for (const auto& refused : {adding, telling}) {
      EXPECT_EQ(code_of(refused), LedgerError::damaged);
      EXPECT_NE(text_of(refused).find("table " + table), std::string::npos) << text_of(refused);
    }
    EXPECT_NE(adding->problem(), telling->problem());
  }
}

TEST(CheckLedger, AColumnThatWasRenamedIsToldAsATableThatWasAltered) {
  const School school;
  {
    Database db = Database::open(school.places().database(), false);
    db.run("ALTER TABLE document RENAME COLUMN bytes TO b");
  }
  const LedgerCheck check = check_all(school);
  expect_kinds(check.findings, {Kind::schema_differs});
  expect_finding(check.findings, Kind::schema_differs, {"table document"});
  EXPECT_EQ(code_of([&] { static_cast<void>(school.ledger()); }), LedgerError::damaged);
}

TEST(CheckLedger, WithoutItsFirstEntryNothingIsSaidOfWitnessAndKey) {
  const School school;
  test::tamper(school.places().database(), "DROP TRIGGER entry_is_kept; DELETE FROM entry");
  const LedgerCheck check = check_all(school);
  EXPECT_FALSE(check.findings.empty());
  expect_kinds(check.not_checked, {Kind::older_copy, Kind::other_school});
}

TEST(Ledger, ThatIsGoneOrEmptyIsRestoredAndNotBegunAnew) {
  const School school;
  for (const std::string end : {"", "-wal", "-shm"})
    std::filesystem::remove(school.places().database() + end);
  const auto expect_restore = [&](const std::string& what) {
    EXPECT_EQ(code_of([&] { static_cast<void>(school.ledger()); }), LedgerError::lost) << what;
    EXPECT_EQ(code_of([&] { static_cast<void>(read_ledger(school.places())); }), LedgerError::lost)
        << what;
  };
  expect_restore("gone");
  EXPECT_THROW(Ledger::create(school.ledger_folder(), "School", School::key()), Error);
  write_text_file(school.places().database(), "");
  expect_restore("empty");
  EXPECT_EQ(std::filesystem::file_size(school.places().database()), 0u)
      << "nothing was written into it";
}

TEST(CheckLedger, ASchoolsPublicKeyThatIsAnothersIsAFinding) {
  const School school;
  write_text_file(school_public_key_path(), std::string(64, 'a') + "\n");
  expect_finding(check_all(school).findings, Kind::other_school,
                 {"school.pub", std::string(64, 'a')});
  write_text_file(school_public_key_path(), "not a key\n");
  std::filesystem::remove(school_key_path());
  expect_finding(check_all(school).findings, Kind::key_unreadable, {"school.pub", "64"});
}

TEST(Receipt, ThatIsNoneIsAFinding) {
  for (const json& none : {json::parse("not json", nullptr, false), json("text"), json::array(),
                           json::object(), json{{"ledger", 7}}}) {
    const auto findings = check_receipt(none, "", nullptr);
    expect_kinds(findings, {Kind::malformed});
    EXPECT_EQ(english_text(findings.at(0).message()).find("json.exception"), std::string::npos)
        << findings[0].message();
  }
}

TEST(CandidateId, IsALineOfBoundedLength) {
  const School school;
  Identities identities(school.places().identities());
  EXPECT_NO_THROW(
      identities.enrol(std::string(k_longest_candidate, 'a'), "", "exam", School::key()));
  for (const std::string& id :
       {std::string(k_longest_candidate + 1, 'a'), std::string(5000, 'b'), std::string("a\nb")})
    EXPECT_THROW(identities.enrol(id, "", "exam", School::key()), Error);
  const std::string refusal = text_of(thrown_by([] {
    static_cast<void>(parse_people("id\n1\n" + std::string(5000, 'c') + "\n", "class.csv"));
  }));
  EXPECT_NE(refusal.find("class.csv:3: id ccc"), std::string::npos) << refusal;
  EXPECT_LT(refusal.size(), 400u) << "it does not repeat what is too long";
}

// As spreadsheets write them: semicolons, a byte order mark, capitals, columns in any order.
TEST(People, BringTheirAccommodations) {
  const auto people = parse_people(
      "\xEF\xBB\xBFName;ID;Extra_Time_Percent;left_handed;seat\r\n\"Weber; Anna\";4711;25;yes;3\r\nK\xC3\xBChn, J.;4712;;no;4\r\n;4713;;;\r\n",
      "class.csv", {"seat"});
  ASSERT_EQ(people.size(), 3u);
  EXPECT_EQ(people[0].name, "Weber; Anna");
  EXPECT_EQ(people[0].grant.extra_time_percent, 25.0);
  EXPECT_EQ(people[0].grant.left_handed, true);
  EXPECT_FALSE(people[1].grant.extra_time_percent);
  EXPECT_EQ(people[1].grant.left_handed, false);
  EXPECT_FALSE(people[2].grant.left_handed);
  EXPECT_FALSE(people[0].grant.high_contrast);
  // what the class is granted holds for who says nothing
  const scenarios::Grant all{10.0, 60.0, std::nullopt, true};
  EXPECT_EQ(together(all, people[0].grant).extra_time_percent, 25.0);
  EXPECT_EQ(together(all, people[1].grant).extra_time_percent, 10.0);
  EXPECT_EQ(together(all, people[0].grant).extra_time_s, 60.0);
  EXPECT_EQ(together(all, people[1].grant).high_contrast, true);
}

/// Why a list is refused: of several mistakes the first.
std::optional<Error> mistake_in(const std::string& text,
                                const std::vector<std::string>& passed_over = {}) {
  return thrown_by([&] { static_cast<void>(parse_people(text, "class.csv", passed_over)); });
}

TEST(People, HavePercentagesAsSpreadsheetsWriteThem) {
  const auto percent = [](const std::string& field) {
    return parse_people("id;extra_time_percent\n1;" + field + "\n", "class.csv")
        .at(0)
        .grant.extra_time_percent;
  };
  for (const char* field :
       {"25", "25%", "25 %", "25,0", "25.0", "25,0 %", "25\u00a0%", "\"25 %\"", "+25"})
    EXPECT_EQ(percent(field), 25.0) << field;
  EXPECT_EQ(percent("12,5"), 12.5);
  EXPECT_EQ(percent("0"), 0.0);
  EXPECT_EQ(percent("1"), 1.0);
  for (const char* field : {"0.25", "0,5", "0.25%", "%", "25%%", "1.000,5", "1,2,3", "2 5 %"}) {
    const auto refused = mistake_in(std::string("id;extra_time_percent\n1;") + field + "\n");
    EXPECT_TRUE(tells(refused, field)) << field;
    const bool a_share = field[0] == '0';  // 25 is what was meant
    EXPECT_EQ(tells(refused, Value(as_number(field[2] == '5' ? 50 : 25))), a_share) << field;
  }
}

TEST(People, AllMistakesOfAListAreToldAtOnce) {
  const auto mistakes = [](const std::string& text) {
    try {
      static_cast<void>(parse_people(text, "class.csv"));
    } catch (const ListMistakes& wrong) {
      std::vector<Message> all;
      for (const Error& mistake : wrong.mistakes()) all.push_back(mistake.message());
      return all;
    }
    return std::vector<Message>();
  };
  const auto told =
      mistakes("id,name,extra_time_percent\n1,A,much\n2\n3,C,25\n3,D,\n,E,\n6,F,9000\n");
  ASSERT_EQ(told.size(), 5u);
  const std::pair<const char*, Value> wanted[] = {{"class.csv:2: extra_time_percent", Name{"much"}},
                                                  {"class.csv:3", std::int64_t{1}},
                                                  {"class.csv:5", Name{"3"}},
                                                  {"class.csv:6", Name{"class.csv:6"}},
                                                  {"class.csv:7", as_number(9000)}};
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_TRUE(tells(told[i], wanted[i].first) && tells(told[i], wanted[i].second)) << told[i];
  std::string many = "id,left_handed\n";
  for (int i = 0; i < 23; ++i) many += std::to_string(i) + ",perhaps\n";
  ASSERT_EQ(mistakes(many).size(), 21u);
  EXPECT_TRUE(tells(mistakes(many).back(), Value(std::int64_t{3})))
      << "are not told: " << mistakes(many).back();
}

TEST(People, WithAColumnThatNobodyReadsAreRefusedNotShortened) {
  for (const auto& [text, why, place, name] :
       std::vector<std::tuple<std::string, std::optional<ErrorCode>, std::string, std::string>>{
           {"id,extra_time\n1,25\n", LedgerError::unknown, "class.csv:1", "extra_time"},
           {"id,seat\n1,3\n", LedgerError::unknown, "class.csv:1", "seat"},
           {"id,station\n1,Seat 3\n2,\n3,Seat 3\n", {}, "class.csv:4: station", "Seat 3"},
           {"id,name,ID\n1,a,2\n", LedgerError::twice, "class.csv:1", "id"},
           {"name\na\n", LedgerError::malformed, "class.csv:1", ""},
           {"id,extra_time_percent\n1,a quarter\n",
            {},
            "class.csv:2: extra_time_percent",
            "a quarter"},
           {"id,extra_time_percent\n1,-5\n", {}, "class.csv:2", ""},
           {"id,left_handed\n1,perhaps\n", {}, "class.csv:2: left_handed", "perhaps"}}) {
    const auto refused = mistake_in(text);
    ASSERT_TRUE(refused) << text;
    if (why) {
      EXPECT_EQ(code_of(refused), why) << text_of(refused);
    }
    EXPECT_TRUE(tells(refused, place) && (name.empty() || tells(refused, name)))
        << text_of(refused);
  }
  EXPECT_FALSE(mistake_in("id,seat\n1,3\n", {"seat"}));
  EXPECT_EQ(parse_people("id,station\n1,3\n", "class.csv").at(0).station, "3");
  EXPECT_EQ(parse_people("id,station\n1,3\n", "class.csv", {"station"}).at(0).station, "")
      << "passed over";
}

TEST(Identities, ThatAreLostAreNotBegunAnew) {
  const School school;
  std::filesystem::remove(school.places().identities());
  EXPECT_THROW(Identities(school.places().identities()), Error);
  EXPECT_FALSE(std::filesystem::exists(school.places().identities()));
}

TEST(ParseUtc, AgreesWithTheCalendar) {
  EXPECT_EQ(parse_utc("1970-01-01T00:00:00Z", "t"), 0);
  EXPECT_EQ(parse_utc("2000-02-29T12:00Z", "t"), 951825600'000'000'000);
  EXPECT_EQ(parse_utc("2026-11-21T18:30:05Z", "t"), 1795285805'000'000'000);
  for (const char* bad :
       {"2026-11-21", "2026-11-21T18:30", "2026-02-29T00:00Z", "2026-13-01T00:00Z",
        "2026-11-21T24:00Z", "21.11.2026", "2026-11-21T18:30Zx"})
    EXPECT_THROW(static_cast<void>(parse_utc(bad, "t")), Error) << bad;
  std::mt19937_64 random(testing_basics::drawn_seed("LedgerTime"));
  for (int i = 0; i < 1000; ++i) {
    const std::int64_t t = static_cast<std::int64_t>(random() % 4'000'000'000ULL) * 1'000'000'000;
    EXPECT_EQ(parse_utc(utc_text(t), "t"), t) << utc_text(t);
  }
}

}  // namespace
}  // namespace cavum::records
