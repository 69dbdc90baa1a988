// The rates of the clinical set beside what is published (docs/cutting_rates.md).
#include "engine/lab/rig/grind_rig.h"

#include <gtest/gtest.h>

#include "engine/base/det_math.h"
#include "engine/lab/rig/rig_error.h"
#include "engine/lab/rig/testing_machine.h"
#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

GrindRow ground(const std::string& set, const std::string& bur, const std::string& tissue,
                double load_n, const GrindOptions& options = {}) {
  return grind(shipped_model(set), shipped_bur(bur), tissue, load_n, options);
}

TEST(GrindRig, EnamelOnTheSideOfACylinderGoesAtThePublishedRate) {
  // Fais 2010: 0.10 to 0.12 g of human enamel in 12 min under 50 to 80 g: 2.8 to 3.4 mm³/min
  // at 2.95 mg/mm³, around 0.64 N. The speed is not given: the surface speed of a 1.2 mm bur at
  // 250,000 rpm under load is assumed, which 1.0 mm has at 300,000.
  ForceModel stiff = shipped_model("clinical");
  stiff.drive = {};
  const GrindRow row = grind(stiff, shipped_bur("cylinder-flat-1.0"), "enamel", 0.64,
                             {.load_n = {}, .rpm = 300000.0, .side = true});
  std::printf("enamel, 0.64 N, on the side at 15.7 m/s: %.2f mm3/min\n", row.mm3_per_min);
  ASSERT_TRUE(row.sunk);
  EXPECT_GE(row.mm3_per_min, 2.8);
  EXPECT_LE(row.mm3_per_min, 3.4);
  // Preston over the arc ±α of a groove 0.15 mm deep, cosα = 0.7: V = K F ω 2R sinα/(α + sinα cosα)
  const double alpha = std::acos(0.7), omega = 300000.0 * 2 * k_pi / 60;
  const double closed =
      5e-6 * 0.64 * omega * 2 * 0.5 * std::sin(alpha) / (alpha + std::sin(alpha) * 0.7) * 60;
  EXPECT_NEAR(row.mm3_per_min / closed, 1.0, 0.08) << closed;
}

TEST(GrindRig, DentinGoesFasterThanEnamelAndALesionFaster) {
  for (const char* bur : {"round-1.0", "cylinder-flat-1.0", "taper-round-1.2", "pear-1.0"}) {
    const double enamel = ground("clinical", bur, "enamel", 0.65).mm3_per_min,
                 dentin = ground("clinical", bur, "dentin", 0.65).mm3_per_min,
                 lesion = ground("clinical", bur, "lesion", 0.65).mm3_per_min;
    std::printf("%-18s enamel %.2f, dentin %.2f, lesion %.2f mm3/min\n", bur, enamel, dentin,
                lesion);
    EXPECT_NEAR(dentin / enamel, 4.2, 0.3) << bur;
    EXPECT_NEAR(lesion / dentin, 4.0, 0.4) << bur;
  }
}

TEST(GrindRig, ThePapersSetCutsBothAlikeAndManyTimesFaster) {
  const GrindRow enamel = ground("consistent", "round-1.0", "enamel", 0.65),
                 dentin = ground("consistent", "round-1.0", "dentin", 0.65);
  EXPECT_NEAR(enamel.depth_mm_s, 0.65 / 0.8 / 2.02, 0.01) << "X/τ";
  EXPECT_NEAR(enamel.depth_mm_s / dentin.depth_mm_s, 1.0, 0.01);
  EXPECT_EQ(enamel.torque_n_mm, 0.0);
  EXPECT_NEAR(enamel.rpm, 200000.0, 10.0);
  EXPECT_GT(enamel.mm3_per_min / ground("clinical", "round-1.0", "enamel", 0.65).mm3_per_min, 5.0);
}

TEST(GrindRig, RigsOfThePaperRefuseASetWithoutTau) {
  EXPECT_EQ(code_of([] { require_penetration(shipped_model("clinical")); }), RigError::by_pressure);
  require_penetration(shipped_model("paper"));
}

}  // namespace
}  // namespace cavum
