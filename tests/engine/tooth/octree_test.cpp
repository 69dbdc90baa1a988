#include "engine/tooth/octree.h"

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/base/random.h"
#include "engine/tooth/make/make_block.h"
#include "engine/tooth/octree_edit.h"
#include "tests/engine/tooth/tooth_testing.h"

namespace cavum {
namespace {

using testing_tooth::layered_block;

/// A ball, or the hull of two equal balls, with its exact signed distance.
struct Capsule {
  Vec3 a, b;
  double radius_mm;
  double operator()(Vec3 p) const {
    const Vec3 ab = b - a;
    const double l2 = dot(ab, ab), t = l2 > 0 ? std::clamp(dot(p - a, ab) / l2, 0.0, 1.0) : 0.0;
    return length(p - a - ab * t) - radius_mm;
  }
};

/// The same carve, leaf by leaf, without any tree.
std::uint64_t carve_dense(TissueGrid& grid, const std::vector<Tissue>& tissues,
                          const Capsule& shape) {
  std::uint64_t removed = 0;
  for (std::int32_t z = 0; z < grid.size.z; ++z)
    for (std::int32_t y = 0; y < grid.size.y; ++y)
      for (std::int32_t x = 0; x < grid.size.x; ++x) {
        const auto i = grid.index({x, y, z});
        const double d = shape(grid.centre_mm({x, y, z}));
        if (d < 0 && grid.tissue[i] != k_air) {
          grid.tissue[i] = k_air;
          ++removed;
        }
        grid.distance[i] = std::max(grid.distance[i], encode_distance(-d / grid.leaf_mm));
      }
  grid.make_consistent(tissues);
  return removed;
}

TEST(Octree, EqualsDenseGridAfterRandomCarves) {
  Random random(testing_tooth::drawn_seed("Octree.EqualsDenseGridAfterRandomCarves"));
  for (int round = 0; round < 6; ++round) {
    Tooth tooth = layered_block();
    TissueGrid dense = tooth.octree.to_grid();
    ASSERT_EQ(Octree(dense, tooth.tissues).to_grid().tissue, dense.tissue);
    tooth.octree.reserve_edits(20000);
    std::vector<RemovedLeaf> removed;
    removed.reserve(100000);
    std::uint64_t expected = 0;
    for (int i = 0; i < 25; ++i) {
      const auto point = [&] {
        return Vec3{random.uniform(-1.3, 1.3), random.uniform(-1.2, 1.2),
                    random.uniform(-2.7, 0.3)};
      };
      Capsule shape{point(), point(), random.uniform(0.05, 0.6)};
      if (random.below(2)) shape.b = shape.a;
      const double r = shape.radius_mm + 0.3;
      const Vec3 low{std::min(shape.a.x, shape.b.x) - r, std::min(shape.a.y, shape.b.y) - r,
                     std::min(shape.a.z, shape.b.z) - r};
      const Vec3 high{std::max(shape.a.x, shape.b.x) + r, std::max(shape.a.y, shape.b.y) + r,
                      std::max(shape.a.z, shape.b.z) + r};
      ASSERT_TRUE(tooth.octree.carve(low, high, shape, removed));
      expected += carve_dense(dense, tooth.tissues, shape);
      const TissueGrid now = tooth.octree.to_grid();
      ASSERT_EQ(now.tissue, dense.tissue) << "carve " << i << " of round " << round;
      ASSERT_EQ(now.distance, dense.distance) << "carve " << i << " of round " << round;
      ASSERT_EQ(removed.size(), expected);
    }
    std::array<std::uint64_t, 256> count{};
    for (const auto t : dense.tissue) count[t] += t != k_air;
    EXPECT_EQ(tooth.octree.count_leaves(), count);
  }
}

TEST(Octree, AnswersPointQueriesAsTheDenseGridDoes) {
  Random random(testing_tooth::drawn_seed("Octree.AnswersPointQueriesAsTheDenseGridDoes"));
  const Tooth tooth = layered_block();
  const TissueGrid dense = tooth.octree.to_grid();
  Octree::Cursor cursor;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p{random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-3, 1)};
    const IVec3 leaf = tooth.octree.leaf_at(p);
    const auto expected =
        dense.inside(leaf) ? dense.tissue[dense.index(leaf)] : std::uint8_t{k_air};
    ASSERT_EQ(tooth.octree.tissue_at(p), expected);
    ASSERT_EQ(tooth.octree.tissue_at(p, cursor), expected);
    const auto code = dense.inside(leaf) ? int{dense.distance[dense.index(leaf)]} : k_distance_far;
    ASSERT_EQ(tooth.octree.distance_code(leaf), code);
  }
}

TEST(Octree, NeverCallsABoxClearThatHoldsSolid) {
  Random random(testing_tooth::drawn_seed("Octree.NeverCallsABoxClearThatHoldsSolid"));
  const Tooth tooth = layered_block();
  const TissueGrid dense = tooth.octree.to_grid();
  int clear = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 a{random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5), random.uniform(-2.8, 0.4)};
    const Vec3 b = a + Vec3{random.uniform(0, 0.5), random.uniform(0, 0.5), random.uniform(0, 0.5)};
    if (!tooth.octree.is_clear(a, b)) continue;
    ++clear;
    const IVec3 low = tooth.octree.leaf_at(a), high = tooth.octree.leaf_at(b);
    for (std::int32_t z = low.z; z <= high.z; ++z)
      for (std::int32_t y = low.y; y <= high.y; ++y)
        for (std::int32_t x = low.x; x <= high.x; ++x)
          if (dense.inside({x, y, z})) {
            ASSERT_FALSE(tooth.octree.is_solid(dense.tissue[dense.index({x, y, z})]));
          }
  }
  EXPECT_GT(clear, 0);
}

TEST(Octree, MixesTheTissuesOfTheEightLeavesAroundAPlace) {
  Random random(testing_tooth::drawn_seed("Octree.MixesTheTissuesOfTheEightLeavesAroundAPlace"));
  const Tooth tooth = layered_block();
  const TissueGrid dense = tooth.octree.to_grid();
  Octree::Cursor cursor;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 at{random.uniform(-1.3, 1.3), random.uniform(-1.2, 1.2), random.uniform(-2.7, 0.3)};
    std::array<double, 256> expected{}, seen{};
    const Vec3 p = (at - dense.origin_mm) / dense.leaf_mm - Vec3{0.5, 0.5, 0.5};
    for (std::int32_t z = -1; z <= dense.size.z; ++z) {
      if (std::fabs(p.z - z) >= 1) continue;
      for (std::int32_t y = -1; y <= dense.size.y; ++y) {
        if (std::fabs(p.y - y) >= 1) continue;
        for (std::int32_t x = -1; x <= dense.size.x;
             ++x) {  // the hat function of each leaf's centre
          if (std::fabs(p.x - x) >= 1) continue;
          const double share =
              (1 - std::fabs(p.x - x)) * (1 - std::fabs(p.y - y)) * (1 - std::fabs(p.z - z));
          expected[dense.inside({x, y, z}) ? dense.tissue[dense.index({x, y, z})]
                                           : std::uint8_t{k_air}] += share;
        }
      }
    }
    const TissueMix mix = tooth.octree.mix(at, cursor);
    for (std::size_t k = 0; k < static_cast<std::size_t>(mix.count); ++k)
      seen[mix.label[k]] += mix.share[k];
    if (p.x < -1 || p.y < -1 || p.z < -1 || p.x > dense.size.x || p.y > dense.size.y ||
        p.z > dense.size.z)
      continue;  // all air, all of it
    for (std::size_t t = 0; t < 256; ++t) ASSERT_NEAR(seen[t], expected[t], 1e-9) << "tissue " << t;
  }
}

// An octree that was damaged before it was signed must still not crash the reader.
TEST(Octree, DamagedBytesNeverCrash) {
  Random random(testing_tooth::drawn_seed("Octree.DamagedBytesNeverCrash"));
  const Tooth tooth = layered_block();
  ByteWriter out;
  tooth.octree.write(out);
  int refused = 0;
  for (int i = 0; i < 4000; ++i) {
    Bytes bytes = out.bytes();
    for (std::uint64_t n = 1 + random.below(3); n > 0; --n)
      bytes[random.below(i % 2 ? 200 : bytes.size())] ^=
          static_cast<std::uint8_t>(1u << random.below(8));
    if (i % 5 == 0) bytes.resize(random.below(bytes.size()));
    ByteReader in(bytes, "damaged");
    try {
      const Octree tree = Octree::read(in, tooth.tissues);
      (void)tree.count_leaves();
      (void)tree.tissue_at({0, 0, -1});
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace cavum
