#include <gtest/gtest.h>

#include "engine/base/det_math.h"
#include "engine/physics/force/term_laws.h"
#include "engine/tooth/make/make_block.h"
#include "tests/engine/support/closed_loop.h"

namespace cavum {
namespace {

using namespace testing_engine;

/// Amplitude of the line at `frequency_hz` in samples of `tick_s`, over whole periods.
double line_n(const std::vector<double>& f, double frequency_hz, double tick_s) {
  double s = 0, c = 0, mean = 0;
  for (const double v : f) mean += v / static_cast<double>(f.size());
  for (std::size_t i = 0; i < f.size(); ++i) {
    const double angle = 2 * k_pi * frequency_hz * static_cast<double>(i) * tick_s;
    s += (f[i] - mean) * std::sin(angle);
    c += (f[i] - mean) * std::cos(angle);
  }
  return 2 * std::sqrt(s * s + c * c) / static_cast<double>(f.size());
}

TermInput at_speed(double rpm, double dt_s = 0.001) {
  return {true, 0.3, 0, 0, 0.8, 0, 0.24, rpm, 0, dt_s};
}

TEST(RunOut, IsASineOfTheTurnsMade) {
  for (const double dt : {0.001, 0.00025, 0.0137})
    for (const double rpm : {0.1, 1000.0, 40000.0, 199999.0, 200000.0}) {
      const ForceTermPtr term = make_force_term(
          "run_out", {{"amplitude_n", 0.01}, {"eccentricity_um", 20}, {"phase_turns", 0.125}},
          "test");
      TermMemory memory{};
      for (int i = 1; i <= 4000; ++i) {
        const double turns = rpm / 60 * dt * i + 0.125, amplitude = 0.01 + 0.020 * 0.8;
        ASSERT_NEAR(term->evaluate(at_speed(rpm, dt), memory).tissue_n,
                    amplitude * std::sin(2 * k_pi * turns), 1e-7 * amplitude * (1 + turns));
        ASSERT_GE(memory[0], 0.0);
        ASSERT_LT(memory[0], 1.0);
      }
    }
}

TEST(RunOut, FollowsASpindleThatRunsUp) {  // turns = ∫ rpm/60 dt
  const ForceTermPtr term = make_force_term("run_out", {{"amplitude_n", 0.05}}, "test");
  TermMemory memory{};
  double turns = 0;
  for (int i = 0; i < 3000; ++i) {
    const double rpm = 50.0 * i;
    turns += rpm / 60 * 0.001;
    ASSERT_NEAR(term->evaluate(at_speed(rpm), memory).tissue_n,
                rpm > 0 ? 0.05 * std::sin(2 * k_pi * turns) : 0.0, 1e-9);
  }
}

TEST(RunOut, IsALineAtTheAliasOfTheSpindleRate) {
  const double tick_s = 0.001;
  for (const double rpm : {12000.0, 33000.0, 200000.0, 61200.0}) {
    const ForceTerms terms{make_force_term("run_out", {{"eccentricity_um", 20.0}}, "test")};
    TermMemory memory{};
    std::vector<double> f;
    for (int i = 0; i < 3000; ++i)
      f.push_back(force_along_feed_n(terms, at_speed(rpm), {&memory, 1}));
    double alias = std::fmod(rpm / 60, 1 / tick_s);
    alias = std::min(alias, 1 / tick_s - alias);
    EXPECT_NEAR(line_n(f, alias, tick_s), 0.020 * 0.8, 1e-6)
        << rpm << " rpm, seen at " << alias << " Hz";
    EXPECT_LT(line_n(f, alias + 7, tick_s), 1e-3 * 0.016);
  }
}

TEST(RunOut, NeitherInAirNorAtRest) {
  const ForceTerms terms{make_force_term("run_out", {{"amplitude_n", 0.05}}, "test")};
  TermMemory memory{};
  TermInput in = at_speed(0);
  EXPECT_DOUBLE_EQ(force_along_feed_n(terms, in, {&memory, 1}), 0.24);
  in = at_speed(30000);
  in.touching = false;
  for (int i = 0; i < 100; ++i) EXPECT_EQ(force_along_feed_n(terms, in, {&memory, 1}), 0.0);
}

TEST(RunOut, TheServoFeelsItWhileItDrills) {
  const ForceModel force =
      with_terms(hard_model(0.8, 0.012, 50), {{"run_out", {{"amplitude_n", 0.03}}}});
  for (const auto& base : {force, hard_model(0.8, 0.012, 50)}) {
    Rig rig(make_cube(4, "dentin", 0.1), {shipped_bur("round-1.0")}, base, {0, 0, 0.1});
    rig.spin_up({0, 0, 0.1});
    (void)rig.travel({0, 0, 0.1}, {0, 0, -0.4}, 1.0, 1.0);
    std::vector<double> model, rendered;
    for (int i = 0; i < 3000; ++i) {
      const TickOutput out = rig.tick({0, 0, -0.4}, 1.0);
      model.push_back(out.model_force_n);
      rendered.push_back(out.rendered_force_n.z);
    }
    const double expected = base.terms.empty() ? 0.0 : 0.03;
    EXPECT_NEAR(line_n(model, 1000.0 / 3, 0.001), expected, 0.001);
    EXPECT_NEAR(line_n(rendered, 1000.0 / 3, 0.001), expected, 0.001);
  }
}

}  // namespace
}  // namespace cavum
