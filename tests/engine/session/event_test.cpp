// Every kind of event is read as it was written, the page of the format names it, and what a
// damaged one lacks is named.
#include "engine/session/event.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "engine/base/file.h"
#include "engine/base/file_error.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

template <std::size_t... i>
std::vector<Event> one_of_each(std::index_sequence<i...>) {
  return {Event(std::in_place_index<i>)...};
}
const std::vector<Event> k_one_of_each =
    one_of_each(std::make_index_sequence<std::variant_size_v<Event>>());

RealTimeReport punctuality() {
  RealTimeReport r;
  for (const std::int64_t late_ns : {200, 3000, 2'000'000'000}) r.lateness.add(late_ns);
  r.ticks = 3;
  r.ended = {ServoEnd::device_failed, ServoFault::sending};
  return r;
}

TEST(SessionEvents, EveryKindIsReadAsItWasWritten) {
  std::vector<Event> events = k_one_of_each;
  events.insert(
      events.end(),
      {StepFailed{7}, BurNotAllowed{3}, AimReached{{3, {-0.1, 1e-9, 12}}}, Finished{Finish::time},
       PauseRefused{2},
       RecordingGap{-5,
                    INT64_MAX,
                    0.1,
                    "boot",
                    "ab",
                    {MotionSource{SourceKind::device, "falcon", "F1"}, false, {{"a", "b"}}}},
       RecordingMoved{"e.cavum", 6000, {DiskFault::full, 28}}, ServoGap{4, 2, 9}, Overruns{3, 2.5},
       StylusSilent{true}, ServoStopped{{ServoEnd::device_failed, ServoFault::threads, 11}},
       ServoLateness{punctuality(), 8}, WorkAfterEnd{2500, 1200},
       LockAttempt{LockTry::keyboard_added, true, 1, "usb"},
       Announced{{UINT64_MAX, "Lunch \"at\" one"}}, MeasuredForce{5, {0.25, -3}}});
  for (const Event& e : events) {
    const EventText text = encode(e);
    EXPECT_EQ((TimedEvent{5, decode(text, "test")}), (TimedEvent{5, e}))
        << text.kind << " " << text.detail_json;
  }
}

TEST(SessionEvents, NoTwoKindsHaveOneName) {
  std::set<std::string> names;
  for (const Event& e : k_one_of_each) names.insert(kind_of(e));
  EXPECT_EQ(names.size(), k_one_of_each.size());
}

TEST(SessionEvents, ThePageOfTheFormatHasEachKindWithItsMembers) {
  const std::string page =
      read_text_file(std::string(CAVUM_SOURCE_DIR) + "/docs/formats/session.md");
  for (const Event& e : k_one_of_each) {
    const EventText text = encode(e);
    EXPECT_NE(page.find("`" + text.kind + "`"), std::string::npos) << text.kind;
    const auto detail = nlohmann::json::parse(text.detail_json);
    for (const auto& [member, value] : detail.items())
      EXPECT_TRUE(page.find("\"" + member + "\"") != std::string::npos ||
                  page.find("`" + member + "`") != std::string::npos)
          << text.kind << " " << member;
  }
}

TEST(SessionEvents, TextsAreKeptOnOneLine) {
  EXPECT_EQ((TimedEvent{0, decode(encode(Announced{{1, "a\nb\xff"}}), "test")}),
            (TimedEvent{0, Announced{{1, "a b?"}}}));
}

TEST(SessionEvents, WhatIsWrongInADamagedOneIsNamed) {
  const auto wrong = [](const std::string& kind, const std::string& detail) {
    return testing_basics::thrown_by([&] { static_cast<void>(decode({kind, detail}, "row 3")); });
  };
  using testing_basics::tells;
  EXPECT_EQ(testing_basics::code_of(wrong("examiner_excused", "{}")), FileError::unknown);
  EXPECT_TRUE(tells(wrong("step_started", "{}"), "step"));
  for (const char* step :
       {"-1", "2147483648", "18446744073709551616", "1.5", "\"0\"", "null", "[0]"})
    EXPECT_TRUE(tells(wrong("step_started", std::string("{\"step\":") + step + "}"), "step"))
        << step;
  EXPECT_TRUE(tells(wrong("finished", R"({"how":"won"})"), "how"));
  EXPECT_TRUE(tells(wrong("perforation", R"({"site_mm":[0.0,1.0],"tissue":1})"), "site_mm"));
  EXPECT_TRUE(tells(wrong("perforation", R"({"site_mm":[0.0,1.0,2.0],"tissue":256})"), "tissue"));
  EventText gap = encode(RecordingGap{});
  gap.detail_json.replace(gap.detail_json.find("\"ticket_remembered\":true"), 24,
                          "\"ticket_remembered\":0");
  EXPECT_TRUE(tells(wrong(gap.kind, gap.detail_json), "by.ticket_remembered"));
  EventText lateness = encode(ServoLateness{});
  lateness.detail_json.replace(lateness.detail_json.find("[0,"), 3, "[1e300,");
  EXPECT_TRUE(tells(wrong(lateness.kind, lateness.detail_json), "servo.lateness.counts[0]"));
  for (const char* detail : {R"({"step": 0})", R"({"more":1,"step":0})", R"({"step":1,"step":0})",
                             R"({"step":0} )", "", "null", "{\"step\":0"})
    EXPECT_TRUE(wrong("step_started", detail)) << detail;
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "{\"step\":";
  EXPECT_TRUE(wrong("step_started", deep));
}

}  // namespace
}  // namespace cavum
