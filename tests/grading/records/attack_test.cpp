// What somebody might try, one test each: every attempt is found, and the finding names it.
#include <nlohmann/json.hpp>

#include "engine/session/chain.h"
#include "engine/session/chain_check.h"
#include "engine/session/chunk_codec.h"
#include "grading/marking/close_exam.h"
#include "grading/records/explain_session.h"
#include "grading/records/exports.h"
#include "grading/records/ledger_error.h"
#include "grading/records/ledger_schema.h"
#include "grading/records/release.h"
#include "grading/records/station_ticket.h"
#include "tests/grading/records/school.h"

namespace cavum::records {
namespace {

using namespace testing_ledger;
using testing_basics::code_of;
using testing_basics::text_of;
using testing_basics::thrown_by;

std::string blob(std::span<const std::uint8_t> bytes) { return "x'" + to_hex(bytes) + "'"; }

/// One school, one sound session; each test works on a copy of both.
class Attack : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new School();
    shared_ticket_ = new std::string(shared_->ticket("4711"));
    shared_session_ =
        new std::string(std::filesystem::path(shared_->sit(*shared_ticket_)).filename().string());
  }
  static void TearDownTestSuite() {
    delete shared_;
    delete shared_ticket_;
    delete shared_session_;
  }
  Filing file(const std::string& path) {
    Ledger ledger = school_.ledger();
    return file_session(ledger, path);
  }
  void expect_refused(const std::string& path, Kind kind,
                      const std::vector<std::string>& words = {""}) {
    const Filing f = file(path);
    EXPECT_FALSE(f.seq);
    expect_finding(f.findings, kind, words);
    EXPECT_TRUE(read_registry(read_ledger(school_.places())).sessions.empty());
    EXPECT_TRUE(check_ledger(school_.places(), false).findings.empty());
  }
  /// Changes the ledger's file as someone with an SQLite shell would: triggers do not stop him, he
  /// puts them back afterwards.
  void edit_ledger(const std::string& sql) {
    std::string drop, make;
    {
      Database db = Database::open(school_.places().database(), false);
      auto triggers = db.prepare("SELECT name, sql FROM sqlite_schema WHERE type = 'trigger'");
      while (triggers.step()) {
        drop += "DROP TRIGGER " + triggers.text(0) + "; ";
        make += triggers.text(1) + "; ";
      }
    }
    test::tamper(school_.places().database(), drop + sql + ";" + make);
  }
  void expect_ledger_finding(Kind kind, const std::vector<std::string>& words = {""}) {
    expect_finding(check_ledger(school_.places(), false).findings, kind, words);
    EXPECT_THROW(school_.ledger(), Error) << "nothing is added to a ledger that does not hold";
  }
  struct Edit {
    std::string sql;
    Kind kind;
    std::string told = "";
  };
  /// Each edit of the ledger as it is now, and its finding; `past_triggers`: they are put back
  /// afterwards.
  void expect_found(const std::vector<Edit>& edits, bool past_triggers) {
    const Bytes sound = read_file(school_.places().database());
    for (const auto& [sql, kind, told] : edits) {
      SCOPED_TRACE(sql.substr(0, 80));
      if (past_triggers)
        edit_ledger(sql);
      else
        test::tamper(school_.places().database(), sql);
      expect_ledger_finding(kind, {told});
      write_file(school_.places().database(), sound);
    }
  }

  School school_{*shared_};
  std::string ticket_ = *shared_ticket_, session_ = school_.file(*shared_session_);

 private:
  static inline School* shared_ = nullptr;
  static inline std::string *shared_ticket_ = nullptr, *shared_session_ = nullptr;
};

TEST_F(Attack, NoneIsFiledAndHolds) {
  const Filing f = file(session_);
  ASSERT_TRUE(f.seq) << testing_basics::text_of(words_of(f.findings));
  EXPECT_TRUE(f.findings.empty());
  EXPECT_TRUE(check_ledger(school_.places(), true).findings.empty());
  const auto registry = read_registry(read_ledger(school_.places()));
  ASSERT_EQ(registry.sessions.size(), 1u);
  EXPECT_EQ(registry.tickets.at(0).used_by, f.seq);
  EXPECT_FALSE(registry.sessions[0].released);
}

TEST_F(Attack, EveryEditOfARecording) {
  auto inputs = SessionReader(session_).motion(3).inputs;
  inputs[10].tip_nm[2] += 20'000;
  for (
      const auto& [sql, told] : std::vector<std::pair<std::string, std::string>>{
          {"UPDATE chunk SET inputs = " + blob(pack_inputs(inputs)) + " WHERE seq = 3", " 3"},
          {"UPDATE event SET detail_json = '{\"step\":9}' WHERE seq = 0", ""},
          {"UPDATE chunk SET utc_ns = utc_ns - 60000000000 WHERE seq = 2", " 2"},
          {"UPDATE artifact SET bytes = CAST(replace(CAST(bytes AS TEXT), 'pass_percent', 'pass_percent ') AS BLOB) WHERE name = 'scenario.toml'",
           "scenario.toml"},
          {"UPDATE result SET json = replace(json, '\"verdict\":\"pass\"', '\"verdict\":\"fail\"')",
           ""},
          {"UPDATE artifact SET bytes = zeroblob(100) WHERE name = 'final_tooth.cvt'", ""},
          {"DELETE FROM chunk WHERE seq = 4", ""},
          {"UPDATE chunk SET seq = 1000 WHERE seq = 4; UPDATE chunk SET seq = 4 WHERE seq = 5; UPDATE chunk SET seq = 5 WHERE seq = 1000",
           ""},
          {"CREATE TEMP TABLE again AS SELECT * FROM chunk WHERE seq = 4; UPDATE again SET seq = (SELECT max(seq) + 1 FROM chunk); "
           "INSERT INTO chunk SELECT * FROM again",
           ""},
          {"DELETE FROM chunk WHERE seq > 5", ""}}) {
    SCOPED_TRACE(sql.substr(0, 80));
    const std::string edited = school_.file("edited.cavum");
    std::filesystem::copy_file(session_, edited, std::filesystem::copy_options::overwrite_existing);
    test::tamper(edited, sql);
    expect_refused(edited, Kind::recording_unsound, {told});
  }
}

TEST_F(Attack, ASessionSubmittedTwice) {
  ASSERT_TRUE(file(session_).seq);
  const Filing again = file(session_);
  EXPECT_FALSE(again.seq);
  expect_finding(again.findings, Kind::submitted_twice, {"4"});
}
TEST_F(Attack, ATicketUsedForASecondAttempt) {
  ASSERT_TRUE(file(session_).seq);
  const Filing second = file(school_.sit(ticket_, "novice"));
  EXPECT_FALSE(second.seq);
  expect_finding(second.findings, Kind::ticket_used, {"4"});
}
TEST_F(Attack, AnOldTicket) {
  const std::string old = school_.ticket("4712", [](Ticket& t) {
    t.not_before_utc_ns -= 48 * k_hour_ns;
    t.not_after_utc_ns -= 48 * k_hour_ns;
  });
  expect_refused(school_.sit(old), Kind::ticket_time);
}
TEST_F(Attack, AnotherCandidatesSession) {
  expect_refused(school_.sit(ticket_, "expert",
                             [](scenarios::ExamOptions& o) { o.candidate = "C-AAAA-BBBB-CCCC"; }),
                 Kind::ticket_candidate, {"C-AAAA-BBBB-CCCC"});
}
TEST_F(Attack, MoreTimeThanWasGranted) {
  expect_refused(school_.sit(ticket_, "expert",
                             [](scenarios::ExamOptions& o) { o.grant.extra_time_percent = 50; }),
                 Kind::ticket_accommodations);
}
TEST_F(Attack, AnotherForceModel) {
  expect_refused(
      school_.sit(ticket_, "expert", [](scenarios::ExamOptions& o) { o.force_model = "paper"; }),
      Kind::ticket_artifact, {"force_model.toml"});
}
TEST_F(Attack, ATicketMadeByAnotherKey) {
  const Ticket t = parse_ticket(ticket_, "", "ticket");
  Ticket forged = t;
  const SigningKey forger = load_signing_key(school_.file("forger.key"), "school");
  forged.public_key = to_hex(forger.public_key);
  expect_refused(school_.sit(sign_ticket(forged, forger).text), Kind::ticket_other_school);
}
TEST_F(Attack, ATicketChangedAfterSigning) {
  auto j = nlohmann::json::parse(ticket_);
  j["ticket"]["not_after"] = "2100-01-01T00:00:00Z";
  const std::string changed = j.dump();
  EXPECT_THROW(static_cast<void>(parse_ticket(changed, "", "ticket")), Error);
}
TEST_F(Attack, ATicketThatWasNeverIssued) {
  Ticket own = parse_ticket(ticket_, "", "ticket");
  own.nonce = random_hex(16);
  expect_refused(school_.sit(sign_ticket(own, School::key()).text), Kind::ticket_unknown);
}
TEST_F(Attack, ASimulatedOperatorInTheCandidatesPlace) {
  const std::string simulated = school_.sit(ticket_, "expert", [](scenarios::ExamOptions& o) {
    o.notes.emplace_back("operator", "expert");
  });
  expect_refused(simulated, Kind::no_hand, {"'expert'"});
  Ledger ledger = school_.ledger();
  ASSERT_TRUE(file_session(ledger, simulated, {.simulated = true}).seq);
  EXPECT_EQ(read_registry(ledger.content()).sessions.at(0).simulated, "expert")
      << "it stays marked";
}
TEST_F(Attack, APseudonymWithoutItsTicket) {
  const std::string session = school_.sit("", "expert", [&](scenarios::ExamOptions& o) {
    o.candidate = parse_ticket(ticket_, "", "ticket").candidate;
  });
  Ledger ledger = school_.ledger();
  const Filing f = file_session(ledger, session, {.without_ticket = true});
  EXPECT_FALSE(f.seq);
  expect_finding(f.findings, Kind::ticket_missing);
}
TEST_F(Attack, NamesExchangedAmongTheIdentities) {
  school_.ticket("4712");
  test::tamper(
      school_.places().identities(),
      "UPDATE identity SET id = 'x' WHERE id = '4711'; UPDATE identity SET id = '4711' WHERE id = '4712'; UPDATE identity SET id = '4712' "
      "WHERE id = 'x'");
  EXPECT_EQ(Identities(school_.places().identities()).check(School::key()).size(), 2u);
}
TEST_F(Attack, AResultThatIsNone) {
  // a station with a key of its own may seal anything as its result
  for (const char* result :
       {R"("pass")", R"({"verdict":"pass"})",
        R"({"verdict":"pass","score":{"points":"all","max":1},"criteria":[]})"}) {
    const auto setup = SessionReader(session_).setup();
    const std::string path = school_.file("sealed.cavum");
    std::filesystem::remove(path);
    const Simulation simulation = make_simulation(setup, "test");
    Recorder::create(path, setup).close(save_tooth(drilled_tooth(simulation)), result);
    expect_refused(path, Kind::result_differs, {" 0"});
  }
}
TEST_F(Attack, NoTicketAtAll) { expect_refused(school_.sit(""), Kind::ticket_missing); }

TEST_F(Attack, EveryEditOfAFiledEntry) {
  ASSERT_TRUE(file(session_).seq);
  std::string text = read_ledger(school_.places()).entries.at(4).text;
  text.replace(text.find("\"findings\":[]"), 13, "\"findings\":[7]");
  const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(text.data()),
                                            text.size());
  expect_found(
      {{"UPDATE opening SET text = replace(text, '\"verdict\":\"pass\"', '\"verdict\":\"fail\"')",
        Kind::part_changed, " 4"},
       {"UPDATE entry SET text = replace(text, '\"findings\":[]', '\"findings\":[1]') WHERE seq = 4",
        Kind::entry_changed, " 4"},
       {"DELETE FROM opening", Kind::part_missing, " 4"},
       {"UPDATE entry SET text = CAST(" + blob(bytes) +
            " AS TEXT), leaf_sha256 = " + blob(leaf_hash(bytes)) + " WHERE seq = 4",
        Kind::tree_differs, " 5"},
       {"DELETE FROM entry WHERE seq = 4", Kind::entry_missing},
       {"DELETE FROM entry WHERE seq = 4; DELETE FROM note WHERE size = 5", Kind::older_copy,
        " 5"}},
      true);
}
TEST_F(Attack, EveryEditOfTheLedgersTables) {
  expect_found(
      {{"INSERT INTO opening VALUES ('" + std::string(64, '0') +
            "', '{\"salt\":\"\",\"value\":1}')",
        Kind::foreign, "000"},
       {"INSERT INTO entry VALUES (4, '{\"body\":{\"results\":[2]},\"kind\":\"release\",\"seq\":4,\"utc_ns\":1}', zeroblob(32))",
        Kind::entry_changed, " 4"}},
      true);
  const std::string
      changed = "DROP TRIGGER entry_stays; UPDATE entry SET seq = seq; ",
      own =
          "CREATE TABLE notes (x); INSERT INTO notes VALUES (1); CREATE INDEX by_text ON entry (text)";
  expect_found(
      {{changed, Kind::schema_differs, "entry_stays"},
       {changed + "CREATE TRIGGER entry_stays BEFORE UPDATE ON entry BEGIN SELECT 1; END",
        Kind::schema_differs, "entry_stays"},
       {changed +
            "DROP VIEW session; CREATE VIEW session AS SELECT seq, 'pass' AS verdict FROM entry",
        Kind::schema_differs, "session"},
       {own, Kind::schema_differs, "notes"},
       {own, Kind::schema_differs, "by_text"}},
      false);
}
TEST_F(Attack, ALedgerPutBackToAnOlderCopy) {
  const Bytes old = read_file(school_.places().database());
  ASSERT_TRUE(file(session_).seq);
  write_file(school_.places().database(), old);
  expect_ledger_finding(Kind::older_copy, {" 4 ", " 5"});
}
TEST_F(Attack, ALedgerPutBackAndGrownAgain) {
  const std::string witness = witness_path(read_ledger(school_.places()).id);
  const Bytes old = read_file(school_.places().database()), old_witness = read_file(witness);
  const Filing filed = file(session_);
  ASSERT_TRUE(filed.seq);
  const auto receipt = school_.ledger().receipt(*filed.seq);
  const Bytes full_witness = read_file(witness);
  write_file(school_.places().database(), old);
  write_file(witness, old_witness);  // he thought of that, too
  school_.ticket("4713");
  EXPECT_TRUE(check_ledger(school_.places(), false).findings.empty())
      << "nothing on this computer remembers";
  const LedgerContent now = read_ledger(school_.places());
  expect_kinds(check_receipt(receipt, now.public_key, &now), {Kind::rewritten});
  write_file(witness, full_witness);
  expect_ledger_finding(Kind::rewritten);
}
TEST_F(Attack, AFiledSessionChangedInItsFolder) {
  ASSERT_TRUE(file(session_).seq);
  const auto filed = read_registry(read_ledger(school_.places())).sessions.at(0);
  std::filesystem::copy_file(school_.sit(ticket_, "novice"),
                             school_.places().session(filed.file_sha256),
                             std::filesystem::copy_options::overwrite_existing);
  expect_finding(check_ledger(school_.places(), false).findings, Kind::file_changed, {"4"});
  std::filesystem::remove(school_.places().session(filed.file_sha256));
  expect_finding(check_ledger(school_.places(), false).findings, Kind::file_gone, {"4"});
}
TEST_F(Attack, AReceiptThatWasImproved) {
  const Filing filed = file(session_);
  ASSERT_TRUE(filed.seq);
  const auto receipt = school_.ledger().receipt(*filed.seq);
  EXPECT_TRUE(check_receipt(receipt, "", nullptr).empty());
  auto better = receipt;
  std::string entry = better["entry"];
  EXPECT_EQ(entry.find("verdict"), std::string::npos) << "a receipt shows no marks";
  entry.replace(entry.find("\"findings\":[]"), 13, "\"findings\":[7]");
  better["entry"] = entry;
  expect_kinds(check_receipt(better, "", nullptr), {Kind::tree_differs});
  auto other = receipt;
  std::string note = other["checkpoint"];
  note.replace(note.find("\nutc_ns ") - 4, 3, "AAA");  // the root's end
  other["checkpoint"] = note;
  expect_kinds(check_receipt(other, "", nullptr), {Kind::signature_invalid, Kind::tree_differs});
  expect_kinds(check_receipt(nlohmann::json::array(), "", nullptr), {Kind::malformed});
}
TEST_F(Attack, ExportedResultsThatWereImproved) {
  ASSERT_TRUE(file(session_).seq);
  const Ledger ledger = school_.ledger();
  std::string text = signed_results(read_registry(ledger.content()), ledger);
  const std::string& key = ledger.content().public_key;
  EXPECT_TRUE(check_results(text, key, &ledger.content()).empty());
  EXPECT_TRUE(check_results(text + "\n", "", nullptr).empty());
  expect_kinds(check_results(text, std::string(64, '0'), nullptr), {Kind::other_school});
  // a second list of results, which some programs read and others do not
  std::string twice = text;
  twice.insert(1, "\"results\":[],");
  expect_kinds(check_results(twice, key, nullptr), {Kind::malformed});
  expect_kinds(check_results("[]", key, nullptr), {Kind::malformed});
  text.replace(text.find("\"pass\""), 6, "\"fail\"");
  expect_kinds(check_results(text, key, &ledger.content()), {Kind::signature_invalid});
}
/// A copy of a closed session as somebody makes it who wants a better end: without the end, and not
/// closed.
std::string cut_back(const School& school, const std::string& session, const std::string& name) {
  const std::string cut = school.file(name);
  std::filesystem::copy_file(session, cut);
  test::tamper(
      cut,
      "DELETE FROM seal; DELETE FROM result; DELETE FROM event WHERE chunk > 3; DELETE FROM chunk WHERE seq > 3; DELETE FROM artifact WHERE "
      "name = 'final_tooth.cvt'");
  return cut;
}
/// Takes it up as `exam --resume --end` does at the station of the present CAVUM_HOME, and closes
/// it.
void close_again(const std::string& session) {
  const auto setup = scenarios::prepare_exam(SessionReader(session).setup());
  const auto exam = scenarios::Exam::resume(
      *setup, session, {{}, require_not_closed(setup->session.notes, session)});
  if (!exam->over()) exam->end();
  static_cast<void>(grading::grade_and_close(*exam));
}

TEST_F(Attack, AnExamCutBackAndEndedAgainAtAnotherStation) {
  const std::string cut = cut_back(school_, session_, "cut.cavum");
  const std::string home = getenv("CAVUM_HOME");
  setenv("CAVUM_HOME", school_.file("another_station").c_str(), 1);
  close_again(cut);
  setenv("CAVUM_HOME", home.c_str(), 1);
  const SessionExplanation told = explain_session(cut, "");
  EXPECT_FALSE(told.holds);
  expect_finding(told.findings, Kind::station_changed, {"4000"});
  expect_refused(cut, Kind::station_changed, {"4000"});
}
TEST_F(Attack, AnExamTakenUpAgainWhereTheMemoryOfUsedTicketsIsGone) {
  const std::string cut = cut_back(school_, session_, "cut.cavum");
  std::filesystem::remove(used_tickets_path());
  close_again(cut);
  expect_kinds(explain_session(cut, "").findings, {Kind::station_changed});
  expect_refused(cut, Kind::station_changed);
}
TEST_F(Attack, NoneIsAnExamThatWasKilledAndTakenUpAgainAtItsStation) {
  // the same file, at a station that began it and did not close it: what a crash leaves. A memory
  // that was put back to that looks alike.
  remember_use({parse_ticket(ticket_, "", "ticket"), ticket_, "t"}, "exam.cavum");
  const std::string cut = cut_back(school_, session_, "cut.cavum");
  const SessionExplanation open = explain_session(cut, "");
  EXPECT_FALSE(open.holds);
  EXPECT_TRUE(open.interrupted);
  close_again(cut);
  const Filing f = file(cut);
  EXPECT_TRUE(f.seq) << testing_basics::text_of(words_of(f.findings));
  EXPECT_TRUE(f.findings.empty());
  const SessionExplanation told = explain_session(cut, "");
  EXPECT_TRUE(told.holds);
  EXPECT_FALSE(told.interrupted);
  expect_told(words_of(told.remarks), {"4000"});
}
TEST_F(Attack, TwoEndingsOfOneExam) {
  remember_use({parse_ticket(ticket_, "", "ticket"), ticket_, "t"}, "exam.cavum");
  const std::string cut = cut_back(school_, session_, "cut.cavum");
  close_again(cut);
  const Filing first = file(cut);
  ASSERT_TRUE(first.seq);
  // whoever holds the other ending can show it
  const Filing other = file(session_);
  EXPECT_FALSE(other.seq);
  expect_finding(other.findings, Kind::ticket_used, {"4", "4000"});
  EXPECT_FALSE(read_registry(read_ledger(school_.places())).sessions.at(0).doubtful());
  Ledger ledger = school_.ledger();
  const Filing contest = file_session(ledger, session_, {.with_findings = true});
  ASSERT_TRUE(contest.seq);
  const Registry registry = read_registry(ledger.content());
  ASSERT_EQ(registry.sessions.size(), 2u);
  EXPECT_EQ(registry.sessions[0].contested_by, std::vector<std::uint64_t>{*contest.seq});
  EXPECT_TRUE(registry.sessions[0].doubtful()) << "what was filed as sound goes to a person, too";
  expect_finding(check_ledger(school_.places(), false).remarks, Kind::contested, {"4", "5"});

  // a person chooses one, by its entry, and that one alone counts
  const std::string candidate = registry.sessions[0].candidate;
  const auto refused = [&](const ReleaseCommand& wish, const std::optional<ErrorCode>& why,
                           const std::vector<std::string>& names) {
    const auto error = thrown_by([&] { release_results(ledger, wish); });
    EXPECT_EQ(code_of(error), why) << text_of(error);
    for (const auto& n : names)
      EXPECT_NE(text_of(error).find(n), std::string::npos)
          << "'" << n << "' is missing in: " << text_of(error);
    EXPECT_TRUE(std::none_of(ledger.content().entries.begin(), ledger.content().entries.end(),
                             [](const LedgerEntry& e) { return e.as<ReleaseEntry>() != nullptr; }));
  };
  refused({.with_findings = true, .candidates = {candidate}}, LedgerError::contested,
          {candidate, "4", "5"});
  refused({.with_findings = true, .sessions = {4, 5}}, LedgerError::contested, {"4", "5"});
  refused({.sessions = {4}}, LedgerError::questioned, {"4", "5"});
  refused({.with_findings = true, .sessions = {1}}, LedgerError::unknown, {"1"});
  EXPECT_EQ(release_results(ledger, {.all = true}).withheld, 2u);
  // both at once is no choice
  ledger.append([](const LedgerContent&) { return ReleaseEntry{{4, 5}}; });
  for (const auto& s : read_registry(ledger.content()).sessions)
    EXPECT_TRUE(s.shown->is_null() && s.doubtful()) << s.seq;
  expect_finding(check_ledger(school_.places(), false).remarks, Kind::release_void, {"4", "5"});
  EXPECT_EQ(release_results(ledger, {.with_findings = true, .sessions = {4}}).results,
            std::vector<std::uint64_t>{4});
  const auto again =
      thrown_by([&] { release_results(ledger, {.with_findings = true, .sessions = {5}}); });
  EXPECT_EQ(code_of(again), LedgerError::contested);
  EXPECT_NE(text_of(again).find("4"), std::string::npos)
      << "it was chosen before: " << text_of(again);
  EXPECT_EQ(
      release_results(ledger, {.with_findings = true, .candidates = {candidate}}).results.size(),
      0u)
      << "the other is not released with it";
  // not even by an entry that some other program makes
  ledger.append([](const LedgerContent&) { return ReleaseEntry{{5}}; });
  const Registry chosen = read_registry(ledger.content());
  EXPECT_TRUE(chosen.findings.empty());
  expect_finding(check_ledger(school_.places(), false).remarks, Kind::release_void, {"5", "4"});
  EXPECT_FALSE(chosen.sessions[0].doubtful()) << "it counts in a class's figures";
  EXPECT_TRUE(chosen.sessions[1].doubtful());
  EXPECT_TRUE(chosen.sessions[1].shown->is_null());
  Identities identities(school_.places().identities());
  int left_out = 0;
  const std::string csv = moodle_csv(chosen, identities, left_out, english_text);
  EXPECT_NE(csv.find("\n4711," + chosen.sessions[0].filed->at("score")["points"].dump() + ","),
            std::string::npos)
      << csv;
  EXPECT_NE(csv.find(" 5"), std::string::npos) << "the ending that was not chosen: " << csv;
  const auto scores = lti_scores(chosen, identities, english_text);
  ASSERT_EQ(scores.size(), 1u);
  EXPECT_EQ(scores[0]["score"]["scoreGiven"], chosen.sessions[0].filed->at("score")["points"]);
  EXPECT_NE(scores[0]["score"]["comment"].get<std::string>().find(" 5"), std::string::npos);
}
TEST_F(Attack, AnEndingThatWasReleasedBeforeItWasContested) {
  remember_use({parse_ticket(ticket_, "", "ticket"), ticket_, "t"}, "exam.cavum");
  const std::string cut = cut_back(school_, session_, "cut.cavum");
  close_again(cut);
  Ledger ledger = school_.ledger();
  ASSERT_TRUE(file_session(ledger, cut).seq);
  ASSERT_EQ(release_results(ledger, {.all = true}).results.size(), 1u);
  ASSERT_TRUE(file_session(ledger, session_, {.with_findings = true}).seq);
  const auto now = [&] { return read_registry(ledger.content()).sessions; };
  const std::uint64_t other = now().at(1).seq;
  EXPECT_TRUE(now()[0].released && now()[0].doubtful()) << "it stands, and a person has to look";
  EXPECT_EQ(release_results(ledger, {.with_findings = true, .sessions = {other}}).results.size(),
            1u);
  EXPECT_TRUE(now()[0].shown->is_null()) << "one counts";
  EXPECT_FALSE(now()[0].released);
  EXPECT_TRUE(now()[1].chosen);
  EXPECT_EQ(now()[1].shown, now()[1].filed);
  EXPECT_TRUE(check_ledger(school_.places(), true).findings.empty());
}
TEST_F(Attack, ABeginningThatIsSaidToBeAnotherStations) {
  const std::string cut = cut_back(school_, session_, "cut.cavum");
  EXPECT_TRUE(check_chain(SessionReader(cut)).empty());
  test::tamper(cut,
               "UPDATE meta SET value = '" + std::string(64, 'b') + "' WHERE key = 'station_key'");
  // and the chain is made anew, as anybody can who reads how its hashes are made
  const SessionReader changed(cut);
  Sha256 before = genesis_hash(changed.meta(), changed.artifacts());
  std::string sql;
  for (ChunkRow c : changed.chunks()) {
    c.prev_sha256 = before;
    before = chunk_hash(c);
    sql += "UPDATE chunk SET prev_sha256 = " + blob(c.prev_sha256) + ", sha256 = " + blob(before) +
           " WHERE seq = " + std::to_string(c.seq) + ";";
  }
  test::tamper(cut, sql);
  const auto findings = check_chain(SessionReader(cut));
  EXPECT_EQ(findings.size(), 1u);
}
TEST_F(Attack, AnAppealFilesWhatDoesNotHoldAndNeverReleasesItUnseen) {
  test::tamper(session_, "UPDATE chunk SET utc_ns = utc_ns - 60000000000 WHERE seq = 2");
  Ledger ledger = school_.ledger();
  const Filing f = file_session(ledger, session_, {.with_findings = true});
  ASSERT_TRUE(f.seq);
  expect_finding(f.findings, Kind::recording_unsound, {" 2"});
  EXPECT_EQ(read_registry(ledger.content()).sessions.at(0).findings, f.findings);
  EXPECT_TRUE(check_ledger(school_.places(), true).findings.empty());
}

}  // namespace
}  // namespace cavum::records
