#include "engine/tooth/surface_patches.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>

#include "engine/base/error.h"
#include "engine/base/random.h"
#include "engine/physics/cutting/carve_head.h"
#include "engine/tooth/distance.h"
#include "engine/tooth/make/make_block.h"
#include "engine/tooth/make/make_molar.h"
#include "engine/tooth/octree_edit.h"
#include "tests/engine/support/engine_testing.h"
#include "tests/engine/tooth/tooth_testing.h"

namespace cavum {
namespace {

using testing_tooth::Ball;

constexpr double k_pi = 3.14159265358979;

/// All patches as one mesh, in which vertices are one when all bits of their positions are equal.
TriangleMesh merged(const SurfacePatches& patches) {
  TriangleMesh mesh;
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> known;
  for (std::size_t p = 0; p < patches.count(); ++p) {
    std::vector<std::uint32_t> number;
    for (const PatchVertex& v : patches.patch(p).vertices) {
      std::array<std::uint32_t, 3> bits;
      std::memcpy(bits.data(), v.position_mm.data(), sizeof bits);
      const auto [at, fresh] =
          known.emplace(bits, static_cast<std::uint32_t>(mesh.vertices_mm.size()));
      if (fresh) mesh.vertices_mm.push_back({v.position_mm[0], v.position_mm[1], v.position_mm[2]});
      number.push_back(at->second);
    }
    for (const auto& t : patches.patch(p).triangles)
      mesh.triangles.push_back({number.at(t[0]), number.at(t[1]), number.at(t[2])});
  }
  return mesh;
}

double area_mm2(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const auto& t : mesh.triangles)
    sum += 0.5 * length(cross(mesh.vertices_mm[t[1]] - mesh.vertices_mm[t[0]],
                              mesh.vertices_mm[t[2]] - mesh.vertices_mm[t[0]]));
  return sum;
}

/// Every vertex that patches share has the same normal and tissues in all of them.
bool borders_agree(const SurfacePatches& patches) {
  std::map<std::array<float, 3>, PatchVertex> known;
  for (std::size_t p = 0; p < patches.count(); ++p)
    for (const PatchVertex& v : patches.patch(p).vertices)
      if (!(known.emplace(v.position_mm, v).first->second == v)) return false;
  return true;
}

bool equal(const SurfacePatches& a, const SurfacePatches& b) {
  if (a.count() != b.count()) return false;
  for (std::size_t p = 0; p < a.count(); ++p)
    if (!(a.patch(p) == b.patch(p))) return false;
  return true;
}

std::vector<SurfacePatch> copy_of(const SurfacePatches& patches) {
  std::vector<SurfacePatch> all;
  for (std::size_t p = 0; p < patches.count(); ++p) all.push_back(patches.patch(p));
  return all;
}

std::size_t cut(Octree& tree, const Ball& ball) {
  std::vector<RemovedLeaf> removed;
  removed.reserve(1 << 17);
  const double r = ball.radius_mm + 3 * tree.leaf_mm();
  EXPECT_TRUE(
      tree.carve(ball.centre_mm - Vec3{r, r, r}, ball.centre_mm + Vec3{r, r, r}, ball, removed));
  return removed.size();
}

/// A ball of dentin with its exact distances.
Tooth ball_of_dentin(double radius_mm) {
  Tooth tooth;
  TissueGrid grid;
  grid.allocate({60, 60, 60}, 0.05, {-1.5, -1.5, -1.5});
  std::vector<float> field(grid.count());
  for (std::int32_t z = 0; z < 60; ++z)
    for (std::int32_t y = 0; y < 60; ++y)
      for (std::int32_t x = 0; x < 60; ++x) {
        const auto i = grid.index({x, y, z});
        field[i] = static_cast<float>(length(grid.centre_mm({x, y, z})) - radius_mm);
        if (field[i] < 0) grid.tissue[i] = k_dentin;
      }
  set_surface_from_field(grid, tooth.tissues, field);
  tooth.octree = Octree(grid, tooth.tissues);
  tooth.octree.reserve_edits(4000);
  return tooth;
}

// Random leaves have every awkward contact there is: edges, corners, holes; and they touch the
// border of the tooth's box and of the patches.
TEST(SurfacePatches, AreClosedWhateverTheLeavesHold) {
  Random random(testing_tooth::drawn_seed("SurfacePatches.AreClosedWhateverTheLeavesHold"));
  for (const IVec3 size :
       {IVec3{14, 13, 12}, IVec3{16, 33, 15}, IVec3{31, 17, 32}, IVec3{1, 1, 1}}) {
    Tooth tooth;
    TissueGrid grid;
    grid.allocate(size, 0.1, {-0.7, 20.0, -9.1});
    for (auto& t : grid.tissue) t = static_cast<std::uint8_t>(random.below(5));
    grid.tissue[0] = k_enamel;
    for (auto& d : grid.distance)
      d = static_cast<std::int8_t>(static_cast<int>(random.below(255)) - 127);
    grid.make_consistent(tooth.tissues);
    tooth.octree = Octree(grid, tooth.tissues);
    const LeafBlocks leaves(tooth.octree);
    for (std::uint8_t tissue = 0; tissue <= k_periodontium; ++tissue) {
      const SurfacePatches patches(leaves, tissue);
      if (patches.triangle_count() == 0) {
        EXPECT_EQ(size.x, 1);
        continue;
      }
      const TriangleMesh mesh = merged(patches);
      ASSERT_TRUE(testing_tooth::is_closed_and_oriented(mesh)) << int{tissue};
      ASSERT_TRUE(borders_agree(patches)) << int{tissue};
      EXPECT_GT(signed_volume_mm3(mesh), 0);
      for (const Vec3 v : mesh.vertices_mm) ASSERT_TRUE(is_finite(v));
    }
  }
}

TEST(SurfacePatches, ABallHasItsRadiusNormalsAndVolume) {
  const double radius = 1.013;
  const Tooth tooth = ball_of_dentin(radius);
  const SurfacePatches patches{LeafBlocks(tooth.octree)};
  double worst_cosine = 1.0;
  for (std::size_t p = 0; p < patches.count(); ++p)
    for (const PatchVertex& v : patches.patch(p).vertices) {
      const Vec3 at{v.position_mm[0], v.position_mm[1], v.position_mm[2]},
          normal = Vec3{double(v.normal[0]), double(v.normal[1]), double(v.normal[2])} / 32767.0;
      ASSERT_NEAR(length(at), radius, 0.0025);
      ASSERT_NEAR(length(normal), 1.0, 1e-4);
      worst_cosine = std::min(worst_cosine, dot(normalized(at), normalized(normal)));
      ASSERT_EQ(v.tissue, k_dentin);
      ASSERT_EQ(v.beside, k_air);
    }
  EXPECT_GT(worst_cosine, std::cos(2.0 * k_pi / 180.0));
  std::printf("normals of a ball of %.3f mm: within %.2f degrees\n", radius,
              std::acos(worst_cosine) * 180.0 / k_pi);
  EXPECT_NEAR(signed_volume_mm3(merged(patches)), 4.0 / 3.0 * k_pi * radius * radius * radius,
              0.01);
}

TEST(SurfacePatches, ACutBallIsMissedByItsVolume) {
  Tooth tooth = make_cube(3, "enamel", 0.05);
  tooth.octree.reserve_edits(4000);
  LeafBlocks leaves(tooth.octree);
  SurfacePatches patches(leaves);
  const double chamfers_mm3 =
      36.0 * 0.5 * 0.025 *
      0.025;  // 36 mm of edges, cut off between the outermost centres and the faces
  EXPECT_NEAR(signed_volume_mm3(merged(patches)), 27.0 - chamfers_mm3, 2e-4);
  const double radius = 0.43;
  EXPECT_GT(cut(tooth.octree, {{0.01, 0.02, -1.53}, radius}), 0u);
  std::vector<LeafBounds> changed;
  std::vector<std::uint32_t> touched;
  const double before = signed_volume_mm3(merged(patches));
  leaves.take(tooth.octree, changed);
  patches.update(leaves, changed, touched);
  EXPECT_NEAR(before - signed_volume_mm3(merged(patches)),
              4.0 / 3.0 * k_pi * radius * radius * radius, 0.005);
}

// A head wanders through the molar, down into the pulp and out again, and every step is looked at.
TEST(SurfacePatches, StayClosedAndEqualToAFreshBuildThroughARandomDrilling) {
  Random random(testing_tooth::drawn_seed(
      "SurfacePatches.StayClosedAndEqualToAFreshBuildThroughARandomDrilling"));
  MolarShape shape;
  shape.leaf_mm = 0.2;
  Tooth tooth = make_molar(shape);
  Octree& tree = tooth.octree;
  tree.reserve_edits(20000);
  const auto names = testing_engine::bur_names();
  LeafBlocks leaves(tree);
  constexpr std::array<std::uint8_t, 4> k_tissues{SurfacePatches::k_hard_tissue, k_enamel, k_dentin,
                                                  k_pulp};
  std::vector<SurfacePatches> surfaces;
  for (const auto t : k_tissues) surfaces.emplace_back(leaves, t);
  std::vector<RemovedLeaf> removed;
  removed.reserve(1 << 17);
  HeadCarving carving;
  Bur bur = testing_engine::shipped_bur(names[random.below(names.size())]);
  Vec3 tip{random.uniform(-2, 2), random.uniform(-2, 2), 0.0};
  Mat3 turned = rotation(Quat{1, 0, 0, 0});
  std::size_t all_removed = 0, without_removed = 0;
  bool wall_of_pulp = false;
  for (int step = 0; step < 40; ++step) {
    if (step % 8 == 7) {
      bur = testing_engine::shipped_bur(names[random.below(names.size())]);
      tip = {random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-4, 1)};
      turned =
          rotation(normalized(Quat{1, random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), 0}));
      carving = {};
    }
    tip += Vec3{random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), random.uniform(-0.5, 0.05)};
    removed.clear();
    begin_carving(carving, {tip, turned, 0});
    ASSERT_EQ(go_on_carving(carving, tree, bur, k_at_once, removed), CarvingStep::done);
    all_removed += removed.size();

    std::vector<LeafBounds> changed;
    leaves.take(tree, changed);
    without_removed += removed.empty() && !changed.empty();
    const LeafBlocks fresh_leaves(tree);
    const auto count = tree.count_leaves();
    for (std::size_t s = 0; s < surfaces.size(); ++s) {
      const auto before = copy_of(surfaces[s]);
      std::vector<std::uint32_t> touched, differ;
      surfaces[s].update(leaves, changed, touched);
      for (std::uint32_t p = 0; p < before.size(); ++p)
        if (!(before[p] == surfaces[s].patch(p))) differ.push_back(p);
      ASSERT_EQ(touched, differ) << "step " << step;
      ASSERT_TRUE(equal(surfaces[s], SurfacePatches(fresh_leaves, k_tissues[s])))
          << "step " << step;
      const TriangleMesh mesh = merged(surfaces[s]);
      ASSERT_TRUE(testing_tooth::is_closed_and_oriented(mesh))
          << "step " << step << ", tissue " << int{k_tissues[s]};
      const auto leaves_inside = s == 0 ? count[k_enamel] + count[k_dentin] : count[k_tissues[s]];
      // half a leaf on the border is what counting leaves can be off by; it is nowhere near it
      ASSERT_NEAR(signed_volume_mm3(mesh),
                  static_cast<double>(leaves_inside) * tree.leaf_volume_mm3(),
                  0.1 * area_mm2(mesh) * tree.leaf_mm());
    }
  }
  for (std::size_t p = 0; p < surfaces[0].count(); ++p)
    for (const PatchVertex& v : surfaces[0].patch(p).vertices)
      wall_of_pulp = wall_of_pulp || v.beside == k_pulp;
  EXPECT_TRUE(wall_of_pulp);
  std::printf("%zu leaves removed; %zu steps changed distances alone\n", all_removed,
              without_removed);
  EXPECT_GT(all_removed, 100u);
}

TEST(SurfacePatches, OnlyTouchWhatTheCutChanged) {
  MolarShape shape;
  shape.leaf_mm = 0.15;
  Tooth tooth = make_molar(shape);
  Octree& tree = tooth.octree;
  tree.reserve_edits(20000);
  LeafBlocks leaves(tree);
  SurfacePatches patches(leaves);
  std::vector<LeafBounds> changed;
  std::vector<std::uint32_t> touched;
  cut(tree, {{30, 0, 0}, 0.5});  // in the air
  leaves.take(tree, changed);
  EXPECT_TRUE(changed.empty());

  const Vec3 at{0.3, 0.2, 0.0};
  const std::size_t first = cut(tree, {at, 0.6});
  leaves.take(tree, changed);
  ASSERT_FALSE(changed.empty());
  const double reach = 0.6 + 4 * tree.leaf_mm();
  for (const LeafBounds& box : changed) {
    const Vec3 low = tree.centre_mm(box.low), high = tree.centre_mm(box.high);
    EXPECT_TRUE(low.x > at.x - reach && low.y > at.y - reach && low.z > at.z - reach);
    EXPECT_TRUE(high.x < at.x + reach && high.y < at.y + reach && high.z < at.z + reach);
  }
  patches.update(leaves, changed, touched);
  ASSERT_FALSE(touched.empty());
  EXPECT_LE(touched.size(), 8u);  // twenty leaves across lie in two patches along an axis
  EXPECT_GT(first, 0u);

  // The same again changes nothing.
  changed.clear();
  touched.clear();
  leaves.take(tree, changed);
  patches.update(leaves, changed, touched);
  EXPECT_TRUE(changed.empty());
  EXPECT_TRUE(touched.empty());
}

TEST(SurfacePatches, SeeDistancesThatChangeWithoutALeafRemoved) {
  Tooth tooth = make_cube(2, "dentin", 0.1);
  Octree& tree = tooth.octree;
  tree.reserve_edits(4000);
  LeafBlocks leaves(tree);
  SurfacePatches patches(leaves);
  // its lowest point is a quarter of a leaf deep, and no leaf's centre lies in it
  ASSERT_EQ(cut(tree, {{0.05, 0.05, 0.475}, 0.5}), 0u);
  std::vector<LeafBounds> changed;
  std::vector<std::uint32_t> touched;
  leaves.take(tree, changed);
  patches.update(leaves, changed, touched);
  EXPECT_FALSE(touched.empty());
  EXPECT_TRUE(equal(patches, SurfacePatches(LeafBlocks(tree))));
}

TEST(SurfacePatches, GoBackToAnEarlierMoment) {
  Tooth tooth = ball_of_dentin(1.2);
  const Octree whole = tooth.octree;
  LeafBlocks leaves(whole);
  SurfacePatches patches(leaves);
  const auto before = copy_of(patches);
  cut(tooth.octree, {{1.0, 0.1, 0.2}, 0.4});
  std::vector<LeafBounds> changed;
  std::vector<std::uint32_t> there, back;
  leaves.take(tooth.octree, changed);
  patches.update(leaves, changed, there);
  EXPECT_NE(copy_of(patches), before);
  changed.clear();
  leaves.take(whole, changed);
  patches.update(leaves, changed, back);
  EXPECT_EQ(copy_of(patches), before);
  EXPECT_EQ(there, back);
}

TEST(SurfacePatches, TellTissuesApartWhereTheyMeet) {
  const double enamel_mm = 0.83;
  const Tooth tooth =
      make_block({3, 3, 2}, {{"enamel", enamel_mm}, {"dentin", 2 - enamel_mm}}, 0.05);
  const LeafBlocks leaves(tooth.octree);
  const SurfacePatches hard(leaves), dentin(leaves, k_dentin);
  for (std::size_t p = 0; p < hard.count(); ++p)
    for (const PatchVertex& v : hard.patch(p).vertices) {
      if (std::fabs(v.position_mm[2] + enamel_mm) > 0.05) {
        ASSERT_EQ(v.tissue, v.position_mm[2] > -enamel_mm ? k_enamel : k_dentin);
      }
      ASSERT_EQ(v.beside, k_air);
    }
  int inner = 0;
  for (std::size_t p = 0; p < dentin.count(); ++p)
    for (const PatchVertex& v : dentin.patch(p).vertices)
      if (v.beside == k_enamel && std::fabs(v.position_mm[0]) < 1.3 &&
          std::fabs(v.position_mm[1]) < 1.3) {
        ASSERT_NEAR(v.position_mm[2], -enamel_mm, 0.026);  // labels know it to half a leaf
        ASSERT_GT(v.normal[2], 32700);
        ++inner;
      }
  EXPECT_GT(inner, 2000);
}

TEST(LeafBlocks, HoldEveryLeafAfterRandomCuts) {
  Random random(testing_tooth::drawn_seed("LeafBlocks.HoldEveryLeafAfterRandomCuts"));
  Tooth tooth = make_block({2.13, 1.9, 2.4},
                           {{"enamel", 0.7}, {"dentin", 0.8}, {"pulp", 0.5}, {"lesion", 0.4}}, 0.1);
  Octree& tree = tooth.octree;
  tree.reserve_edits(20000);
  LeafBlocks leaves(tree);
  std::vector<LeafBounds> changed;
  for (int i = 0; i < 20; ++i) {
    cut(tree, {{random.uniform(-1.3, 1.3), random.uniform(-1.2, 1.2), random.uniform(-2.7, 0.3)},
               random.uniform(0.05, 0.6)});
    if (random.below(2)) leaves.take(tree, changed);
  }
  leaves.take(tree, changed);
  constexpr int k_cube = 40;
  std::vector<std::uint8_t> tissue(std::size_t{k_cube} * k_cube * k_cube);
  std::vector<std::int8_t> code(tissue.size());
  const IVec3 low{-5, -3, -7};
  leaves.copy_cube(low, k_cube, tissue.data(), code.data());
  std::size_t i = 0;
  for (int z = 0; z < k_cube; ++z)
    for (int y = 0; y < k_cube; ++y)
      for (int x = 0; x < k_cube; ++x, ++i) {
        ASSERT_EQ(tissue[i], tree.tissue(low + IVec3{x, y, z}));
        ASSERT_EQ(code[i], tree.distance_code(low + IVec3{x, y, z}));
      }
}

TEST(LeafBlocks, RefuseAnotherTooth) {
  LeafBlocks leaves(make_cube(1, "dentin", 0.1).octree);
  std::vector<LeafBounds> changed;
  EXPECT_THROW(leaves.take(make_cube(2, "dentin", 0.1).octree, changed), Error);
}

}  // namespace
}  // namespace cavum
