// A tooth taken apart from what stands beside it.
#include "engine/tooth/adjacent.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "engine/tooth/make/make_block.h"
#include "engine/tooth/octree_edit.h"

namespace cavum {
namespace {

constexpr double k_beside_leaf_mm = 0.05;

/// Bodies on one lattice, each a signed distance (mm, negative inside) with its label; distances
/// are those of all together.
struct Body {
  std::uint8_t tissue;
  double (*distance_mm)(Vec3);
};
double tooth_ball(Vec3 p) { return length(p) - 1.5; }
double neighbour_ball(Vec3 p) {
  return length(p - Vec3{3.02, 0.03, 0.1}) - 1.5;
}  // about 0.02 mm beside the tooth
double gum_ball(Vec3 p) { return length(p - Vec3{1.5, 0, -1.7}) - 0.6; }

Tooth bodies_in_one_tree(const std::vector<Body>& bodies) {
  Tooth tooth;
  tooth.tissues = {{k_enamel, "enamel", true},
                   {k_neighbour_enamel, "neighbour_enamel", true},
                   {k_gingiva, "gingiva", true},
                   {k_pulp, "pulp", false}};
  TissueGrid grid;
  grid.allocate({130, 68, 64}, k_beside_leaf_mm, {-1.7, -1.7, -1.61});
  std::size_t i = 0;
  for (int z = 0; z < grid.size.z; ++z)
    for (int y = 0; y < grid.size.y; ++y)
      for (int x = 0; x < grid.size.x; ++x, ++i) {
        double d = 1e9;
        for (const Body& b : bodies)
          if (const double one = b.distance_mm(grid.centre_mm({x, y, z})); one < d) {
            d = one;
            if (one < 0) grid.tissue[i] = b.tissue;
          }
        grid.distance[i] = encode_distance(d / k_beside_leaf_mm);
      }
  grid.make_consistent(tooth.tissues);
  tooth.octree = Octree(grid, tooth.tissues);
  return tooth;
}

const Body k_tooth_body{k_enamel, tooth_ball}, k_neighbour_body{k_neighbour_enamel, neighbour_ball},
    k_gum_body{k_gingiva, gum_ball};

/// Largest difference of two trees' distances, in leaves; infinite where their tissues differ.
double difference_leaves(const Octree& a, const Octree& b) {
  double most = 0;
  for (int z = 0; z < a.size().z; ++z)
    for (int y = 0; y < a.size().y; ++y)
      for (int x = 0; x < a.size().x; ++x) {
        const IVec3 leaf{x, y, z};
        if (a.tissue(leaf) != b.tissue(leaf)) return 1e9;
        most = std::max(most, std::fabs(decode_distance(a.distance_code(leaf)) -
                                        decode_distance(b.distance_code(leaf))));
      }
  return most;
}

TEST(Beside, ATissueIsBesideTheToothByItsName) {
  EXPECT_TRUE(is_adjacent("neighbour_enamel"));
  EXPECT_TRUE(is_adjacent("gingiva"));
  EXPECT_FALSE(is_of_neighbour("gingiva"));
  EXPECT_FALSE(is_adjacent("enamel"));
  EXPECT_FALSE(is_adjacent("neighbour"));
}

TEST(Beside, WithoutThemTheToothHasTheLeavesAndDistancesThatItHasAlone) {
  const Tooth together = bodies_in_one_tree({k_tooth_body, k_neighbour_body, k_gum_body});
  ASSERT_TRUE(has_adjacent(together));
  EXPECT_GT(difference_leaves(together.octree, bodies_in_one_tree({k_tooth_body}).octree),
            1.0);  // they do differ
  EXPECT_LT(
      difference_leaves(own_tooth(together).octree, bodies_in_one_tree({k_tooth_body}).octree),
      0.16);
  EXPECT_LT(
      difference_leaves(neighbours_alone(together), bodies_in_one_tree({k_neighbour_body}).octree),
      0.16);
}

TEST(Beside, AWayCutBetweenThemIsTheSameFromBothSides) {
  Tooth together = bodies_in_one_tree({k_tooth_body, k_neighbour_body}),
        alone = bodies_in_one_tree({k_tooth_body});
  const auto slot = [](Vec3 p) {
    return std::max({std::fabs(p.x - 1.5) - 0.4, std::fabs(p.y) - 0.5, -0.3 - p.z});
  };
  for (Tooth* t : {&together, &alone}) {
    std::vector<RemovedLeaf> removed;
    removed.reserve(100000);
    t->octree.reserve_edits(10000);
    ASSERT_TRUE(t->octree.carve({0, -1, -1}, {3, 1, 2}, slot, removed));
    EXPECT_GT(removed.size(), 1000u);
  }
  EXPECT_LT(
      difference_leaves(octree_without(together.octree, adjacent_tissues(together)), alone.octree),
      0.8);  // at the edges of the cut
}

TEST(Beside, AToothThatStandsAloneStaysAsItIs) {
  const Tooth block = make_block({2, 2, 1}, {{"enamel", 0.5}, {"dentin", 0.5}}, 0.1);
  EXPECT_FALSE(has_adjacent(block));
  EXPECT_EQ(tooth_hash(own_tooth(block)), tooth_hash(block));
  EXPECT_EQ(tooth_hash(own_tooth(own_tooth(block))), tooth_hash(block));
}

TEST(Beside, LeavesPutIntoATreeAreThoseOfTheTreeBuiltWithThem) {
  const Tooth together = bodies_in_one_tree({k_tooth_body, k_neighbour_body});
  TissueGrid grid = together.octree.to_grid(), part;
  part.allocate({8, 12, 4}, k_beside_leaf_mm, {});
  std::fill(part.tissue.begin(), part.tissue.end(), std::uint8_t{k_pulp});
  const IVec3 low{64, 24, 28};
  const Octree put = together.octree.with_leaves(low, part);
  for (int z = 0; z < 4; ++z)
    for (int y = 0; y < 12; ++y)
      for (int x = 0; x < 8; ++x) {
        grid.tissue[grid.index(low + IVec3{x, y, z})] = k_pulp;
        grid.distance[grid.index(low + IVec3{x, y, z})] = k_distance_far;
      }
  ByteWriter a, b;
  put.write(a);
  Octree(grid, together.tissues).write(b);
  EXPECT_EQ(a.bytes(), b.bytes());
  EXPECT_THROW(static_cast<void>(together.octree.with_leaves({1, 0, 0}, part)), Error);
}

}  // namespace
}  // namespace cavum
