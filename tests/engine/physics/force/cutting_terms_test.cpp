#include <gtest/gtest.h>

#include <cmath>

#include "engine/base/det_math.h"
#include "engine/physics/force/term_laws.h"
#include "engine/tooth/make/make_block.h"
#include "tests/engine/support/closed_loop.h"

namespace cavum {
namespace {

using namespace testing_engine;

TermInput cutting(double voigt_n) {
  TermInput in;
  in.touching = true;
  in.penetration_mm = 0.3;
  in.stiffness_n_per_mm = 0.8;
  in.voigt_n = voigt_n;
  in.rpm = 30000;
  in.dt_s = 1e-3;
  return in;
}

TEST(CuttingTerms, WearCoolantAndAnisotropyFollowTheirFormulae) {
  TermMemory none{};
  TermInput in = cutting(0.5);
  in.removed_mm3 = 3.0;
  in.removed_on_mm3 = 7.0;
  EXPECT_NEAR(make_force_term("wear", {{"per_mm3", 0.02}}, "test")->evaluate(in, none).tissue_n,
              0.5 * 0.02 * 3.0, 1e-15);
  EXPECT_NEAR(make_force_term("wear", {{"per_mm3", 0.02}, {"carried", 1.0}}, "test")
                  ->evaluate(in, none)
                  .tissue_n,
              0.5 * 0.02 * 7.0, 1e-15);
  EXPECT_EQ(make_force_term("coolant", {{"fraction", -0.1}}, "test")->evaluate(in, none).tissue_n,
            0.0);
  in.wet = 1.0;
  EXPECT_NEAR(make_force_term("coolant", {{"fraction", -0.1}}, "test")->evaluate(in, none).tissue_n,
              -0.05, 1e-15);
  for (double phi = -90; phi < 270; phi += 17) {
    in.approach = {std::sin(2 * phi * k_pi / 180), std::cos(2 * phi * k_pi / 180)};
    const double turned = std::cos(2 * (phi - 25) * k_pi / 180);
    EXPECT_NEAR(make_force_term("anisotropy",
                                {{"epsilon", 0.2}, {"amplitude_n", 0.03}, {"phi0_deg", 25}}, "test")
                    ->evaluate(in, none)
                    .tissue_n,
                (0.2 * 0.5 + 0.03) * turned, 1e-12);
  }
  EXPECT_EQ(make_force_term("anisotropy",
                            {{"epsilon", 0.2}, {"amplitude_n", 0.03}, {"phi0_deg", 25}}, "test")
                ->evaluate(TermInput{}, none)
                .tissue_n,
            0.0);
}

TEST(CuttingTerms, ASpringThatSoftensLosesHalfAtItsForce) {
  TermMemory none{};
  const TermInput in = cutting(0.24);  // k X = 0.24 N
  EXPECT_NEAR(make_force_term("series_compliance", {{"softening_force_n", 0.24}}, "test")
                  ->evaluate(in, none)
                  .tissue_n,
              -0.12, 1e-15);
  EXPECT_NEAR(make_force_term("series_compliance", {{"softening_force_n", 2.4}}, "test")
                  ->evaluate(in, none)
                  .tissue_n,
              0.24 / 1.1 - 0.24, 1e-15);
}

TEST(CuttingTerms, AVoigtBodyOnASpringIsALagOfASofterBody) {  // F = k (X − F/ks) + c (V − F'/ks)
  const double k = 0.8, c = 0.6, ks = 2.0, v = 0.5;
  const ForceTermPtr term =
      make_force_term("series_compliance", {{"ks_n_per_mm", ks}, {"whole", 1.0}}, "test");
  for (const double dt : {0.001, 0.05}) {
    TermMemory memory{};
    double force = 0.0, small = 0.0;
    const int n = static_cast<int>(std::lround(1.0 / dt));
    for (int i = 1; i <= n; ++i) {
      TermInput in = cutting(0);
      in.dt_s = dt;
      in.penetration_mm = v * dt * i;
      in.approach_mm_s = v;
      in.damping_n_s_per_mm = c;
      force = term->evaluate(in, memory).tissue_n + k * in.penetration_mm + c * v;
    }
    const double h = 1e-6;  // the differential equation itself, in small steps
    for (int i = 1; i <= 1000000; ++i)
      small = (k * v * h * i + c * v + c / ks / h * small) / (1.0 + k / ks + c / ks / h);
    EXPECT_NEAR(force, small, 1e-5) << dt;
    EXPECT_EQ(term->evaluate(TermInput{}, memory).tissue_n, 0.0);
    EXPECT_EQ(memory, TermMemory{});
  }
}

TEST(CuttingTerms, ChatterIsASineOfTheTimeAndNotOfTheTicks) {
  const ForceTermPtr term = make_force_term(
      "chatter", {{"amplitude_n", 0.05}, {"frequency_hz", 37.5}, {"phase_turns", 0.25}}, "test");
  TermMemory none{};
  for (int i = 0; i < 2000; ++i) {
    TermInput in = cutting(0.5);
    in.time_s = 0.0137 * i;
    EXPECT_NEAR(term->evaluate(in, none).tissue_n,
                0.05 * std::sin(2 * k_pi * (37.5 * in.time_s + 0.25)), 1e-9);
  }
  EXPECT_EQ(term->evaluate(TermInput{}, none).tissue_n, 0.0);
}

TEST(CuttingTerms, RunOutByTheClockKeepsItsPhaseWhenTheSpindleStops) {
  const ForceTermPtr term = make_force_term(
      "run_out", {{"amplitude_n", 0.05}, {"phase_turns", 0.125}, {"by_clock", 1.0}}, "test");
  TermMemory memory{};
  for (int i = 0; i < 3000; ++i) {
    TermInput in = cutting(0.5);
    in.time_s = 1e-3 * i;
    in.rpm = i < 1000 || i > 1700 ? 20003.0 : 0.0;
    const double expected =
        in.rpm > 0 ? 0.05 * std::sin(2 * k_pi * (20003.0 / 60 * in.time_s + 0.125)) : 0.0;
    ASSERT_NEAR(term->evaluate(in, memory).tissue_n, expected, 1e-9);
  }
}

TEST(CuttingTerms, WarmthRisesAndFallsAsOneExponentialWhateverTheStep) {
  const ForceTermPtr term =
      make_force_term("thermal_softening",
                      {{"per_k", 0.01}, {"heating_k_per_n_s", 2.0}, {"cooling_s", 8.0}}, "test");
  for (const double dt : {0.001, 0.25}) {
    TermMemory memory{};
    TermInput in = cutting(0.5);
    in.dt_s = dt;
    for (int i = 0; i < static_cast<int>(std::lround(5.0 / dt)); ++i)
      (void)term->evaluate(in, memory);
    const double hot = 2.0 * 0.5 * 8.0 * (1 - std::exp(-5.0 / 8.0));  // g F τ (1 − e^(−t/τ))
    EXPECT_NEAR(memory[0], hot, 1e-9);
    const double force = term->evaluate(in, memory).tissue_n;
    EXPECT_NEAR(force, -0.5 * 0.01 * memory[0], 1e-12);
    TermInput air;
    air.dt_s = dt;
    memory[0] = hot;
    for (int i = 0; i < static_cast<int>(std::lround(3.0 / dt)); ++i)
      EXPECT_EQ(term->evaluate(air, memory).tissue_n, 0.0);
    EXPECT_NEAR(memory[0], hot * std::exp(-3.0 / 8.0), 1e-9);
  }
}

TEST(CuttingTerms, AMeasuredTemperatureCountsInsteadOfTheOwnLaw) {
  const ForceTermPtr term =
      make_force_term("thermal_softening",
                      {{"per_k", 0.01}, {"heating_k_per_n_s", 2.0}, {"cooling_s", 8.0}}, "test");
  TermMemory memory{};
  TermInput in = cutting(0.5);
  in.warmth_known = true;
  in.warmer_k = 12.0;
  EXPECT_NEAR(term->evaluate(in, memory).tissue_n, -0.06, 1e-15);
  EXPECT_EQ(memory, TermMemory{});
}

TEST(CuttingTerms, RelaxationOfAPowerOfTheDepthDecaysAsOne) {
  const ForceTermPtr term = make_force_term(
      "relaxation", {{"k1_n_per_mm", 0.5}, {"tau1_s", 2.0}, {"exponent", 2.0}}, "test");
  TermMemory memory{};
  TermInput in = cutting(0);
  in.penetration_mm = 0.6;
  in.dt_s = 1e-4;
  (void)term->evaluate(in, memory);  // nearly a jump: stretch X² = 0.36
  in.dt_s = 0.5;
  for (int i = 0; i < 4; ++i) (void)term->evaluate(in, memory);
  EXPECT_NEAR(memory[0], 0.36 * std::exp(-1.0), 1e-5);
}

/// Drills straight down and back in dentin, and gives the model force of each tick.
struct Drilled {
  std::vector<double> model_n, voigt_n;
  double removed_mm3 = 0;
  std::uint64_t hash = 0;
};

Drilled drill(
    const std::vector<std::pair<std::string, std::vector<std::pair<std::string, double>>>>& terms) {
  Rig rig(make_cube(4, "dentin", 0.1), {shipped_bur("round-1.0")},
          with_terms(hard_model(0.8, 0.012, 2), terms), {0, 0, 0.1});
  Drilled out;
  rig.spin_up({0, 0, 0.1});
  for (int i = 0; i < 3000; ++i) {
    const TickOutput o = rig.tick({0, 0, 0.1 - 0.0002 * i}, 1.0);
    out.model_n.push_back(o.model_force_n);
    out.voigt_n.push_back(voigt_force_n({0.8, 0.012}, o.penetration_mm, o.approach_mm_s));
    out.removed_mm3 += o.removed_count * rig.state.tooth.leaf_volume_mm3();
  }
  out.hash = state_hash(rig.state);
  return out;
}

TEST(CuttingTerms, TheServoCountsWhatTheBurRemovedAndFeelsItsWear) {
  const Drilled worn = drill({{"wear", {{"per_mm3", 5.0}}}}),
                fresh = drill({{"wear", {{"per_mm3", 0.0}}}});
  ASSERT_GT(worn.removed_mm3, 0.03);
  EXPECT_NEAR(worn.model_n.back(), worn.voigt_n.back() * (1 + 5.0 * worn.removed_mm3),
              0.02 * worn.model_n.back());
  EXPECT_NEAR(fresh.model_n.back(), fresh.voigt_n.back(), 1e-12);
}

TEST(CuttingTerms, TheServoSpraysWhileItTurnsAndTellsItsAngle) {
  const Drilled wet = drill({{"coolant", {{"fraction", 0.25}}}});
  EXPECT_NEAR(wet.model_n.back(), 1.25 * wet.voigt_n.back(), 1e-9);
  const Drilled straight = drill({{"anisotropy", {{"epsilon", 0.3}, {"phi0_deg", 0.0}}}}),
                across = drill({{"anisotropy", {{"epsilon", 0.3}, {"phi0_deg", 90.0}}}});
  EXPECT_NEAR(straight.model_n.back(), 1.3 * straight.voigt_n.back(), 0.01);  // from above: φ = 0
  EXPECT_NEAR(across.model_n.back(), 0.7 * across.voigt_n.back(), 0.01);
}

TEST(CuttingTerms, TheCountOfWearIsPartOfTheHashedState) {
  Rig rig(make_cube(4, "dentin", 0.1), {shipped_bur("round-1.0")},
          with_terms(hard_model(0.8, 0.012, 2), {{"wear", {{"per_mm3", 0.5}}}}), {0, 0, 0.1});
  const std::uint64_t before = state_hash(rig.state);
  rig.state.terms.removed_leaves[3] += 1;
  EXPECT_NE(state_hash(rig.state), before);
  Rig other(make_cube(4, "dentin", 0.1), {shipped_bur("round-1.0")},
            with_terms(hard_model(0.8, 0.012, 2), {{"coolant", {{"fraction", 0.5}}}}), {0, 0, 0.1});
  EXPECT_FALSE(other.state.terms.counts_removed);
}

}  // namespace
}  // namespace cavum
