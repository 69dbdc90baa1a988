// What carving costs at three leaves: a ball out of a solid block, and a head that drills on by a
// quarter leaf.
//   octree_bench [any]   with an argument the leaf of 0.05 mm alone, for profilers
#include <cstdio>

#include "engine/base/order.h"
#include "engine/physics/cutting/carve_head.h"
#include "engine/tooth/make/make_block.h"
#include "engine/tooth/octree_edit.h"
#include "tests/bench/thread_clock.h"
#include "tests/engine/support/engine_testing.h"
#include "tests/engine/tooth/tooth_testing.h"

namespace cavum {
namespace {

using testing_tooth::Ball;

/// Median time of one ball out of a solid block, each at a new place.
double carve_ball_us(const Tooth& block, double radius, std::size_t* leaves) {
  std::vector<double> us;
  std::vector<RemovedLeaf> removed;
  removed.reserve(1 << 17);
  Octree tree = block.octree;
  tree.reserve_edits(1 << 16);
  for (int i = 0; i < 120; ++i) {
    if (i % 12 == 0) {
      tree = block.octree;
      tree.reserve_edits(1 << 16);
    }
    const Vec3 at{-2.2 + 1.4 * (i % 4), -1.5 + 1.5 * (i / 4 % 3), -2.013 - 0.003 * i};
    const double r = radius + 3 * tree.leaf_mm();
    removed.clear();
    const double begin = thread_us();
    (void)tree.carve(at - Vec3{r, r, r}, at + Vec3{r, r, r}, Ball{at, radius}, removed);
    us.push_back(thread_us() - begin);
    *leaves = removed.size();
  }
  return median(us);
}

/// Median time of a carve of a head that moves on by a quarter leaf.
double drill_on_us(const Tooth& block, const Bur& bur) {
  Octree tree = block.octree;
  tree.reserve_edits(1 << 17);
  std::vector<RemovedLeaf> removed;
  removed.reserve(1 << 17);
  HeadCarving carving;
  std::vector<double> us;
  for (double z = 0; z > -3.0; z -= 0.25 * tree.leaf_mm()) {
    removed.clear();
    const double begin = thread_us();
    begin_carving(carving, {{0.013, 0.007, z}, {}, 0});
    (void)go_on_carving(carving, tree, bur, k_at_once, removed);
    if (z < -1.5) us.push_back(thread_us() - begin);
  }
  return median(us);
}

}  // namespace
}  // namespace cavum

int main(int argc, char**) {
  using namespace cavum;
  for (const double leaf : {0.1, 0.05, 0.025}) {
    if (argc > 1 && leaf != 0.05) continue;
    const Tooth block = make_block({6, 5, 4.4}, {{"enamel", 4.4}}, leaf);
    std::size_t small = 0, large = 0;
    const double half = carve_ball_us(block, 0.25, &small), one = carve_ball_us(block, 0.5, &large);
    std::printf(
        "leaf %.3f mm: ball of 0.5 mm diameter %7.1f us (%zu leaves), of 1.0 mm %7.1f us (%zu leaves); round-1.0 drills on by 1/4 leaf: %6.1f us\n",
        leaf, half, small, one, large,
        drill_on_us(block, testing_engine::shipped_bur("round-1.0")));
  }
}
