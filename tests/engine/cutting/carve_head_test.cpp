#include "engine/cutting/carve_head.h"

#include <gtest/gtest.h>

#include "engine/base/det_math.h"
#include "engine/tooth/make_block.h"
#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

std::vector<RemovedLeaf> room() {
  std::vector<RemovedLeaf> removed;
  removed.reserve(200000);
  return removed;
}

// The head is tabulated (head_field.h): what lies within 4 micrometres of its surface may fall either way.
TEST(CarveHead, RemovesTheLeavesWhoseCentreTheHeadHeldAndNoOther) {
  Random random(drawn_seed("CarveHead.RemovesTheLeavesWhoseCentreTheHeadHeldAndNoOther"));
  for (const auto& name : point_names()) {
    const DiamondPoint point = diamond_point(name);
    Tooth tooth = make_block({2, 2, 2}, {{"enamel", 1}, {"dentin", 1}}, 0.1);
    const TissueGrid before = tooth.octree.to_grid();
    tooth.octree.reserve_edits(20000);
    auto removed = room();
    std::vector<Pose> poses;
    CarvedHead last;
    Quat turned = random_rotation(random);
    Vec3 tip{random.uniform(-0.9, 0.9), random.uniform(-0.9, 0.9), random.uniform(-1.5, -0.5)}, way = random_direction(random) * 0.02;
    for (int i = 0; i < 40; ++i) {  // straight runs with one rotation, now and then a turn: the leading side alone is carved
      if (random.below(8) == 0) way = random_direction(random) * 0.02;
      if (random.below(12) == 0) turned = random_rotation(random);
      tip += way;
      poses.push_back({tip, turned});
      ASSERT_TRUE(carve_head(tooth.octree, point, 0, tip, rotation(turned), 0.0, last, removed));
    }
    const TissueGrid after = tooth.octree.to_grid();
    std::size_t gone = 0;
    for (std::int32_t z = 0; z < before.size.z; ++z)
      for (std::int32_t y = 0; y < before.size.y; ++y)
        for (std::int32_t x = 0; x < before.size.x; ++x) {
          const auto i = before.index({x, y, z});
          double nearest = 1e9;
          for (const auto& p : poses)
            nearest = std::min(nearest, point.head_distance_mm(rotation(p.rotation).transposed(before.centre_mm({x, y, z}) - p.tip_mm)));
          gone += before.tissue[i] != after.tissue[i];
          if (std::fabs(nearest) < 0.004) continue;
          ASSERT_EQ(after.tissue[i], nearest < 0 ? std::uint8_t{k_air} : before.tissue[i])
              << name << " leaf " << x << ' ' << y << ' ' << z << " distance " << nearest;
        }
    EXPECT_EQ(gone, removed.size()) << name << ": every removed leaf is listed once";
    EXPECT_GT(gone, 0u) << name;
  }
}

TEST(CarveHead, TheLeadingSideAloneGivesTheToothOfTheWholeHeadToOneCode) {
  Random random(drawn_seed("CarveHead.TheLeadingSideAloneGivesTheToothOfTheWholeHeadToOneCode"));
  for (const auto& name : point_names())
    for (int round = 0; round < 3; ++round) {
      const DiamondPoint point = diamond_point(name);
      Tooth one = make_block({2, 2, 2}, {{"enamel", 2}}, 0.05);
      one.octree.reserve_edits(20000);
      Tooth two;
      two.octree = one.octree;
      auto removed_one = room(), removed_two = room();
      CarvedHead last;
      const Mat3 turned = rotation(random_rotation(random));
      Vec3 tip{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1.5, 0.3)};
      for (int i = 0; i < 30; ++i) {
        tip += random_direction(random) * random.uniform(0.002, 0.05);
        ASSERT_TRUE(carve_head(one.octree, point, 0, tip, turned, 0.0, last, removed_one));
        CarvedHead none;
        ASSERT_TRUE(carve_head(two.octree, point, 0, tip, turned, 0.0, none, removed_two));
      }
      const TissueGrid a = one.octree.to_grid(), b = two.octree.to_grid();
      ASSERT_EQ(a.tissue, b.tissue) << name;
      for (std::size_t i = 0; i < a.distance.size(); ++i)
        ASSERT_LE(std::abs(a.distance[i] - b.distance[i]), 1) << name << " at leaf index " << i << " (127 codes are 2 leaves)";
    }
}

TEST(CarveHead, FullRoomIsToldAndTheNextCarveMakesUpForIt) {
  const DiamondPoint point = diamond_point("round-1.0");
  Tooth tooth = make_block({2, 2, 2}, {{"enamel", 2}}, 0.05);
  tooth.octree.reserve_edits(20000);
  std::vector<RemovedLeaf> little;
  little.reserve(10);
  CarvedHead last;
  EXPECT_FALSE(carve_head(tooth.octree, point, 0, {0, 0, -0.5}, Mat3{}, 0.0, last, little));
  EXPECT_LE(little.size(), little.capacity());
  EXPECT_EQ(little.capacity(), 10u) << "it grew";
  EXPECT_EQ(last.point, -1) << "an unfinished carve must not count as done";
  auto removed = room();
  EXPECT_TRUE(carve_head(tooth.octree, point, 0, {0, 0, -0.5}, Mat3{}, 0.0, last, removed));
  const double expected = 2.0 / 3.0 * k_pi * 0.125;  // half a ball
  EXPECT_NEAR(static_cast<double>(removed.size() + little.size()) * 1.25e-4 / expected, 1.0, 0.02);
}

}  // namespace
}  // namespace cavum
