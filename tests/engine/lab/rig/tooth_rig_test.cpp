#include "engine/lab/rig/tooth_rig.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/lab/rig/rig_error.h"
#include "engine/tooth/make/make_block.h"
#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

Tooth layered() {
  return make_block({5, 5, 3.5}, {{"enamel", 0.5}, {"dentin", 0.6}, {"pulp", 1.4}, {"dentin", 1.0}},
                    0.05);
}

ToothRigOptions small_rig() {
  ToothRigOptions o;
  o.runs = 3;
  return o;
}

TEST(ToothRig, ForceFallsToTheFrictionWhenTheTipReachesThePulp) {
  const double k = 0.8, c = 0.2, tau = 0.4, v = 0.25;
  const ToothRigResult r =
      run_tooth_rig(layered(), hard_model(k, c, tau), shipped_bur("round-1.0"), small_rig());
  ASSERT_EQ(r.counted, 3);
  // the tip's proxy is X behind the crosshead
  EXPECT_NEAR(r.pulp_s.mean, (1.1 + v * tau) / v, 0.3);
  EXPECT_NEAR(r.before_n.mean, k * v * tau + c * v + 0.26, 0.03);
  EXPECT_NEAR(r.after_n.mean, 0.26, 0.02);
  ASSERT_EQ(r.layers.size(), 3u);
  EXPECT_EQ(r.layers[0].tissue, "enamel");
  EXPECT_EQ(r.layers[1].tissue, "dentin");
  EXPECT_EQ(r.layers[2].tissue, "pulp");
  EXPECT_NEAR(r.layers[1].from_s.mean, (0.5 + v * tau) / v, 0.3);
}

TEST(ToothRig, SameSeedSameFiguresAndPlacesLieWithinTheSpread) {
  const auto run = [](std::uint64_t seed) {
    ToothRigOptions o = small_rig();
    o.seed = seed;
    o.at_mm = {0.5, -0.5};
    o.spread_mm = 0.2;
    return run_tooth_rig(layered(), hard_model(0.8, 0.1, 0.4), shipped_bur("round-1.0"), o);
  };
  const ToothRigResult a = run(3);
  EXPECT_EQ(to_json(a).dump(), to_json(run(3)).dump());
  EXPECT_NE(to_json(a).dump(), to_json(run(4)).dump());
  for (const auto& r : a.runs)
    EXPECT_LE((r.x_mm - 0.5) * (r.x_mm - 0.5) + (r.y_mm + 0.5) * (r.y_mm + 0.5), 0.2 * 0.2 + 1e-12);
}

TEST(ToothRig, StifferEnamelShowsAsAStepBetweenTwoHardTissues) {
  ForceModel model = hard_model(0.4, 0.0, 0.2);
  model.materials.find("enamel")->second.voigt.stiffness_n_per_mm = 1.6;
  const ToothRigResult r = run_tooth_rig(layered(), model, shipped_bur("round-1.0"), small_rig());
  EXPECT_GT(r.layers[0].force_n.mean, r.layers[1].force_n.mean + 0.02);
}

TEST(ToothRig, ToothWithoutPulpIsRefused) {
  const Tooth solid = make_block({3, 3, 2}, {{"enamel", 1.0}, {"dentin", 1.0}}, 0.1);
  EXPECT_EQ(code_of([&] {
              (void)run_tooth_rig(solid, hard_model(0.8, 0.0), shipped_bur("round-1.0"),
                                  small_rig());
            }),
            RigError::no_pulp);
  ToothRigOptions beside = small_rig();
  beside.at_mm = {40.0, 0.0};
  EXPECT_THROW(
      (void)run_tooth_rig(layered(), hard_model(0.8, 0.0), shipped_bur("round-1.0"), beside),
      Error);
}

}  // namespace
}  // namespace cavum
