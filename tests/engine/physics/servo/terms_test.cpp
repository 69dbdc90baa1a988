// The force terms inside the servo: state, hash, determinism, and that their absence changes
// nothing.
#include <gtest/gtest.h>

#include "engine/tooth/make/make_block.h"
#include "tests/engine/support/closed_loop.h"

namespace cavum {
namespace {

using namespace testing_engine;

ForceModel all_terms() {
  return with_terms(hard_model(0.8, 1.79, 0.3),
                    {{"coulomb_friction", {{"fc_n", 0.2}, {"v0_mm_s", 0.5}}},
                     {"series_compliance", {{"ks_n_per_mm", 3.0}}},
                     {"run_out", {{"eccentricity_um", 20.0}, {"amplitude_n", 0.01}}}});
}

Rig rig_with(const ForceModel& force) {
  return {make_block({2.4, 2.4, 3.0},
                     {{"enamel", 0.7}, {"dentin", 0.5}, {"pulp", 0.8}, {"dentin", 1.0}}, 0.05),
          {shipped_bur("round-1.0")},
          force,
          {0, 0, 0.3}};
}

Vec3 drilling(int i) {
  const double t = i * 1e-3;
  return {0.5 * std::sin(2.1 * t), 0.4 * std::sin(1.3 * t),
          0.2 - 0.3 * t + 0.4 * std::max(0.0, std::sin(1.7 * t))};
}

TEST(ServoTerms, EqualInputsGiveEqualStatesAndACopyGoesOnAlike) {
  Rig a = rig_with(all_terms()), b = rig_with(all_terms());
  ServoState copy;
  for (int i = 0; i < 4000; ++i) {
    if (i == 1700) copy = a.state;
    (void)a.tick(drilling(i), 1.0);
    (void)b.tick(drilling(i), 1.0);
    if (i >= 1700) (void)step(a.model, copy, a.input);
    ASSERT_EQ(state_hash(a.state), state_hash(b.state)) << i;
    if (i >= 1700) {
      ASSERT_EQ(state_hash(a.state), state_hash(copy)) << i;
    }
  }
  EXPECT_LT(a.state.tooth.count_leaves()[k_enamel],
            rig_with(all_terms()).state.tooth.count_leaves()[k_enamel])
      << "it must have drilled";
}

TEST(ServoTerms, EveryPartOfTheirStateIsHashed) {
  Rig rig = rig_with(all_terms());
  for (int i = 0; i < 500; ++i) (void)rig.tick(drilling(i), 1.0);
  const auto differs = [&](auto change) {
    ServoState other = rig.state;
    change(other.terms);
    return state_hash(other) != state_hash(rig.state);
  };
  EXPECT_FALSE(differs([](TermsState&) {}));
  EXPECT_TRUE(differs([](TermsState& s) { s.velocity_mm_s.y += 1e-9; }));
  EXPECT_TRUE(differs([](TermsState& s) { s.stretch_n.z += 1e-9; }));
  EXPECT_TRUE(differs([](TermsState& s) { s.memory[2][0] += 1e-9; })) << "the phase of the run-out";
  EXPECT_NE(rig.state.terms.memory[2][0], 0.0);
}

TEST(ServoTerms, AnEmptyListIsTheSameAsNone) {
  Rig none = rig_with(hard_model(0.8, 1.79, 0.3)),
      zero =
          rig_with(with_terms(hard_model(0.8, 1.79, 0.3), {{"run_out", {{"amplitude_n", 0.0}}}}));
  EXPECT_EQ(none.state.terms.count, 0u);
  for (int i = 0; i < 3000; ++i) {
    const TickOutput a = none.tick(drilling(i), 1.0), b = zero.tick(drilling(i), 1.0);
    ASSERT_EQ(make_tick_record(a), make_tick_record(b)) << i;
    ASSERT_EQ(a.drag_n, Vec3{});
  }
  EXPECT_EQ(none.state.terms.stretch_n, Vec3{});
}

TEST(ServoTerms, ATermThatGivesNonsenseCountsAsNothingAndIsNoticed) {
  class Broken final : public ForceTerm {
   public:
    [[nodiscard]] TermForce evaluate(const TermInput& in,
                                     TermMemory& memory) const noexcept override {
      memory[0] += 1;
      return memory[0] > 100 && memory[0] < 103 ? TermForce{NAN, INFINITY}
                                                : TermForce{0.0, in.speed_mm_s > 0 ? 0.1 : 0.0};
    }
  };
  ForceModel force = hard_model(0.8, 0.012);
  force.terms.push_back(std::make_shared<Broken>());
  Rig rig = rig_with(force);
  int noticed = 0;
  for (int i = 0; i < 1000; ++i) {
    const TickOutput out = rig.tick(drilling(i), 0);
    ASSERT_TRUE(is_finite(out.rendered_force_n) && std::isfinite(out.model_force_n) &&
                is_finite(out.drag_n));
    noticed += (out.notices & k_notice_not_finite) != 0;
  }
  EXPECT_GE(noticed, 1);
}

}  // namespace
}  // namespace cavum
