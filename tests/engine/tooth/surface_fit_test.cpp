#include "engine/tooth/surface_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/base/random.h"
#include "engine/base/vec.h"
#include "engine/tooth/tissue_grid.h"
#include "tests/engine/support/engine_testing.h"
#include "tests/engine/tooth/tooth_testing.h"

namespace cavum {
namespace {

constexpr double k_codes_per_leaf = k_distance_far / k_distance_band_leaves;

TEST(SurfaceFit, ContinuesPlanes) {
  Random random(testing_tooth::drawn_seed("SurfaceFit.ContinuesPlanes"));
  for (int round = 0; round < 2000; ++round) {
    const Vec3 normal = testing_engine::random_direction(random);
    const double offset = random.uniform(-0.8, 0.8);
    FitWindow window;
    for (int z = -2; z < 6; ++z)
      for (int y = -2; y < 6; ++y)
        for (int x = -2; x < 6; ++x) {
          const bool known =
              z < 1 ||
              (z == 1 && (y < 1 || (y == 1 && x < 1)));  // what raster order knows at (1, 1, 1)
          const auto code = encode_distance(dot(normal, {x - 1.0, y - 1.0, z - 1.0}) + offset);
          if (known && std::abs(int{code}) < k_distance_far)
            window.leaf[static_cast<std::size_t>(FitWindow::index(x, y, z))] = {code, 3};
        }
    const SurfaceFit fit = fit_surface(window, FitWindow::index(1, 1, 1));
    EXPECT_NEAR(fit.near, offset * k_codes_per_leaf, 3.0)
        << "normal " << normal.x << " " << normal.y << " " << normal.z;
    EXPECT_NEAR(fit.wide, offset * k_codes_per_leaf, 1.5);
    EXPECT_EQ(fit.error_8, 24);
  }
}

TEST(SurfaceFit, SaysZeroWithNothingToGoBy) {
  const SurfaceFit fit = fit_surface(FitWindow{}, FitWindow::index(0, 0, 0));
  EXPECT_EQ(fit.near, 0.0);
  EXPECT_EQ(fit.wide, 0.0);
  EXPECT_EQ(fit.error_8, -1);
}

TEST(SurfaceFit, StaysFiniteWhateverTheLeavesHold) {
  Random random(testing_tooth::drawn_seed("SurfaceFit.StaysFiniteWhateverTheLeavesHold"));
  for (int round = 0; round < 20000; ++round) {
    FitWindow window;
    const auto crowd = 1 + random.below(40);
    for (auto& leaf : window.leaf) {
      leaf.code = static_cast<std::int8_t>(random.below(2)   ? random.below(256)
                                           : random.below(2) ? 128
                                                             : 127);
      if (random.below(40) < crowd)
        leaf.error =
            static_cast<std::uint8_t>(random.below(2) ? random.below(41) : FitLeaf::k_guess);
    }
    const SurfaceFit fit =
        fit_surface(window, FitWindow::index(static_cast<int>(random.below(4)), 1, 3));
    ASSERT_TRUE(std::isfinite(fit.near) && std::isfinite(fit.wide));
    ASSERT_GE(fit.error_8, -1);
    ASSERT_LE(fit.error_8, 8 * FitLeaf::k_max_error);
  }
}

}  // namespace
}  // namespace cavum
