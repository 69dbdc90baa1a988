#include "engine/tooth/make/make_molar.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "engine/base/error.h"
#include "engine/base/random.h"
#include "engine/tooth/distance_transform.h"
#include "engine/tooth/octree_edit.h"
#include "tests/engine/tooth/tooth_testing.h"

namespace cavum {
namespace {

using testing_tooth::volume_mm3;

MolarShape coarse(int canals = 3) {
  MolarShape shape;
  shape.leaf_mm = 0.1;
  shape.canals = canals;
  return shape;
}

const Tooth& molar() {
  static const Tooth tooth = make_molar(coarse());
  return tooth;
}

TEST(MakeMolar, HasTheVolumesOfALowerFirstMolar) {
  EXPECT_GT(volume_mm3(molar(), k_enamel), 200);
  EXPECT_LT(volume_mm3(molar(), k_enamel), 260);
  EXPECT_GT(volume_mm3(molar(), k_dentin), 550);
  EXPECT_LT(volume_mm3(molar(), k_dentin), 700);
  EXPECT_GT(volume_mm3(molar(), k_pulp), 25);
  EXPECT_LT(volume_mm3(molar(), k_pulp), 40);
}

TEST(MakeMolar, PulpIsOneBodyWithTheChosenCanalsAtMidRoot) {
  for (const int canals : {2, 3, 4}) {
    const Tooth tooth = make_molar(coarse(canals));
    const TissueGrid grid = tooth.octree.to_grid();
    EXPECT_EQ(testing_tooth::count_bodies(grid, k_pulp, 0, grid.size.z - 1), 1) << canals;
    const auto level = tooth.octree.leaf_at({0, 0, -10.5}).z;
    EXPECT_EQ(testing_tooth::count_bodies(grid, k_pulp, level, level), canals);
    EXPECT_EQ(testing_tooth::count_bodies(grid, k_dentin, level, level), 2) << "two roots";
  }
}

// Straight down from the central fossa: enamel, dentin, a chamber 1.5-2 mm high, a floor, the
// furcation.
TEST(MakeMolar, ChamberAndFurcationLieWhereTheyShould) {
  std::vector<std::pair<std::uint8_t, double>> layers;  // tissue, top z
  for (double z = 4.0; z > -17; z -= 0.01) {
    const auto t = molar().octree.tissue_at({0.3, -0.6, z});
    if (layers.empty() || layers.back().first != t) layers.emplace_back(t, z);
  }
  ASSERT_GE(layers.size(), 6u);
  EXPECT_EQ(layers[1].first, k_enamel);
  EXPECT_EQ(layers[2].first, k_dentin);
  EXPECT_EQ(layers[3].first, k_pulp);
  EXPECT_EQ(layers[4].first, k_dentin);
  EXPECT_EQ(layers[5].first, k_periodontium);
  EXPECT_NEAR(layers[1].second - layers[3].second, 3.9, 0.5);  // fossa to roof
  EXPECT_NEAR(layers[3].second - layers[4].second, 1.8, 0.25);
  EXPECT_NEAR(layers[4].second - layers[5].second, 3.0, 0.5);  // floor to furcation
}

TEST(MakeMolar, OcclusalEnamelIsOneToTwoAndAHalfMillimetresThick) {
  const TissueGrid grid = molar().octree.to_grid();
  std::vector<std::uint8_t> dentin(grid.count());
  for (std::size_t i = 0; i < dentin.size(); ++i) dentin[i] = grid.tissue[i] == k_dentin;
  const auto nearest = nearest_seed(grid.size, dentin, 60);
  std::vector<double> thick;
  for (std::int32_t y = 0; y < grid.size.y; ++y)
    for (std::int32_t x = 0; x < grid.size.x; ++x)
      for (std::int32_t z = grid.size.z - 1; z > 0; --z) {
        const auto i = grid.index({x, y, z});
        if (grid.tissue[i] == k_air) continue;
        const Vec3 p = grid.centre_mm({x, y, z});
        if (std::fabs(p.x) > 4 || std::fabs(p.y) > 3) break;
        ASSERT_EQ(grid.tissue[i], k_enamel);
        ASSERT_GE(nearest[i], 0);
        const auto n = static_cast<std::int32_t>(nearest[i]);
        const IVec3 at{n % grid.size.x, n / grid.size.x % grid.size.y,
                       n / (grid.size.x * grid.size.y)};
        thick.push_back(length(grid.centre_mm(at) - p));
        break;
      }
  std::sort(thick.begin(), thick.end());
  std::cout << "occlusal enamel " << thick.front() << " to " << thick.back() << " mm, median "
            << thick[thick.size() / 2] << '\n';
  EXPECT_GE(thick.front(), 0.9);
  EXPECT_LE(thick.back(), 2.6);
}

TEST(MakeMolar, RefusesParametersOutOfRange) {
  MolarShape shape = coarse();
  shape.canals = 5;
  EXPECT_THROW((void)make_molar(shape), Error);
}

TEST(Periodontium, SurroundsTheRootsAndChangesNothingElse) {
  MolarShape bare = coarse();
  bare.periodontium_mm = 0;
  const Tooth without = make_molar(bare);
  for (const std::uint8_t id : {k_enamel, k_dentin, k_pulp})
    EXPECT_EQ(without.octree.count_leaves()[id], molar().octree.count_leaves()[id]);
  EXPECT_EQ(without.octree.count_leaves()[k_periodontium], 0u);
  // Every periodontium leaf is air without it, and dentin is its nearest hard tissue, within 1 mm
  // (brute force on a sample).
  Random random(testing_tooth::drawn_seed("Periodontium.SurroundsTheRootsAndChangesNothingElse"));
  std::vector<Vec3> supported;
  molar().octree.for_each_cube([&](IVec3 at, int edge, std::uint8_t t) {
    if (t == k_periodontium)
      supported.push_back(molar().octree.centre_mm(at + IVec3{edge / 2, edge / 2, edge / 2}));
  });
  ASSERT_FALSE(supported.empty());
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = supported[random.below(supported.size())];
    ASSERT_EQ(without.octree.tissue_at(p), k_air);
    double best = 1e9;
    std::uint8_t tissue = k_air;
    const IVec3 middle = without.octree.leaf_at(p);
    for (int z = -11; z <= 11; ++z)
      for (int y = -11; y <= 11; ++y)
        for (int x = -11; x <= 11; ++x) {
          const IVec3 leaf = middle + IVec3{x, y, z};
          const auto t = without.octree.tissue(leaf);
          const double d = length(without.octree.centre_mm(leaf) - p);
          if ((t == k_dentin || (t == k_enamel && d < best - 1e-9)) && d < best + 1e-9) {
            best = std::min(best, d);
            tissue = t;
          }
        }
    ASSERT_EQ(tissue, k_dentin);
    ASSERT_LE(best, 1.0 + 0.05 + 1e-9);
  }
}

}  // namespace
}  // namespace cavum
