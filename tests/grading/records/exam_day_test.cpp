// What happens on an exam day, as entries: they say what they should, contradict nothing, and a
// recording's standing clock must be explained by them.
#include "grading/records/exam_day.h"

#include "grading/records/erasure.h"
#include "tests/grading/records/school.h"
#include "tests/grading/records/short_exam.h"

namespace cavum::records {
namespace {

using namespace testing_ledger;

constexpr std::int64_t k_second = 1'000'000'000;

TEST(ExamDay, AHoldLastsForItsAudienceUntilItsEndAndEndsOnce) {
  const School school;
  Ledger ledger = school.ledger();
  const std::string seat = to_hex(load_station_key(station_key_path()).public_key);
  const auto hold = hold_exams(ledger, "fire alarm", {}).seq;
  EXPECT_EQ(ledger.registry().day.hold_of(seat)->seq, hold);
  EXPECT_EQ(ledger.registry().day.hold_of("any other")->seq, hold)
      << "for all means also those to come";
  const auto end = let_go_on(ledger, hold, "all clear").seq;
  EXPECT_EQ(ledger.registry().day.hold_of(seat), nullptr);
  EXPECT_EQ(ledger.registry().day.holds.at(0).ended_by, end);
  EXPECT_THROW(let_go_on(ledger, hold, "again"), Error);
  EXPECT_THROW(let_go_on(ledger, end, "no hold"), Error);
  const auto one = hold_exams(ledger, "power cut", {"Room 2", {seat}}).seq;
  EXPECT_EQ(ledger.registry().day.hold_of(seat)->seq, one);
  EXPECT_EQ(ledger.registry().day.hold_of("any other"), nullptr);
  const LedgerContent content = read_ledger(school.places());
  EXPECT_TRUE(content.findings.empty());
  EXPECT_TRUE(read_registry(content).findings.empty());
  EXPECT_TRUE(check_ledger(school.places(), {}).findings.empty());
}

TEST(ExamDay, WhatIsNoLineNoStationOrNobodysCandidateIsRefusedAndEntersNothing) {
  const School school;
  Ledger ledger = school.ledger();
  const auto entries = ledger.content().entries.size();
  EXPECT_THROW(announce(ledger, "", {}), Error);
  EXPECT_THROW(announce(ledger, "two\nlines", {}), Error);
  EXPECT_THROW(announce(ledger, std::string(k_longest_words + 1, 'x'), {}), Error);
  EXPECT_THROW(announce(ledger, "words", {"", {std::string(64, 'a')}}), Error) << "no such station";
  EXPECT_THROW(announce(ledger, "words", {"Room 9", {}}), Error)
      << "a room without stations is not everybody";
  EXPECT_THROW(hold_exams(ledger, "", {}), Error);
  EXPECT_THROW(note_incident(ledger, "", "C-ABCD-EFGH", "fell ill"), Error) << "no such candidate";
  EXPECT_THROW(note_incident(ledger, "", "4711", "fell ill"), Error) << "a number is no pseudonym";
  EXPECT_THROW(note_incident(ledger, std::string(64, 'a'), "", "stylus broke"), Error);
  EXPECT_THROW(place_station(ledger, std::string(64, 'a'), "Room 1"), Error);
  EXPECT_THROW(seat_candidates(ledger, {}), Error);
  EXPECT_THROW(seat_candidates(ledger, {{1, ""}}), Error) << "no ticket";
  EXPECT_EQ(ledger.content().entries.size(), entries);
}

TEST(ExamDay, WhatWasSaidOfACandidateGoesWhenHeIsForgotten) {
  const School school;
  const std::string candidate = parse_ticket(school.ticket("4711"), "", "ticket").candidate,
                    words = "left the room unwell";
  Ledger ledger = school.ledger();
  const auto about = note_incident(ledger, "", candidate, words).seq,
             other = note_incident(ledger, "", "", "a lamp failed").seq;
  EXPECT_EQ(ledger.registry().day.incidents.at(0).words, words);
  EXPECT_EQ(ledger.content().entries.at(about).text.find(words), std::string::npos)
      << "an entry's own text cannot be erased";
  forget(ledger, {candidate}, {});
  EXPECT_EQ(ledger.registry().day.incidents.at(0).words, "");
  EXPECT_TRUE(ledger.registry().day.incidents.at(0).erased_by);
  EXPECT_EQ(ledger.registry().day.incidents.at(1).words, "a lamp failed");
  EXPECT_EQ(ledger.registry().day.incidents.at(1).seq, other);
  EXPECT_EQ(read_text_file(school.places().database()).find(words), std::string::npos)
      << "not in the file either";
  const LedgerContent content = read_ledger(school.places());
  EXPECT_TRUE(content.findings.empty());
  EXPECT_TRUE(read_registry(content).findings.empty());
}

TEST(ExamDay, RoomsAndSeatsAreTheLastOnesThatWereGiven) {
  const School school;
  const std::string seat = to_hex(load_station_key(station_key_path()).public_key);
  static_cast<void>(school.ticket("4711"));
  Ledger ledger = school.ledger();
  const auto ticket = ledger.registry().tickets.at(0).seq;
  place_station(ledger, seat, "Room 1");
  place_station(ledger, seat, "Room 2");
  EXPECT_EQ(ledger.registry().stations.of(seat)->room, "Room 2");
  seat_candidates(ledger, {{ticket, seat}});
  EXPECT_EQ(ledger.registry().tickets.at(0).seat, seat);
  seat_candidates(ledger, {{ticket, ""}});
  EXPECT_EQ(ledger.registry().tickets.at(0).seat, "");
  cancel_ticket(ledger, ticket, "ill");
  EXPECT_THROW(seat_candidates(ledger, {{ticket, seat}}), Error);
  EXPECT_TRUE(read_registry(read_ledger(school.places())).findings.empty());
}

TEST(ExamDay, AStandingClockIsExplainedByAPauseOfThatStationAndTime) {
  ExamDay day;
  day.holds.push_back({5, 1000 * k_second, "fire alarm", {"", {"seat"}}, 6, 1600 * k_second});
  const auto findings = [&](const std::string& station, std::int64_t from_s, std::int64_t to_s) {
    const HeldTime held[] = {{from_s * k_second, to_s * k_second}};
    return unexplained_holds(day, station, held, 5000 * k_second).size();
  };
  EXPECT_EQ(findings("seat", 1001, 1602), 0u);
  EXPECT_EQ(findings("seat", 1100, 1200), 0u) << "an invigilator let it go on earlier";
  EXPECT_EQ(findings("seat", 801, 1400), 0u) << "its clock is three minutes behind";
  EXPECT_EQ(findings("another", 1001, 1602), 1u);
  EXPECT_EQ(findings("seat", 1001, 1700), 1u) << "longer than the pause was";
  EXPECT_EQ(findings("seat", 3000, 3100), 1u) << "at another time";
  EXPECT_TRUE(unexplained_holds(day, "another", {}, 0).empty())
      << "no recording before this had any";
}

TEST(ExamDay, ARecordingWhoseClockStoodStillByItselfIsNotFiledAsSound) {
  const School school;
  const auto held = [](std::int64_t tick, TickInput& input) {
    if (tick >= 50 && tick < 100) input.flags |= k_hold, input.pedal_q16 = 0;
  };
  Ledger ledger = school.ledger();
  const std::string first = school.file("first.cavum"), second = school.file("second.cavum");
  sit_shortly(k_scenario, first, school.ticket("1"), {}, held);
  grading::ExamContexts grounds;
  const Filing refused = file_session(ledger, first, {}, grounds);
  EXPECT_FALSE(refused.seq);
  expect_kinds(refused.findings, {Kind::pause_unknown});
  const auto hold = hold_exams(ledger, "fire alarm", {}).seq;
  sit_shortly(k_scenario, second, school.ticket("2"), {}, held);
  let_go_on(ledger, hold, "all clear");
  const Filing filed = file_session(ledger, second, {}, grounds);
  EXPECT_TRUE(filed.findings.empty()) << filed.findings.front().message();
  ASSERT_TRUE(filed.seq);
  const nlohmann::json& result =
      *ledger.content().entries.at(*filed.seq).as<SessionEntry>()->result.value;
  EXPECT_EQ(result.at("pauses").at("ticks"), 50);
  EXPECT_EQ(result.at("pauses").at("list").at(0),
            (nlohmann::json{{"from_tick", 50}, {"to_tick", 100}, {"by_office", true}}));
}

}  // namespace
}  // namespace cavum::records
