// What a school keeps about people: pseudonyms that lead nowhere, accommodations that the ledger
// never holds, and recordings and results that can be erased while every proof stays valid.
#include <gtest/gtest.h>

#include "engine/base/json_fields.h"
#include "grading/records/backup.h"
#include "grading/records/erasure.h"
#include "grading/records/exports.h"
#include "grading/records/ledger_error.h"
#include "grading/records/ledger_file.h"
#include "grading/records/regrade.h"
#include "grading/records/release.h"
#include "tests/grading/records/school.h"

namespace cavum::records {
namespace {

using namespace testing_ledger;
using nlohmann::json;
using testing_basics::code_of;

/// The first file below the folder, logs and backups included, in which the text stands; empty for
/// none.
std::string where_it_stands(const std::string& folder, const std::string& text) {
  for (const auto& f : std::filesystem::recursive_directory_iterator(folder)) {
    if (!f.is_regular_file()) continue;
    const Bytes bytes = read_file(f.path().string());
    if (std::string(bytes.begin(), bytes.end()).find(text) != std::string::npos)
      return f.path().string();
  }
  return "";
}

/// A candidate with more time has sat the exam, and it is filed; each test works on a copy.
class Kept : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new School();
    const std::string ticket = shared_->ticket("Matr-4711", [](Ticket& t) {
      t.grant = {{"accommodation.extra_time_percent", "37"}};
    });
    const std::string path = shared_->sit(ticket, "expert", [](scenarios::ExamOptions& o) {
      o.notes.emplace_back("accommodation.extra_time_percent", "37");
    });
    Ledger ledger = shared_->ledger();
    const Filing filing = file_session(ledger, path);
    for (const auto& f : filing.findings) ADD_FAILURE() << f.message();
    session_ = filing.seq.value_or(0);
    std::filesystem::remove(path);
  }
  static void TearDownTestSuite() { delete shared_; }

  [[nodiscard]] LedgerContent content() const { return read_ledger(school_.places()); }
  [[nodiscard]] std::string recording() const {
    return school_.places().session(content().entries.at(session_).as<SessionEntry>()->file_sha256);
  }
  /// Everything that proves: entries, tree, signatures, witness, a receipt from before.
  void expect_proofs_hold(const json& receipt) {
    const LedgerCheck check = check_ledger(school_.places(), true);
    for (const auto& f : check.findings) ADD_FAILURE() << f.message();
    const LedgerContent now = content();
    for (const auto& f : check_receipt(receipt, now.public_key, &now)) ADD_FAILURE() << f.message();
  }

  static inline School* shared_ = nullptr;
  static inline std::uint64_t session_ = 0;
  School school_{*shared_};
};

TEST_F(Kept, AccommodationsStandInTheRecordingAloneAndNeverInTheLedger) {
  const Bytes db = read_file(school_.places().database());
  for (const auto& e : content().entries)
    EXPECT_EQ(e.text.find("extra_time"), std::string::npos) << e.text;
  EXPECT_EQ(SessionReader(recording()).setup().notes.size(), 2u) << "ticket and accommodation";
  // hidden: the same grant twice has two commitments, so nobody can try values
  const std::string a = school_.ticket("a"), b = school_.ticket("b");
  EXPECT_NE(parse_ticket(a, "", "a").grant_sha256, parse_ticket(b, "", "b").grant_sha256);
  // binding: other accommodations do not open it
  json changed = json::parse(a);
  changed["grant"] = make_opening(json{{"accommodation.extra_time_percent", "50"}}).text;
  EXPECT_THROW(static_cast<void>(parse_ticket(changed.dump(), "", "changed")), Error);
}

TEST_F(Kept, WhoIsForgottenAndComesBackWithAnOldFileIsNamedAndRemoved) {
  const std::string names = school_.places().identities(),
                    candidate = content().entries.at(session_).as<SessionEntry>()->candidate;
  const Bytes old = read_file(names);
  Ledger ledger = school_.ledger();
  forget(ledger, {candidate}, {});
  Identities(names).forget(candidate);
  write_file(names, old);
  LedgerCheck check = check_ledger(school_.places(), false);
  check_owner(check, school_.places(), content(), school_key_path(), school_public_key_path());
  expect_finding(check.findings, Kind::erased_still_there, {candidate});
  Identities back(names);
  EXPECT_EQ(remove_forgotten(content(), back), 1u);
  EXPECT_FALSE(back.of_pseudonym(candidate));
  LedgerCheck again = check_ledger(school_.places(), false);
  check_owner(again, school_.places(), content(), school_key_path(), school_public_key_path());
  EXPECT_TRUE(again.findings.empty()) << again.findings[0].message();
}

TEST_F(Kept, WhoIsTakenOutOfTheIdentitiesWithoutAnEntryIsNamed) {
  const std::string names = school_.places().identities(),
                    candidate = content().entries.at(session_).as<SessionEntry>()->candidate;
  const auto findings = [&] {
    LedgerCheck check = check_ledger(school_.places(), false);
    check_owner(check, school_.places(), content(), school_key_path(), school_public_key_path());
    return check.findings;
  };
  EXPECT_TRUE(findings().empty());
  Identities(names).forget(candidate);
  expect_finding(findings(), Kind::identity_missing, {candidate});
  EXPECT_EQ(findings().size(), 1u) << "once, however many tickets";
  Ledger ledger = school_.ledger();
  forget(ledger, {candidate}, {});
  EXPECT_TRUE(findings().empty()) << "an entry says it";
}

TEST_F(Kept, ABackupThatIsBroughtUpToDateWithoutIdentitiesForgetsInThoseThatItHas) {
  const std::string candidate = content().entries.at(session_).as<SessionEntry>()->candidate,
                    backup = school_.file("backup");
  static_cast<void>(back_up(school_.places(), backup, true));
  Ledger ledger = school_.ledger();
  forget(ledger, {candidate}, {});
  const Backup second = back_up(school_.places(), backup, false);
  EXPECT_FALSE(second.identities);
  EXPECT_TRUE(second.older_identities);
  EXPECT_EQ(where_it_stands(backup, "Matr-4711"), "");
}

TEST_F(Kept, ForgettingCancelsTicketsThatWereNotUsed) {
  const std::string ticket = school_.ticket("Matr-4711"),
                    candidate = parse_ticket(ticket, "", "ticket").candidate;
  const std::string sat = school_.sit(ticket);
  Ledger ledger = school_.ledger();
  forget(ledger, {candidate}, {});
  const auto& tickets = ledger.registry().tickets;
  EXPECT_TRUE(tickets.back().cancelled_by);
  const Filing filing = file_session(ledger, sat);
  EXPECT_FALSE(filing.seq);
  expect_kinds(filing.findings, {Kind::ticket_cancelled});
}

TEST_F(Kept, AnErasedResultIsNotReleased) {
  Ledger ledger = school_.ledger();
  erase(ledger, {.sessions = {session_}, .results = true}, "asked for");
  EXPECT_TRUE(release_results(ledger, {.all = true}).results.empty());
  EXPECT_EQ(code_of([&] { static_cast<void>(release_results(ledger, {.sessions = {session_}})); }),
            LedgerError::erased);
  // a ledger that stays open has learnt of it, too
  EXPECT_TRUE(ledger.registry().sessions.at(0).result_erased_by);
}

TEST_F(Kept, NobodysNumberMayLookLikeAPseudonym) {
  EXPECT_THROW(Identities(school_.places().identities())
                   .enrol("C-5QVG-0G6P-B89Z", "", "exam", School::key()),
               Error);
}

TEST_F(Kept, ErasedMotionIsGoneAndEveryProofHolds) {
  Ledger ledger = school_.ledger();
  const json receipt = ledger.receipt(session_);
  const std::string path = recording();
  ASSERT_TRUE(std::filesystem::exists(path));
  EXPECT_EQ(erase(ledger, {.sessions = {session_}, .motion = true}, "five years are over").size(),
            1u);
  EXPECT_FALSE(std::filesystem::exists(path));
  expect_proofs_hold(receipt);
  expect_finding(check_ledger(school_.places(), true).not_checked, Kind::not_simulated, {"1"});
  const FiledSession s = read_registry(content()).sessions.at(0);
  EXPECT_EQ(s.motion_erased_by, content().entries.size() - 1);
  EXPECT_TRUE(s.result->is_object()) << "the result is kept";
  EXPECT_THROW(static_cast<void>(recording_of(school_.places(), s)), Error);
  EXPECT_TRUE(erase(ledger, {.sessions = {session_}, .motion = true}, "again").empty())
      << "nothing is left";
}

TEST_F(Kept, AnErasedResultIsNowhereAndEveryProofHolds) {
  Ledger ledger = school_.ledger();
  const json receipt = ledger.receipt(session_);
  const std::string words = R"("criteria")";  // of a result alone; the recording bears one, too
  ASSERT_NE(where_it_stands(school_.file(""), words), "");
  const FiledSession before = read_registry(ledger.content()).sessions.at(0);
  RegradeBasis basis;
  basis.rubric_toml = "x";
  enter_regrade(ledger, session_, *before.result, basis, "an appeal");
  EXPECT_EQ(
      erase(ledger, {.sessions = {session_}, .motion = true, .results = true}, "asked for").size(),
      3u)
      << "recording, mark, regrade";
  EXPECT_EQ(where_it_stands(school_.file(""), words), "");
  EXPECT_EQ(where_it_stands(school_.file(""), "extra_time_percent"), "")
      << "a result tells of accommodations, too";
  expect_proofs_hold(receipt);
  const FiledSession s = read_registry(content()).sessions.at(0);
  EXPECT_TRUE(s.result->is_null());
  EXPECT_TRUE(s.result_erased_by);
  Identities identities(school_.places().identities());
  int left_out = 0;
  EXPECT_EQ(
      moodle_csv(read_registry(content()), identities, left_out, english_text).find("Matr-4711"),
      std::string::npos);
}

TEST_F(Kept, WhatIsTakenOutWithoutAnEntryIsFound) {
  const std::string path = recording();
  test::tamper(school_.places().database(), "DELETE FROM opening");
  expect_kinds(check_ledger(school_.places(), false).findings, {Kind::part_missing});
  std::filesystem::remove(path);
  expect_kinds(check_ledger(school_.places(), false).findings,
               {Kind::part_missing, Kind::file_gone});
}

TEST_F(Kept, WhatWasErasedAndComesBackIsFound) {
  std::string opening;
  {
    Database db = Database::open(school_.places().database(), false);
    const std::string text = db.text("SELECT text FROM opening");
    opening = "INSERT INTO opening VALUES ('" + db.text("SELECT sha256 FROM opening") +
              "', CAST(x'" + to_hex(ledger_bytes(text)) + "' AS TEXT))";
  }
  const std::string path = recording();
  const Bytes image = read_file(path);
  {
    Ledger ledger = school_.ledger();
    static_cast<void>(
        erase(ledger, {.sessions = {session_}, .motion = true, .results = true}, "asked for"));
  }
  write_file(path, image);
  expect_finding(check_ledger(school_.places(), false).findings, Kind::erased_still_there,
                 {std::to_string(session_)});
  EXPECT_EQ(remove_erased_recordings(content(), school_.places()), 1u)
      << "as after a crash between entry and removal";
  EXPECT_TRUE(check_ledger(school_.places(), false).findings.empty());
  test::tamper(school_.places().database(), opening);
  expect_finding(check_ledger(school_.places(), false).findings, Kind::erased_still_there,
                 {std::to_string(session_)});
}

TEST_F(Kept, AReaderThatKeepsTheLogInUseIsNamedAndTheLogIsWipedLater) {
  Ledger ledger = school_.ledger();
  Database reader = Database::open(school_.places().database(), false),
           writer = Database::open(school_.places().database(), false, k_short_wait);
  reader.run("BEGIN");
  EXPECT_EQ(reader.integer("SELECT count(*) FROM opening"), 1);
  static_cast<void>(school_.ticket("4712"));
  EXPECT_EQ(code_of([&] { wipe_erased(writer, "ledger"); }), LedgerError::in_use);
  reader.run("COMMIT");
  EXPECT_NO_THROW(ledger.wipe());
}

TEST_F(Kept, ForgettingErasesIdentityAndRecordingOfEveryExamAndTellsNobodyWhoItWas) {
  Ledger ledger = school_.ledger();
  const json receipt = ledger.receipt(session_);
  Identities identities(school_.places().identities());
  const std::string other = identities.enrol("Matr-4711", "", "another exam", School::key());
  std::vector<std::string> pseudonyms;
  for (const auto& i : identities.of_person("Matr-4711")) pseudonyms.push_back(i.pseudonym);
  ASSERT_EQ(pseudonyms.size(), 2u) << "one for each exam";
  forget(ledger, pseudonyms, {.motion = true, .results = true});
  for (const auto& p : pseudonyms) EXPECT_TRUE(identities.forget(p));
  EXPECT_FALSE(std::filesystem::exists(recording()));
  EXPECT_EQ(where_it_stands(school_.file(""), "Matr-4711"), "");
  EXPECT_EQ(where_it_stands(school_.file(""), "extra_time_percent"), "");
  expect_proofs_hold(receipt);
  std::size_t forgotten = 0;
  for (const auto& e : content().entries)
    if (e.as<ForgetEntry>() != nullptr) {
      ++forgotten;
      EXPECT_FALSE(e.text.find(pseudonyms[0]) != std::string::npos &&
                   e.text.find(pseudonyms[1]) != std::string::npos)
          << "no entry says that both are one person's";
    }
  EXPECT_EQ(forgotten, 2u);
}

TEST_F(Kept, MotionStaysWhenItIsAskedFor) {
  Ledger ledger = school_.ledger();
  const std::string candidate = read_registry(ledger.content()).sessions.at(0).candidate;
  forget(ledger, {candidate}, {});
  EXPECT_TRUE(std::filesystem::exists(recording()));
  EXPECT_TRUE(check_ledger(school_.places(), true).findings.empty());
}

TEST_F(Kept, ABackupForgetsWhatTheLedgerHasErased) {
  const std::string folder = school_.file("backup");
  static_cast<void>(back_up(school_.places(), folder, false));
  const std::string copy =
      LedgerPaths{folder}.session(content().entries.at(session_).as<SessionEntry>()->file_sha256);
  ASSERT_TRUE(std::filesystem::exists(copy));
  {
    Ledger ledger = school_.ledger();
    static_cast<void>(
        erase(ledger, {.sessions = {session_}, .motion = true, .results = true}, "asked for"));
  }
  const Backup backup = back_up(school_.places(), folder, false);
  EXPECT_TRUE(backup.missing.empty());
  EXPECT_FALSE(std::filesystem::exists(copy));
  EXPECT_EQ(where_it_stands(folder, "\"criteria\""), "");
  EXPECT_TRUE(plan_restore(folder, {}, {}).missing_sessions.empty());
}

TEST_F(Kept, AnEntryErasesOnlyWhatIsThereBeforeIt) {
  Ledger ledger = school_.ledger();
  EXPECT_THROW(static_cast<void>(erase(ledger, {.sessions = {1}, .motion = true}, "x")), Error)
      << "no session's entry";
  EXPECT_THROW(static_cast<void>(erase(ledger, {.sessions = {session_}, .motion = true}, "")),
               Error)
      << "no reason";
  EXPECT_TRUE(std::filesystem::exists(recording()));
  EXPECT_THROW(ledger.append(
                   [](const LedgerContent& now) {
                     return EraseEntry{{{now.entries.size() + 3, Part::motion}}};
                   },
                   "forged"),
               Error);
  expect_kinds(content().findings, {Kind::entry_contradicts});
}

TEST(Pseudonyms, AreDrawnForEachExamAndBoundToTheirRow) {
  const School school;
  Identities identities(school.places().identities());
  const std::string a = identities.enrol("Matr-4711", "Ada", "exam A", School::key()),
                    b = identities.enrol("Matr-4711", "Ada", "exam B", School::key());
  EXPECT_NE(a, b);
  EXPECT_EQ(identities.enrol("Matr-4711", "Ada", "exam A", School::key()), a);
  EXPECT_EQ(identities.of_person(a).size(), 2u);
  EXPECT_TRUE(identities.check(School::key()).empty());
  for (const char* sql : {"UPDATE identity SET exam = 'exam C' WHERE exam = 'exam A'",
                          "UPDATE identity SET name = 'Bob' WHERE exam = 'exam A'",
                          "UPDATE identity SET id = '4712' WHERE exam = 'exam A'"}) {
    const School copy(school);
    test::tamper(copy.places().identities(), sql);
    EXPECT_EQ(Identities(copy.places().identities()).check(School::key()).size(), 1u) << sql;
  }
}

TEST(Pseudonyms, AFileOfThemThatKeepsWhoIsForgottenIsRefused) {
  const School school;
  Identities(school.places().identities()).enrol("Matr-4711", "Ada", "exam", School::key());
  test::tamper(
      school.places().identities(),
      "CREATE TABLE kept (id TEXT); CREATE TRIGGER keep BEFORE DELETE ON identity BEGIN INSERT INTO kept VALUES (OLD.id); END; "
      "UPDATE identity SET id = id");
  EXPECT_THROW(Identities(school.places().identities()), Error);
}

}  // namespace
}  // namespace cavum::records
