// The school believes neither the sealed result nor the recorded events, and no station that it
// does not know. Each attempt is one that needs nothing but a copy of the program.
#include "grading/marking/school_mark.h"

#include "grading/records/claims.h"
#include "grading/records/ledger_error.h"
#include "grading/records/stations.h"
#include "tests/grading/records/school.h"

namespace cavum::records {
namespace {

using namespace testing_ledger;
using nlohmann::json;
using testing_basics::code_of;
using testing_basics::tells;
using testing_basics::thrown_by;

/// The same exam recorded anew by a program of somebody's own: the same motion, signed by whatever
/// key lies in CAVUM_HOME, with what he likes beside it.
struct Forgery {
  std::function<void(SessionSetup&)> setup = {};
  std::function<void(std::vector<TimedEvent>&)> events = {};
  std::function<void(json& result)> result = {};
  std::int64_t later_s = 0;  ///< by which all clocks are put forward
};
std::string forged(const School& school, const std::string& session, const Forgery& how) {
  static int number = 0;
  const std::string path = school.file("forged-" + std::to_string(++number) + ".cavum");
  const SessionReader real(session);
  SessionSetup setup = real.setup();
  if (how.setup) how.setup(setup);
  auto events = real.events();
  if (how.events) how.events(events);
  json result = json::parse(real.result_json());
  if (how.result) how.result(result);
  Simulation simulation = make_simulation(setup, "forgery");
  std::int64_t tick = 0;
  const Clocks begun = real.created();
  Recorder recorder = Recorder::create(path, setup, [&] {
    const std::int64_t ns = tick * 1'000'000 + how.later_s * 1'000'000'000;
    return Clocks{begun.monotonic_ns + ns, begun.boot_ns + ns, begun.utc_ns + ns};
  });
  std::size_t next = 0;
  for (const auto& input : real.inputs()) {
    const TickOutput output = step(simulation.model, simulation.state, input);
    for (; next < events.size() && events[next].tick <= tick; ++next)
      recorder.add_event(events[next].tick, events[next].event);
    ++tick;
    recorder.append(input, make_tick_record(output), simulation.state.removed,
                    state_hash(simulation.state));
  }
  for (; next < events.size(); ++next) recorder.add_event(events[next].tick, events[next].event);
  recorder.close(save_tooth(drilled_tooth(simulation)), result.dump());
  return path;
}

class SchoolMarks : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new School();
    session_name_ = new std::string(
        std::filesystem::path(shared_->sit(shared_->ticket("4711"), "novice")).filename().string());
  }
  static void TearDownTestSuite() {
    delete shared_;
    delete session_name_;
  }
  Filing file(const std::string& path, const FilingOptions& options = {}) {
    Ledger ledger = school_.ledger();
    return file_session(ledger, path, options);
  }
  Findings refused(const std::string& path) {
    const Filing f = file(path);
    EXPECT_FALSE(f.seq);
    EXPECT_TRUE(read_registry(read_ledger(school_.places())).sessions.empty());
    return f.findings;
  }
  static void improve(json& result) {
    result["verdict"] = "pass";
    result["score"]["points"] = 100.0;
    for (auto& c : result["criteria"]) c["points"] = c["max"];
  }

  School school_{*shared_};
  std::string session_ = school_.file(*session_name_);

 private:
  static inline School* shared_ = nullptr;
  static inline std::string* session_name_ = nullptr;
};

TEST_F(SchoolMarks, TheSameAsTheStationWhereBothAreHonest) {
  const std::string again = forged(school_, session_, {});
  grading::ExamContexts grounds;
  const grading::SchoolMark mark = grading::mark_again(SessionReader(again), grounds);
  EXPECT_TRUE(mark.holds()) << testing_basics::text_of(mark.findings());
  EXPECT_EQ(mark.result, json::parse(SessionReader(session_).result_json()));
  EXPECT_TRUE(mark.sealed_otherwise.is_null());
  EXPECT_TRUE(file(again).seq);
}
TEST_F(SchoolMarks, PointsThatWereSetAndAKeyThatNobodyKnows) {
  for (const auto& [better, new_key] : {std::pair{true, false}, {true, true}, {false, true}}) {
    std::optional<AtStation> forger;
    if (new_key) forger.emplace(school_.file("forger"));
    const std::string path =
        forged(school_, session_, better ? Forgery{.result = improve} : Forgery{});
    forger.reset();
    const auto findings = refused(path);
    EXPECT_EQ(findings.size(), (better ? 1u : 0u) + (new_key ? 1u : 0u));
    if (better)
      expect_finding(findings, Kind::result_differs, {"pass", "fail", "100", "damage", "removed"});
    if (new_key)
      expect_finding(findings, Kind::station_unknown,
                     {to_hex(SessionReader(path).seal()->public_key)});
  }
}
TEST_F(SchoolMarks, AResultOfAnotherVersionOrOfNoneAndEventsThatWereNotSo) {
  using Events = std::vector<TimedEvent>;
  for (const auto& [how, told] : std::vector<std::pair<Forgery, std::vector<std::string>>>{
           {{.result = [](json& r) { r["grading_version"] = grading::k_grading_version + 1; }},
            {std::to_string(grading::k_grading_version + 1)}},
           {{.result = [](json& r) { r.erase("grading_version"); }}, {" 0"}},
           {{.events = [](Events& e) { e.erase(e.begin()); }}, {" 0 ", "'step_started"}},
           {{.events =
                 [](Events& e) {
                   e.insert(e.begin() + 1, {5, StepCompleted{}});
                 }},
            {" 1 ", "'step_completed"}},
           {{.events =
                 [](Events& e) {
                   e.insert(e.begin() + 1, {3000, Finished{Finish::ended}});
                 }},
            {" 3000"}}})  // which hides what came after it
    expect_finding(refused(forged(school_, session_, how)),
                   how.events ? Kind::exam_differs : Kind::result_differs, told);
}
TEST_F(SchoolMarks, WhateverMovedItButAHand) {
  for (const SourceKind kind : {SourceKind::simulated_operator, SourceKind::motion_file,
                                SourceKind::practice, SourceKind::pointer, SourceKind::program}) {
    const std::string path = forged(school_, session_, {.setup = [&](SessionSetup& s) {
                                      s.source = {kind, "somewhat"};
                                    }});
    expect_finding(refused(path), Kind::no_hand, {"somewhat"});
    const AtStation here(school_.file("station"));
    const School other(school_);
    Ledger ledger = other.ledger();
    ASSERT_TRUE(file_session(ledger, path, {.simulated = true}).seq) << text_of(kind);
    EXPECT_NE(read_registry(ledger.content()).sessions.at(0).simulated, "") << "it stays marked";
  }
}
TEST_F(SchoolMarks, ANoteOfAnOperatorBesideADeviceAlsoOneThatSaysNothing) {
  for (const std::string& note : {std::string("expert"), std::string()})
    expect_kinds(refused(forged(
                     school_, session_,
                     {.setup = [&](SessionSetup& s) { s.notes.emplace_back("operator", note); }})),
                 {Kind::no_hand});
}
TEST_F(SchoolMarks, ANameThatIsNoTextIsAFindingAndTheExamIsNotLost) {
  const std::string path = forged(school_, session_, {.setup = [](SessionSetup& s) {
                                    s.source.name =
                                        "\xff"
                                        "A";
                                  }});
  expect_kinds(refused(path), {Kind::text_unclean});
  const Filing filed = file(path, {.with_findings = true});
  ASSERT_TRUE(filed.seq);
  EXPECT_TRUE(check_ledger(school_.places(), true).findings.empty());
}
TEST_F(SchoolMarks, AServoThatRunsOtherwiseThanTheExams) {
  const auto with = [&](const std::string& was, const std::string& is) {
    return forged(school_, session_, {.setup = [&](SessionSetup& setup) {
                    const auto at = setup.servo_toml.find(was);
                    ASSERT_NE(at, std::string::npos) << setup.servo_toml;
                    setup.servo_toml.replace(at, was.size(), is);
                  }});
  };
  expect_finding(refused(with("tick_s = 0.001", "tick_s = 0.002")), Kind::exam_differs,
                 {"tick_s", "0.002"});
  expect_finding(refused(with("max_rpm = 2", "max_rpm = 4")), Kind::exam_differs,
                 {"max_rpm", "400000", "200000"});
  expect_finding(refused(with("spin_up_s = 0.1", "spin_up_s = 0.0")), Kind::exam_differs,
                 {"spin_up_s", "0.0"});
}

TEST_F(SchoolMarks, AStylusThatTheStationDoesNotHave) {
  Ledger ledger = school_.ledger();
  const std::string code = invite_station(ledger, "Seat 2", read_clocks().utc_ns + k_hour_ns),
                    ticket = school_.ticket("4712");
  const AtStation second(school_.file("second"));
  const SigningKey key = load_station_key(station_key_path());
  ledger.refresh();
  static_cast<void>(enrol_station(ledger,
                                  station_request(key, ledger.content().public_key,
                                                  {{SourceKind::device, "falcon", "F7"}}, code),
                                  0, "request"));
  expect_finding(file_session(ledger, school_.sit(ticket)).findings, Kind::device_other,
                 {"emulated stylus", "E1"});
}
TEST_F(SchoolMarks, AnExamSatFasterThanTime) {
  const std::string fast = school_.file("fast.cavum");
  const SessionReader real(session_);
  Simulation simulation = make_simulation(real.setup(), "test");
  Recorder recorder = Recorder::create(fast, real.setup());  // the computer's own clocks
  for (const auto& input : real.inputs()) {
    const TickOutput output = step(simulation.model, simulation.state, input);
    recorder.append(input, make_tick_record(output), simulation.state.removed,
                    state_hash(simulation.state));
  }
  recorder.close(save_tooth(drilled_tooth(simulation)), real.result_json());
  expect_finding(refused(fast), Kind::clock, {" 1000"});  // from that tick on its clock is behind
}
TEST_F(SchoolMarks, AnExamHandedInAfterItsTime) {
  const SessionReader session(session_);
  const LedgerContent content = read_ledger(school_.places());
  const std::int64_t now = read_clocks().utc_ns;
  EXPECT_TRUE(check_claims(content, session, now).empty());
  const std::int64_t late = now + 13 * 24 * k_hour_ns;
  expect_kinds(check_claims(content, session, late), {Kind::handed_in_late});
  expect_finding(check_claims(content, session, late), Kind::handed_in_late, {utc_text(late)});
  expect_kinds(check_claims(content, session, now - k_hour_ns),
               {Kind::clock});  // it ended after it was handed in
}
TEST_F(SchoolMarks, ALogThatLiesBesideTheFileIsCheckedAndKeptWithIt) {
  // a program that was killed between sealing and checkpoint leaves the seal in the log; so does
  // who plants one
  const std::string path = school_.file("logged.cavum");
  std::filesystem::copy_file(session_, path);
  const auto leave_log = [&](const char* sql) {
    Database db = Database::open(path, false);
    db.run("PRAGMA journal_mode = WAL; PRAGMA wal_autocheckpoint = 0");
    db.run(sql);
    const Bytes log = read_file(path + "-wal"), bare = read_file(path);
    db.close();
    write_file(path, bare);
    write_file(path + "-wal", log);
  };
  leave_log(
      "UPDATE result SET json = replace(json, '\"verdict\":\"fail\"', '\"verdict\":\"pass\"') WHERE 0; PRAGMA user_version = 1");
  const Filing sound = file(path);
  ASSERT_TRUE(sound.seq) << sound.findings[0].message();
  EXPECT_TRUE(check_ledger(school_.places(), true).findings.empty())
      << "what was kept is what was checked";
  const AtStation here(school_.file("station"));
  const School other(school_);
  std::filesystem::remove(path + "-wal");
  std::filesystem::copy_file(session_, path, std::filesystem::copy_options::overwrite_existing);
  leave_log("UPDATE seal SET ticks = ticks + 1");
  Ledger ledger = other.ledger();
  const Filing planted = file_session(ledger, path, {.with_findings = true});
  EXPECT_FALSE(planted.findings.empty());
  const FiledSession kept = read_registry(ledger.content()).sessions.back();
  EXPECT_EQ(SessionReader(other.places().session(kept.file_sha256)).seal()->ticks,
            SessionReader(session_).ticks() + 1)
      << "the evidence is in the file that was kept";
}

TEST(Stations, ACodeIsGoodOnceAndForNobodyElse) {
  const School school;
  Ledger ledger = school.ledger();
  const std::string us = ledger.content().public_key;
  const auto key = [&](const char* name) { return load_signing_key(school.file(name), "station"); };
  const auto why = [&](const std::string& request) {
    return code_of([&] { static_cast<void>(enrol_station(ledger, request, 0, "request")); });
  };
  const std::string code = invite_station(ledger, "Seat 2", read_clocks().utc_ns + k_hour_ns);
  const std::string request = station_request(key("a.key"), us, {}, code);
  json other = json::parse(request);
  other["request"]["public_key"] = to_hex(key("b.key").public_key);
  EXPECT_EQ(why(other.dump()), LedgerError::bad_signature);
  EXPECT_EQ(why(station_request(key("b.key"), us, {}, new_station_code())), LedgerError::unknown);
  EXPECT_EQ(why(station_request(key("a.key"), std::string(64, '0'), {}, code)),
            LedgerError::another_key);
  EXPECT_EQ(why(request), std::nullopt);
  EXPECT_EQ(why(station_request(key("b.key"), us, {}, code)), LedgerError::used);
  EXPECT_EQ(why(request), LedgerError::twice);
  const std::string old = invite_station(ledger, "Seat 3", read_clocks().utc_ns - 1);
  EXPECT_EQ(why(station_request(key("b.key"), us, {}, old)), LedgerError::ended);
  EXPECT_EQ(code_of([&] { static_cast<void>(station_request(key("b.key"), us, {}, "S-OOPS")); }),
            LedgerError::malformed);
  EXPECT_TRUE(check_ledger(school.places(), false).findings.empty());
}
TEST(Stations, AKeyThatWasRevokedReplacedOrRanOut) {
  const School school;
  Ledger ledger = school.ledger();
  const std::string us = ledger.content().public_key;
  const SigningKey first = load_station_key(station_key_path()),
                   second = load_signing_key(school.file("second.key"), "station");
  const auto now = [] { return read_clocks().utc_ns; };
  const auto problem = [&](const SigningKey& key, std::int64_t closed, std::int64_t received) {
    const auto found =
        read_registry(ledger.content()).stations.problem(to_hex(key.public_key), closed, received);
    return found ? std::optional(found->group()) : std::nullopt;
  };
  EXPECT_FALSE(problem(first, now(), now()));
  EXPECT_EQ(problem(second, now(), now()), Kind::station_unknown);
  static_cast<void>(enrol_station(ledger, station_request(second, us, {}, first),
                                  now() + 48 * k_hour_ns, "request"));
  EXPECT_FALSE(problem(second, now(), now()));
  EXPECT_FALSE(problem(first, now(), now())) << "what was sat under the old key may still come in";
  EXPECT_EQ(problem(first, now(), now() + 25 * k_hour_ns), Kind::station_revoked)
      << "it was replaced";
  EXPECT_EQ(problem(second, now() + 49 * k_hour_ns, now() + 49 * k_hour_ns), Kind::station_run_out)
      << "it ran out";
  EXPECT_EQ(problem(second, now() - k_hour_ns, now() + 73 * k_hour_ns), Kind::station_run_out)
      << "a clock that was set back";
  static_cast<void>(revoke_station(ledger, to_hex(second.public_key), "stolen"));
  EXPECT_EQ(problem(second, now() - k_hour_ns, now() + 1'000'000'000), Kind::station_revoked)
      << "whenever it says to have been sat";
  EXPECT_THROW(static_cast<void>(revoke_station(ledger, to_hex(second.public_key), "again")),
               Error);
  EXPECT_THROW(static_cast<void>(revoke_station(ledger, std::string(64, 'a'), "unknown")), Error);
  EXPECT_TRUE(check_ledger(school.places(), false).findings.empty());
}
TEST(Stations, AnEnrolledKeyThatIsGoneIsNotMadeAgain) {
  const School school;
  const SigningKey key = load_station_key(station_key_path());
  remember_enrolled(station_key_path(), key);
  EXPECT_EQ(load_station_key(station_key_path()).public_key, key.public_key);
  std::filesystem::remove(station_key_path());
  EXPECT_TRUE(tells(thrown_by([] { static_cast<void>(load_station_key(station_key_path())); }),
                    station_key_path()));
  EXPECT_FALSE(std::filesystem::exists(station_key_path()));
  static_cast<void>(load_signing_key(station_key_path(), "station"));  // somebody makes another
  EXPECT_THROW(static_cast<void>(load_station_key(station_key_path())), Error);
}

}  // namespace
}  // namespace cavum::records
