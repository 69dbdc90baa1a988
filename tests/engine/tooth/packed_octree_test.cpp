#include "engine/tooth/packed_octree.h"

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/base/random.h"
#include "engine/tooth/make/make_block.h"
#include "engine/tooth/octree_edit.h"
#include "tests/engine/tooth/tooth_testing.h"

namespace cavum {
namespace {

using testing_tooth::Ball;

Bytes canonical(const Octree& octree) {
  ByteWriter out;
  octree.write(out);
  return out.take();
}

Bytes packed(const Octree& octree, const std::vector<Tissue>& tissues) {
  const Bytes bytes = canonical(octree);
  ByteReader in(bytes, "octree");
  ByteWriter out;
  pack_octree(in, tissues, out);
  return out.take();
}

Bytes unpacked(const Bytes& bytes, const std::vector<Tissue>& tissues,
               const PackedFits* like = nullptr) {
  ByteReader in(bytes, "packed");
  Bytes all = unpack_octree(in, tissues, like);
  EXPECT_EQ(in.left(), 0u);
  return all;
}

void expect_round_trip(const Octree& octree, const std::vector<Tissue>& tissues) {
  const Bytes once = packed(octree, tissues);
  ASSERT_EQ(unpacked(once, tissues), canonical(octree));
  ASSERT_EQ(packed(octree, tissues), once);
}

KnownFits fits_of(const Octree& octree, const std::vector<Tissue>& tissues) {
  const Bytes bytes = packed(octree, tissues);
  ByteReader in(bytes, "packed");
  KnownFits fits;
  EXPECT_EQ(unpack_octree(in, tissues, nullptr, &fits), canonical(octree));
  return fits;
}

std::vector<Tissue> many_tissues() {
  std::vector<Tissue> tissues;
  for (int id = 1; id < 256; ++id)
    tissues.push_back({static_cast<std::uint8_t>(id), "t" + std::to_string(id), id % 3 != 0});
  return tissues;
}

TEST(PackedOctree, BringsBackRandomGrids) {
  Random random(testing_tooth::drawn_seed("PackedOctree.BringsBackRandomGrids"));
  const auto tissues = many_tissues();
  for (int round = 0; round < 60; ++round) {
    TissueGrid grid;
    const auto edge = [&] {
      return static_cast<std::int32_t>(1 + random.below(round % 3 == 0 ? 5 : 40));
    };
    grid.allocate({edge(), edge(), edge()}, 0.05, {1, 2, 3});
    const bool invariant =
        round % 2 == 0;  // else signs are at odds with the labels, which no tooth has
    const auto patch = 1 + random.below(12);  // labels in cubes of this edge
    std::vector<std::uint8_t> label(4096);
    for (auto& l : label) l = static_cast<std::uint8_t>(random.below(round % 5 == 0 ? 2 : 256));
    for (std::int32_t z = 0; z < grid.size.z; ++z)
      for (std::int32_t y = 0; y < grid.size.y; ++y)
        for (std::int32_t x = 0; x < grid.size.x; ++x) {
          const auto at = [patch](std::int32_t v) { return static_cast<std::uint64_t>(v) / patch; };
          grid.tissue[grid.index({x, y, z})] =
              label[(at(x) * 31 + at(y) * 17 + at(z) * 7) % label.size()];
          grid.distance[grid.index({x, y, z})] =
              static_cast<std::int8_t>(random.below(4) ? random.below(256) : k_distance_far);
        }
    if (invariant) grid.make_consistent(tissues);
    expect_round_trip(Octree(grid, tissues), tissues);
    if (HasFatalFailure()) return;
  }
}

TEST(PackedOctree, BringsBackUniformEmptyAndSmallestTrees) {
  const auto tissues = standard_tissues();
  for (const std::int32_t edge : {1, 3, 4, 5, 64, 100})
    for (const std::uint8_t tissue : {k_air, k_enamel, k_pulp})
      for (const bool surface : {false, true}) {
        TissueGrid grid;
        grid.allocate({edge, edge, 1 + edge / 2}, 0.1, {});
        grid.tissue.assign(grid.count(), tissue);
        if (!surface)
          grid.distance.assign(
              grid.count(),
              static_cast<std::int8_t>(tissue == k_enamel ? -k_distance_far : k_distance_far));
        grid.make_consistent(tissues);
        expect_round_trip(Octree(grid, tissues), tissues);
        if (HasFatalFailure()) return;
      }
}

TEST(PackedOctree, BringsBackCarvedTeeth) {
  Random random(testing_tooth::drawn_seed("PackedOctree.BringsBackCarvedTeeth"));
  Tooth tooth = make_block({2.13, 1.9, 2.4},
                           {{"enamel", 0.7}, {"dentin", 0.8}, {"pulp", 0.5}, {"lesion", 0.4}}, 0.1);
  tooth.octree.reserve_edits(20000);
  std::vector<RemovedLeaf> removed;
  removed.reserve(100000);
  for (int i = 0; i < 60; ++i) {
    const Ball ball{
        {random.uniform(-1.3, 1.3), random.uniform(-1.2, 1.2), random.uniform(-2.7, 0.3)},
        random.uniform(0.05, 0.4)};
    const double r = ball.radius_mm + 0.3;
    ASSERT_TRUE(tooth.octree.carve(ball.centre_mm - Vec3{r, r, r}, ball.centre_mm + Vec3{r, r, r},
                                   ball, removed, 0.002 * (i % 3)));
    expect_round_trip(tooth.octree, tooth.tissues);
    if (HasFatalFailure()) return;
  }
}

// Whatever is known of whatever other tooth, the bytes are the same.
TEST(PackedOctree, WhatIsKnownOfAnotherToothChangesNothing) {
  Random random(testing_tooth::drawn_seed("PackedOctree.WhatIsKnownOfAnotherToothChangesNothing"));
  Tooth tooth = make_block({2.13, 1.9, 2.4},
                           {{"enamel", 0.7}, {"dentin", 0.8}, {"pulp", 0.5}, {"lesion", 0.4}}, 0.1);
  tooth.octree.reserve_edits(20000);
  std::vector<KnownFits> known{fits_of(tooth.octree, tooth.tissues),
                               fits_of(make_cube(2.0, "dentin", 0.1).octree, tooth.tissues)};
  std::vector<RemovedLeaf> removed;
  removed.reserve(100000);
  for (int i = 0; i < 40; ++i) {
    const Ball ball{
        {random.uniform(-1.3, 1.3), random.uniform(-1.2, 1.2), random.uniform(-2.7, 0.3)},
        random.uniform(0.05, 0.3)};
    const double r = ball.radius_mm + 0.3;
    ASSERT_TRUE(tooth.octree.carve(ball.centre_mm - Vec3{r, r, r}, ball.centre_mm + Vec3{r, r, r},
                                   ball, removed, 0.002 * (i % 3)));
    const Bytes bytes = packed(tooth.octree, tooth.tissues), whole = canonical(tooth.octree);
    for (const auto& fits : known)
      ASSERT_EQ(unpacked(bytes, tooth.tissues, fits.get()), whole) << "round " << i;
    if (i % 8 == 0) known.push_back(fits_of(tooth.octree, tooth.tissues));
  }
}

// Labels and distances at odds with one another, as no tooth has them, altered in a few places.
TEST(PackedOctree, WhatIsKnownOfAnotherGridChangesNothing) {
  Random random(testing_tooth::drawn_seed("PackedOctree.WhatIsKnownOfAnotherGridChangesNothing"));
  const auto tissues = many_tissues();
  for (int round = 0; round < 20; ++round) {
    TissueGrid grid;
    grid.allocate({40, 36, 33}, 0.05, {});
    for (std::size_t i = 0; i < grid.count(); ++i) {
      grid.tissue[i] =
          static_cast<std::uint8_t>(random.below(40) == 0 ? random.below(6) : i / 9000);
      grid.distance[i] = static_cast<std::int8_t>(random.below(3) ? static_cast<int>(i % 251) - 125
                                                                  : k_distance_far);
    }
    const KnownFits fits = fits_of(Octree(grid, tissues), tissues);
    for (std::uint64_t n = random.below(30); n > 0; --n) {
      const std::size_t i = random.below(grid.count());
      if (n % 2 == 0) grid.tissue[i] = static_cast<std::uint8_t>(random.below(6));
      grid.distance[i] = static_cast<std::int8_t>(random.below(256));
    }
    const Octree altered(grid, tissues);
    ASSERT_EQ(unpacked(packed(altered, tissues), tissues, fits.get()), canonical(altered))
        << "round " << round;
  }
}

/// A ball of enamel around a ball of pulp: what the packing is made for.
Tooth round_tooth(double leaf_mm) {
  Tooth tooth;
  TissueGrid grid;
  const auto edge = static_cast<std::int32_t>(4.4 / leaf_mm);
  grid.allocate({edge, edge, edge}, leaf_mm, {-2.2, -2.2, -2.2});
  for (std::int32_t z = 0; z < edge; ++z)
    for (std::int32_t y = 0; y < edge; ++y)
      for (std::int32_t x = 0; x < edge; ++x) {
        const double r = length(grid.centre_mm({x, y, z}));
        grid.tissue[grid.index({x, y, z})] = r < 0.7 ? k_pulp : r < 2.0 ? k_enamel : k_air;
        grid.distance[grid.index({x, y, z})] =
            encode_distance(std::max(r - 2.0, 0.7 - r) / leaf_mm);
      }
  grid.make_consistent(tooth.tissues);
  tooth.octree = Octree(grid, tooth.tissues);
  return tooth;
}

// On a smooth surface a leaf's distance is known from those around it but for its rounding: less
// than 2 bits each.
TEST(PackedOctree, SmoothSurfacesTakeLessThanTwoBitsALeaf) {
  const Tooth tooth = round_tooth(0.05);
  const TissueGrid grid = tooth.octree.to_grid();
  const auto near = std::count_if(grid.distance.begin(), grid.distance.end(),
                                  [](std::int8_t d) { return std::abs(int{d}) < k_distance_far; });
  const std::size_t bytes = packed(tooth.octree, tooth.tissues).size();
  std::printf("%zu bytes for %td leaves near the surface\n", bytes, near);
  EXPECT_LT(8.0 * static_cast<double>(bytes), 2.0 * static_cast<double>(near));
  expect_round_trip(tooth.octree, tooth.tissues);
}

TEST(PackedOctree, EveryTruncationIsAnError) {
  const Tooth tooth = round_tooth(0.4);
  const Bytes bytes = packed(tooth.octree, tooth.tissues);
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    const Bytes cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n));
    ASSERT_THROW((void)unpacked(cut, tooth.tissues), Error) << n << " bytes";
  }
}

// No checksum of the file stands before this decoder here: whatever it is given, it ends in an
// error or in the same octree.
TEST(PackedOctree, DamagedBytesAreErrorsOrChangeNothing) {
  Random random(testing_tooth::drawn_seed("PackedOctree.DamagedBytesAreErrorsOrChangeNothing"));
  const Tooth tooth = round_tooth(0.2);
  const Bytes good = packed(tooth.octree, tooth.tissues), whole = canonical(tooth.octree);
  const KnownFits fits = fits_of(tooth.octree, tooth.tissues);
  constexpr std::size_t k_past_head =
      44;  // leaf, origin and size: any value of leaf and origin is one
  for (int i = 0; i < 1500; ++i) {
    Bytes bytes = good;
    for (std::uint64_t n = 1 + random.below(3); n > 0; --n) {
      const std::size_t first = i % 4 == 0 ? 32 : k_past_head, last = i % 2 ? 200 : bytes.size();
      bytes[first + random.below(last - first)] = static_cast<std::uint8_t>(random.below(256));
    }
    if (i % 5 == 0) bytes.resize(k_past_head + random.below(bytes.size() - k_past_head));
    try {
      ASSERT_EQ(unpacked(bytes, tooth.tissues, i % 3 == 0 ? fits.get() : nullptr), whole)
          << "round " << i;
    } catch (const Error&) {
    }
  }
}

TEST(PackedOctree, BytesOfNoOctreeAtAllAreErrors) {
  Random random(testing_tooth::drawn_seed("PackedOctree.BytesOfNoOctreeAtAllAreErrors"));
  const auto tissues = standard_tissues();
  for (int i = 0; i < 300; ++i) {
    ByteWriter bytes;
    for (int k = 0; k < 4; ++k) bytes.put(random.normal());
    for (int k = 0; k < 3; ++k)
      bytes.put(static_cast<std::int32_t>(1 + random.below(i % 10 == 0 ? 1024 : 60)));
    bytes.put(static_cast<std::uint32_t>(random.below(i % 2 ? 1u << 24 : 2000)));
    bytes.put(static_cast<std::uint32_t>(random.below(1000)));
    const std::uint64_t size = random.below(3000);
    bytes.put(size);
    const auto fill = static_cast<std::uint8_t>(random.below(2) * 255);
    for (std::uint64_t k = 0; k < size + 8; ++k)
      bytes.put(static_cast<std::uint8_t>(i % 4 ? random.below(256) : fill));
    ASSERT_THROW((void)unpacked(bytes.bytes(), tissues), Error) << "round " << i;
  }
}

}  // namespace
}  // namespace cavum
