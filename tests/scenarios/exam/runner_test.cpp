#include "scenarios/exam/runner.h"

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "tests/scenarios/test_teeth.h"

namespace cavum::scenarios {
namespace {

using testing::dentin_block;
using testing::scenario_text;

const char k_box[] =
    "[[zones.target]]\nshape = \"box\"\nat_mm = [0, 0, -0.5]\nsize_mm = [1, 1, 1]\n";

struct Exam {
  Tooth tooth = dentin_block(2, 3, 0.1);
  Scenario scenario;
  ZoneMap zones;
  Runner runner;
  RunnerState state;
  explicit Exam(Scenario s)
      : scenario(std::move(s)),
        zones(build_zones(scenario, tooth)),
        runner(scenario, zones, tooth, {"round-1.0", "needle-0.8"}) {}

  void tick(std::span<const RemovedLeaf> removed = {}, std::uint8_t bur = 0, double rpm = 0) {
    TickInput in;
    in.bur = bur;
    TickOutput out;
    out.rpm = rpm;
    runner.advance(state, in, out, removed);
  }
  template <class E>
  struct Happened {
    std::int64_t tick = 0;
    E event;
  };
  template <class E>
  [[nodiscard]] std::vector<Happened<E>> events() const {
    std::vector<Happened<E>> list;
    for (const auto& e : state.events_from(0))
      if (const E* event = e.as<E>()) list.push_back({e.tick, *event});
    return list;
  }
  [[nodiscard]] RemovedLeaf leaf(Vec3 mm, std::uint8_t tissue = k_dentin) const {
    const IVec3 l = tooth.octree.leaf_at(mm);
    return {static_cast<std::int16_t>(l.x), static_cast<std::int16_t>(l.y),
            static_cast<std::int16_t>(l.z), tissue, 0};
  }
};

Scenario scenario_with(const std::string& from = "", const std::string& to = "") {
  std::string text = scenario_text(k_box);
  if (!from.empty()) text.replace(text.find(from), from.size(), to);
  return parse_scenario(text, "s.toml");
}

TEST(Runner, TimeLimitIsExactToTheTick) {
  Exam exam(scenario_with());
  EXPECT_EQ(exam.runner.limit_ticks(), 10000);
  for (int i = 0; i < 9999; ++i) exam.tick();
  EXPECT_EQ(exam.state.finish, Finish::running);
  exam.tick();
  EXPECT_EQ(exam.state.finish, Finish::time);
  EXPECT_EQ(exam.state.ticks, 10000);
  EXPECT_EQ(exam.events<TimeUp>().at(0).tick, 9999);
}

TEST(Runner, ExtraTimeIsExactToTheTick) {
  Scenario s = scenario_with("time_limit_s = 10", "time_limit_s = 1.001");
  s.accommodations.extra_time_percent = 25;
  Exam exam(std::move(s));
  EXPECT_EQ(exam.runner.limit_ticks(), 1251);
  while (exam.state.finish == Finish::running) exam.tick();
  EXPECT_EQ(exam.state.ticks, 1251);
}

TEST(Runner, ExtraSecondsAddToThePercentAndReachStepsInProportion) {
  Scenario s = scenario_with("complete_when = \"target_removed_percent >= 99\"\n",
                             "complete_when = \"0\"\ntime_limit_s = 4\n");
  s.accommodations.extra_time_percent = 25;
  s.accommodations.extra_time_s = 2.003;
  Exam exam(std::move(s));
  EXPECT_EQ(exam.runner.limit_ticks(), 12500 + 2003);
  while (exam.events<StepTimeUp>().empty()) exam.tick();
  EXPECT_EQ(exam.state.ticks,
            5000 + 801);  // 4 s are two fifths of the exam: 2.003 s * 0.4 = 801.2 ticks more
}

/// A scenario of `limit_s` with two pauses of at most 0.25 s, on button 2.
Scenario pausing(const std::string& limit_s) {
  return scenario_with("time_limit_s = 10",
                       "time_limit_s = " + limit_s + "\n[pauses]\ncount = 2\nlongest_s = 0.25");
}

TEST(Runner, APauseStopsTheClockToTheTick) {
  Exam exam(pausing("1"));
  const auto step = [&](std::uint16_t buttons) {
    TickInput in;
    in.flags = buttons;
    exam.runner.advance(exam.state, in, {}, {});
  };
  for (int i = 0; i < 100; ++i) step(0);
  step(k_button_2);                               // tick 100 is the first of the pause
  for (int i = 0; i < 29; ++i) step(k_button_2);  // holding it changes nothing
  for (int i = 0; i < 20; ++i) step(0);
  EXPECT_TRUE(Runner::paused(exam.state));
  step(k_button_2);  // tick 150 counts again
  EXPECT_FALSE(Runner::paused(exam.state));
  EXPECT_EQ(exam.state.paused_ticks, 50);
  EXPECT_DOUBLE_EQ(exam.runner.values()[0], 0.101);  // time_s
  while (exam.state.finish == Finish::running) step(0);
  EXPECT_EQ(exam.state.finish, Finish::time);
  EXPECT_EQ(exam.state.ticks, 1050);
  EXPECT_EQ(exam.events<PauseStarted>().at(0).tick, 100);
  EXPECT_EQ(exam.events<PauseEnded>().at(0).tick, 150);
}

TEST(Runner, TheOfficesPauseStopsTheClockToTheTickAndTakesNoneOfTheCandidates) {
  Exam exam(pausing("1"));
  const auto step = [&](std::uint16_t flags, std::uint16_t pedal = 0) {
    TickInput in;
    in.flags = flags;
    in.pedal_q16 = pedal;
    exam.runner.advance(exam.state, in, {}, {});
  };
  for (int i = 0; i < 100; ++i) step(0);
  step(k_button_2);  // the candidate's own pause, which the office's ends
  for (int i = 0; i < 9; ++i) step(0);
  for (int i = 0; i < 400; ++i) step(k_hold);  // longer than any pause of the candidate's
  EXPECT_TRUE(Runner::held(exam.state));
  EXPECT_FALSE(Runner::paused(exam.state));
  step(0);
  EXPECT_FALSE(Runner::held(exam.state));
  EXPECT_EQ(exam.state.paused_ticks, 410);
  for (int i = 0; i < 50; ++i) step(k_hold, 1);  // no clock stands still while the pedal is pressed
  EXPECT_EQ(exam.state.paused_ticks, 410);
  while (exam.state.finish == Finish::running) step(0);
  EXPECT_EQ(exam.state.ticks, 1410);
  EXPECT_EQ(exam.state.pauses, 1) << "one is left";
  EXPECT_EQ(exam.events<PauseEnded>().at(0).tick, 110);
  ASSERT_EQ(exam.events<HoldStarted>().size(), 1u);
  EXPECT_EQ(exam.events<HoldStarted>().at(0).tick, 110);
  EXPECT_EQ(exam.events<HoldEnded>().at(0).tick, 510);
}

/// Whoever presses the button three hundred times does not push the end out of the list.
TEST(Runner, TheEndHasItsPlaceInAFullListOfEvents) {
  Exam exam(pausing("10"));
  for (int i = 0; i < 1000; ++i) {
    TickInput in;
    in.flags = i % 2 == 1 ? k_button_2 : 0;
    TickOutput turning;
    turning.rpm = 5000;
    exam.runner.advance(exam.state, in, turning, {});
  }
  EXPECT_EQ(exam.state.event_count, RunnerState::k_max_events - 1);
  EXPECT_GT(exam.state.events_dropped, 0u);
  const std::uint32_t recorded = exam.state.event_count;  // a recorder takes each once
  exam.runner.end(exam.state);
  ASSERT_EQ(exam.state.event_count, recorded + 1);
  EXPECT_TRUE(std::holds_alternative<Finished>(exam.state.events[recorded].event));
}

TEST(Runner, APauseEndsByItselfAndTheThirdIsRefused) {
  Exam exam(pausing("1"));
  const auto step = [&](std::uint16_t buttons, double rpm = 0) {
    TickInput in;
    in.flags = buttons;
    TickOutput out;
    out.rpm = rpm;
    exam.runner.advance(exam.state, in, out, {});
  };
  step(k_button_2, 5000);  // the handpiece turns
  EXPECT_EQ(exam.events<PauseRefused>().size(), 1u);
  for (int pause = 0; pause < 3; ++pause) {
    step(0);
    step(k_button_2);
    for (int i = 0; i < 300; ++i) step(0);
  }
  EXPECT_EQ(exam.events<PauseStarted>().size(), 2u);
  EXPECT_EQ(exam.events<PauseRefused>().size(), 2u);
  EXPECT_EQ(exam.events<PauseEnded>().at(0).tick - exam.events<PauseStarted>().at(0).tick, 250);
  while (exam.state.finish == Finish::running) step(0);
  EXPECT_EQ(exam.state.ticks, 1500);
}

TEST(Runner, WithoutPausesTheButtonMeansNothing) {
  Exam exam(scenario_with());
  TickInput in;
  in.flags = k_button_2;
  exam.runner.advance(exam.state, in, {}, {});
  EXPECT_FALSE(Runner::paused(exam.state));
  EXPECT_TRUE(exam.events<PauseRefused>().empty());
}

TEST(Runner, WorkAfterTheEndDoesNotCount) {
  Exam exam(scenario_with("time_limit_s = 10", "time_limit_s = 0.005"));
  for (int i = 0; i < 5; ++i) exam.tick();
  const RemovedLeaf one[] = {exam.leaf({0, 0, -0.1})};
  exam.tick(one);
  EXPECT_EQ(exam.state.ticks, 5);
  EXPECT_EQ(exam.state.removed_in_zone[static_cast<std::size_t>(Zone::target)], 0u);
}

TEST(Runner, StepsCompleteInTheTickTheirConditionComesTrue) {
  Exam exam(scenario_with("target_removed_percent >= 99",
                          "target_removed_percent >= 0.2 && touched_dentin > 0.0015"));
  const RemovedLeaf one[] = {exam.leaf({0.01, 0, -0.1})}, two[] = {exam.leaf({0.01, 0.11, -0.1})};
  exam.tick(one);
  EXPECT_EQ(exam.state.finish, Finish::running);
  exam.tick();
  exam.tick(two);  // 2 of 1000 leaves of 0.001 mm3
  EXPECT_EQ(exam.events<StepCompleted>().at(0).tick, 2);
}

/// A look with the pedal off completes the step; then the work goes on.
TEST(Runner, OnlyTheCandidateOrTheClockEndsAnExam) {
  const Scenario s = scenario_with("target_removed_percent >= 99",
                                   "target_removed_percent > 0 && contact == 0 && pedal == 0");
  const auto look_and_go_on = [](Exam& exam) {
    const RemovedLeaf one[] = {exam.leaf({0.01, 0, -0.1})},
                      more[] = {exam.leaf({0.01, 0.11, -0.1})};
    exam.tick(one);
    exam.tick(more);
    return exam.state.removed_in_zone[static_cast<std::size_t>(Zone::target)];
  };
  Exam exam(s), by_the_clock(s);
  EXPECT_EQ(look_and_go_on(exam), 2u);
  EXPECT_EQ(exam.state.finish, Finish::running);
  EXPECT_EQ(exam.events<StepCompleted>().at(0).tick, 0);
  EXPECT_NE(exam.runner.instruction(exam.state), s.steps.back().instruction) << "that all are done";
  exam.runner.end(exam.state);
  EXPECT_EQ(exam.state.finish, Finish::completed);
  EXPECT_EQ(exam.events<Finished>().at(0).tick, 2);

  look_and_go_on(by_the_clock);
  while (by_the_clock.state.finish == Finish::running) by_the_clock.tick();
  EXPECT_EQ(by_the_clock.state.ticks, by_the_clock.runner.limit_ticks());
  EXPECT_EQ(by_the_clock.state.finish, Finish::completed);
  EXPECT_EQ(by_the_clock.events<TimeUp>().size(), 1u);
}

TEST(Runner, WhatIsProtectedCountsAsOutsideWhileTheExamRuns) {
  const std::string guard =
      "[[zones.protected]]\nshape = \"box\"\nat_mm = [0.9, 0, -0.5]\nsize_mm = [0.4, 1, 1]\n";  // 0.2 mm beside the target
  const auto completes = [&](const char* condition) {
    std::string text = scenario_text(k_box + guard);
    const std::string from = "target_removed_percent >= 99";
    text.replace(text.find(from), from.size(), condition);
    Exam exam(parse_scenario(text, "s.toml"));
    const RemovedLeaf guarded[] = {exam.leaf({0.75, 0, -0.5})};  // the leeway would reach there
    exam.tick(guarded);
    return exam.state.step == 1;
  };
  EXPECT_TRUE(completes("outside_mm3 > 0.0005"));
  EXPECT_TRUE(completes("protected_mm3 > 0.0005"));
  EXPECT_FALSE(completes("leeway_mm3 + container_mm3 > 0"));
}

TEST(Runner, HowTheLastStepEndedIsHowTheExamEnded) {
  const auto ended = [](const char* step) {
    Exam exam(scenario_with("complete_when = \"target_removed_percent >= 99\"\n", step));
    for (int i = 0; i < 60; ++i) exam.tick();
    exam.runner.end(exam.state);
    return exam.state.finish;
  };
  EXPECT_EQ(ended("complete_when = \"target_removed_percent >= 99\"\ntime_limit_s = 0.05\n"),
            Finish::time);
  EXPECT_EQ(
      ended("complete_when = \"target_removed_percent >= 99\"\nfail_when = \"time_s > 0.04\"\n"),
      Finish::failed);
  EXPECT_EQ(ended("complete_when = \"time_s > 0.04\"\n"), Finish::completed);
}

TEST(Runner, StepLimitsAndFailuresLeadOnOrEndTheExam) {
  const std::string next =
      "complete_when = \"target_removed_percent >= 99\"\ntime_limit_s = 0.1\n[[steps]]\nid = \"second\"\ninstruction = \"More.\"\n"
      "complete_when = \"step_time_s > 1000\"\nfail_when = \"outside_mm3 > 0\"\nfailure_ends_exam = true\n";
  Exam exam(scenario_with("complete_when = \"target_removed_percent >= 99\"\n", next));
  for (int i = 0; i < 100; ++i) exam.tick();
  EXPECT_EQ(exam.events<StepTimeUp>().at(0).tick, 99);
  EXPECT_EQ(exam.state.step, 1);
  EXPECT_EQ(exam.runner.instruction(exam.state), "More.");
  const RemovedLeaf far[] = {exam.leaf({1.9, 1.9, -2.5})};
  exam.tick(far);
  EXPECT_EQ(exam.state.finish, Finish::failed);
  EXPECT_EQ(exam.events<StepFailed>().at(0).tick, 100);
  EXPECT_EQ(exam.runner.instruction(exam.state), "");
}

TEST(Runner, NotesForbiddenBursAndSpeedsOnceEach) {
  Exam exam(scenario_with());
  exam.tick({}, 0, 1000);
  exam.tick({}, 1, 250000);
  exam.tick({}, 1, 250000);
  exam.tick({}, 0, 1000);
  exam.tick({}, 1, 250000);
  EXPECT_EQ(exam.events<BurNotAllowed>().size(), 2u);
  EXPECT_EQ(exam.events<OverSpeed>().size(), 2u);
  EXPECT_EQ(exam.events<BurNotAllowed>().at(0).event.bur, 1);
}

TEST(Runner, TellsAimsFromFaultsAndWhereTheyWereFirstTouched) {
  Scenario s = scenario_with();
  s.perforation = {{"pulp"}, {"periodontium"}};
  Exam exam(std::move(s));
  const RemovedLeaf pulp[] = {exam.leaf({0, 0, -1.5}, k_pulp)},
                    ligament[] = {exam.leaf({0.5, 0, -2.5}, k_periodontium)};
  exam.tick();
  exam.tick(pulp);
  exam.tick(pulp);
  EXPECT_FALSE(exam.state.perforated);
  exam.tick(ligament);
  EXPECT_TRUE(exam.state.perforated);
  ASSERT_EQ(exam.events<AimReached>().size(), 1u);
  EXPECT_EQ(exam.events<AimReached>()[0].tick, 1);
  EXPECT_EQ(exam.events<Perforated>().at(0).tick, 3);
  EXPECT_EQ(exam.tooth.octree.leaf_at(exam.events<Perforated>().at(0).event.site_mm),
            exam.tooth.octree.leaf_at({0.5, 0, -2.5}));
}

TEST(Runner, KeepsTheEndEvenWhenTheListOfEventsIsFull) {
  Exam exam(scenario_with("time_limit_s = 10", "time_limit_s = 1"));
  for (int i = 0; i < 1000; ++i) exam.tick({}, static_cast<std::uint8_t>(i & 1));
  EXPECT_EQ(exam.state.finish, Finish::time);
  EXPECT_GT(exam.state.events_dropped, 0u);
  EXPECT_TRUE(
      std::holds_alternative<Finished>(exam.state.events[exam.state.event_count - 1].event));
}

}  // namespace
}  // namespace cavum::scenarios
