#include "engine/physics/bur/head_field.h"

#include <gtest/gtest.h>

#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

TEST(HeadField, IsTheDistanceToTheHeadWithinThreeMicrometresOfWhereItMatters) {
  Random random(
      drawn_seed("HeadField.IsTheDistanceToTheHeadWithinThreeMicrometresOfWhereItMatters"));
  for (const auto& name : bur_names()) {
    const Bur bur = shipped_bur(name);
    double worst = 0;
    for (int i = 0; i < 20000;) {
      float r[8], z[8], d[8];
      for (int k = 0; k < 8; ++k) {
        r[k] = static_cast<float>(random.uniform(0, bur.head_radius_mm + 0.3));
        z[k] = static_cast<float>(random.uniform(-0.3, bur.cutting_length_mm + 0.3));
      }
      bur.field.distances_mm(r, z, d);
      for (int k = 0; k < 8; ++k, ++i) {
        const double exact = bur.head_distance_mm({r[k], 0, z[k]});
        if (std::fabs(exact) > 0.15) {  // only its sign counts there
          ASSERT_GT(d[k] * exact, 0.0) << name << " at r " << r[k] << " z " << z[k];
          continue;
        }
        worst = std::max(worst, std::fabs(d[k] - exact));
      }
    }
    std::printf("%-18s: table off by at most %.4f mm\n", name.c_str(), worst);
    EXPECT_LE(worst, 0.0065) << name;  // on the ridge behind a sharp edge; half a node apart
  }
}

TEST(HeadField, FarAwayItIsNeverNearerThanItsMargin) {
  const Bur bur = shipped_bur("round-1.0");
  const float r[8] = {5, 0, 0, 5, 1000, 0, 0, 3}, z[8] = {0.5f, -5, 8, -5, 0, 1e6f, -1e6f, 9};
  float d[8];
  bur.field.distances_mm(r, z, d);
  for (const float v : d) EXPECT_GT(v, 0.38f);
}

}  // namespace
}  // namespace cavum
