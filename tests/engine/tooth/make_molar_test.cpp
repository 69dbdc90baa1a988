#include "engine/tooth/make_molar.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "engine/base/error.h"
#include "engine/base/random.h"
#include "engine/tooth/distance.h"
#include "tests/engine/tooth/tooth_testing.h"

namespace cavum {
namespace {

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

double volume_mm3(const Tooth& tooth, std::uint8_t id) {
  return static_cast<double>(tooth.octree.count_leaves()[id]) * tooth.octree.leaf_volume_mm3();
}

struct Range {
  double low = 1e9, high = -1e9;
  void add(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
};

TEST(MakeMolar, HasTheVolumesAndMeasuresOfALowerFirstMolar) {
  EXPECT_GT(volume_mm3(molar(), k_enamel), 200);
  EXPECT_LT(volume_mm3(molar(), k_enamel), 260);
  EXPECT_GT(volume_mm3(molar(), k_dentin), 550);
  EXPECT_LT(volume_mm3(molar(), k_dentin), 700);
  EXPECT_GT(volume_mm3(molar(), k_pulp), 25);
  EXPECT_LT(volume_mm3(molar(), k_pulp), 40);
  Range x, y, z, all_z;
  molar().octree.for_each_cube([&](IVec3 at, int edge, std::uint8_t t) {
    const Vec3 low = molar().octree.origin_mm() + Vec3{double(at.x), double(at.y), double(at.z)} * 0.1;
    if (t == k_periodontium) return;
    for (const double e : {0.0, edge * 0.1}) {
      all_z.add(low.z + e);
      if (t != k_enamel) continue;
      x.add(low.x + e);
      y.add(low.y + e);
      z.add(low.z + e);
    }
  });
  EXPECT_NEAR(x.high - x.low, 11.0, 0.4);
  EXPECT_NEAR(y.high - y.low, 10.0, 0.4);
  EXPECT_NEAR(z.high - z.low, 7.0, 0.6);
  EXPECT_NEAR(all_z.high - all_z.low, 20.0, 1.0);  // crown 7, roots 13
  EXPECT_NEAR(x.high + x.low, 0, 0.3);             // the origin is the crown's centre
  EXPECT_NEAR(y.high + y.low, 0, 0.3);
  EXPECT_NEAR(z.high + z.low, 0, 0.4);
}

TEST(MakeMolar, PulpIsOneEnclosedBodyWithTheChosenCanalsAtMidRoot) {
  for (const int canals : {2, 3, 4}) {
    const Tooth tooth = make_molar(coarse(canals));
    const TissueGrid grid = tooth.octree.to_grid();
    EXPECT_EQ(testing_tooth::count_bodies(grid, k_pulp, 0, grid.size.z - 1), 1) << canals;
    const auto level = tooth.octree.leaf_at({0, 0, -10.5}).z;
    EXPECT_EQ(testing_tooth::count_bodies(grid, k_pulp, level, level), canals);
    EXPECT_EQ(testing_tooth::count_bodies(grid, k_dentin, level, level), 2) << "two roots";
    for (std::int32_t z = 1; z + 1 < grid.size.z; ++z)
      for (std::int32_t y = 1; y + 1 < grid.size.y; ++y)
        for (std::int32_t x = 1; x + 1 < grid.size.x; ++x)
          if (grid.tissue[grid.index({x, y, z})] == k_pulp)
            for (const IVec3 s : {IVec3{1, 0, 0}, IVec3{-1, 0, 0}, IVec3{0, 1, 0}, IVec3{0, -1, 0}, IVec3{0, 0, 1}, IVec3{0, 0, -1}}) {
              const auto t = grid.tissue[grid.index(IVec3{x, y, z} + s)];
              ASSERT_TRUE(t == k_pulp || t == k_dentin);
            }
  }
}

// Straight down from the central fossa: enamel, dentin, a chamber 1.5-2 mm high, a floor, the furcation.
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
  const auto nearest = nearest_marked(grid.size, dentin, 60);
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
        const IVec3 at{n % grid.size.x, n / grid.size.x % grid.size.y, n / (grid.size.x * grid.size.y)};
        thick.push_back(length(grid.centre_mm(at) - p));
        break;
      }
  std::sort(thick.begin(), thick.end());
  std::cout << "occlusal enamel " << thick.front() << " to " << thick.back() << " mm, median " << thick[thick.size() / 2] << '\n';
  EXPECT_GE(thick.front(), 0.9);
  EXPECT_LE(thick.back(), 2.6);
}

// The stored distance leads to the formula's own zero, which the octree never saw.
TEST(MakeMolar, DistancesLeadToTheTrueSurface) {
  Random random(testing_tooth::drawn_seed("MakeMolar.DistancesLeadToTheTrueSurface"));
  const Molar formula(coarse());
  const auto f = [&](Vec3 p) { return std::max(formula.outside(p), -formula.pulp(p)); };
  Octree::Cursor cursor;
  std::vector<double> error;
  while (error.size() < 20000) {
    const Vec3 p{random.uniform(-5.5, 5.5), random.uniform(-5.2, 5.2), random.uniform(-16, 3.5)};
    const auto s = molar().octree.sample(p, cursor);
    if (std::fabs(s.distance_mm) > 0.1 || length(s.gradient) < 0.9) continue;
    const Vec3 foot = p - s.gradient * (s.distance_mm / dot(s.gradient, s.gradient));
    const double h = 1e-4;
    const Vec3 g = Vec3{f(foot + Vec3{h, 0, 0}) - f(foot - Vec3{h, 0, 0}), f(foot + Vec3{0, h, 0}) - f(foot - Vec3{0, h, 0}),
                        f(foot + Vec3{0, 0, h}) - f(foot - Vec3{0, 0, h})} /
                   (2 * h);
    error.push_back(std::fabs(f(foot)) / length(g));
  }
  std::sort(error.begin(), error.end());
  std::cout << "surface error, um: median " << 1e3 * error[10000] << ", 95 % " << 1e3 * error[19000] << ", 99 % " << 1e3 * error[19800] << '\n';
  EXPECT_LT(error[10000], 0.002);
  EXPECT_LT(error[19000], 0.012);  // leaf 0.1 mm; four times less at 0.05 mm
}

TEST(MakeMolar, GivesTheSameBytesEveryTime) { EXPECT_EQ(tooth_hash(make_molar(coarse())), tooth_hash(molar())); }

TEST(MakeMolar, RefusesParametersOutOfRange) {
  MolarShape shape = coarse();
  shape.canals = 5;
  EXPECT_THROW((void)make_molar(shape), Error);
  shape = coarse();
  shape.leaf_mm = 0.0 / 1.0;
  EXPECT_THROW((void)make_molar(shape), Error);
  shape = coarse();
  shape.periodontium_mm = -1;
  EXPECT_THROW((void)make_molar(shape), Error);
}

TEST(Periodontium, SurroundsTheRootsAndChangesNothingElse) {
  MolarShape bare = coarse();
  bare.periodontium_mm = 0;
  const Tooth without = make_molar(bare);
  for (const std::uint8_t id : {k_enamel, k_dentin, k_pulp}) EXPECT_EQ(without.octree.count_leaves()[id], molar().octree.count_leaves()[id]);
  EXPECT_EQ(without.octree.count_leaves()[k_periodontium], 0u);
  // Every periodontium leaf is air without it, and dentin is its nearest hard tissue, within 1 mm (brute force on a sample).
  Random random(testing_tooth::drawn_seed("Periodontium.SurroundsTheRootsAndChangesNothingElse"));
  std::vector<Vec3> supported;
  molar().octree.for_each_cube([&](IVec3 at, int edge, std::uint8_t t) {
    if (t == k_periodontium) supported.push_back(molar().octree.centre_mm(at + IVec3{edge / 2, edge / 2, edge / 2}));
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
