#include "engine/tooth/fill.h"

#include <gtest/gtest.h>

#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

using namespace testing_basics;

std::array<bool, 256> voids_of(const Tooth& t) {
  std::array<bool, 256> out{};
  for (const auto& tissue : t.tissues) out[tissue.id] = !tissue.solid;
  return out;
}

TEST(Fill, ATwoRootedMolarLosesItsCavitiesAndNothingElse) {
  const Tooth molar = load_tooth_file(data_path("teeth/lower_molar.cvt"));
  const Tooth filled = filled_tooth(molar, voids_of(molar));
  const TissueGrid a = molar.octree.to_grid(), b = filled.octree.to_grid();
  ASSERT_EQ(a.count(), b.count());
  const auto before = molar.octree.count_leaves(), after = filled.octree.count_leaves();
  EXPECT_EQ(after[k_pulp], 0u);
  EXPECT_EQ(after[k_periodontium], 0u);
  EXPECT_EQ(after[k_enamel] + after[k_dentin],
            before[k_enamel] + before[k_dentin] + before[k_pulp] + before[k_periodontium]);
  std::size_t far = 0;
  for (int z = 0; z < a.size.z; ++z)
    for (int y = 0; y < a.size.y; ++y)
      for (int x = 0; x < a.size.x; ++x) {
        const IVec3 leaf{x, y, z};
        const auto i = a.index(leaf);
        if (molar.octree.is_solid(a.tissue[i]) || a.tissue[i] == k_air) {
          ASSERT_EQ(a.tissue[i], b.tissue[i]);
        } else {
          ASSERT_TRUE(filled.octree.is_solid(b.tissue[i]));
        }
        if (a.distance[i] == b.distance[i]) continue;
        // whatever changed has a cavity within three leaves
        bool near = false;
        for (int dz = -3; dz <= 3 && !near; ++dz)
          for (int dy = -3; dy <= 3 && !near; ++dy)
            for (int dx = -3; dx <= 3 && !near; ++dx) {
              const IVec3 other = leaf + IVec3{dx, dy, dz};
              near = a.inside(other) && a.tissue[a.index(other)] != b.tissue[b.index(other)];
            }
        far += near ? 0 : 1;
      }
  EXPECT_EQ(far, 0u);
}

TEST(Fill, OnlyWhatIsAskedForIsFilled) {
  const Tooth molar = load_tooth_file(data_path("teeth/lower_molar.cvt"));
  std::array<bool, 256> pulp{};
  pulp[k_pulp] = true;
  const auto before = molar.octree.count_leaves(),
             after = filled_tooth(molar, pulp).octree.count_leaves();
  EXPECT_EQ(after[k_pulp], 0u);
  EXPECT_EQ(after[k_periodontium], before[k_periodontium]);
  EXPECT_EQ(filled_tooth(molar, {}).octree.count_leaves(), before);
}

TEST(Fill, InsideTheFilledToothNoSurfaceIsLeft) {
  const Tooth molar = load_tooth_file(data_path("teeth/lower_molar.cvt"));
  const Octree filled = filled_tooth(molar, voids_of(molar)).octree;
  const TissueGrid a = molar.octree.to_grid();
  int looked = 0;
  for (int z = 3; z + 3 < a.size.z; z += 2)
    for (int y = 3; y + 3 < a.size.y; y += 2)
      for (int x = 3; x + 3 < a.size.x; x += 2) {
        if (a.tissue[a.index({x, y, z})] != k_pulp) continue;
        bool deep = true;  // no air and no periodontium within three leaves
        for (int dz = -3; dz <= 3; ++dz)
          for (int dy = -3; dy <= 3; ++dy)
            for (int dx = -3; dx <= 3; ++dx) {
              const auto t = a.tissue[a.index({x + dx, y + dy, z + dz})];
              deep = deep && t != k_air && t != k_periodontium;
            }
        if (!deep) continue;
        ++looked;
        ASSERT_EQ(filled.distance_code({x, y, z}), -k_distance_far);
      }
  EXPECT_GT(looked, 100);
}

}  // namespace
}  // namespace cavum
