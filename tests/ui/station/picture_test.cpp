// What the station's picture is made of, without a window: thinned patches that stay closed, light
// and tissues of a place, closed instruments, and effects that follow what pictures take.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "engine/base/random.h"
#include "engine/tooth/make/make_block.h"
#include "engine/tooth/make/make_molar.h"
#include "engine/tooth/octree_edit.h"
#include "tests/engine/support/basics.h"
#include "tests/engine/support/engine_testing.h"
#include "tests/engine/tooth/tooth_testing.h"
#include "ui/station/effects.h"
#include "ui/station/instrument_mesh.h"
#include "ui/station/thinned_patch.h"
#include "ui/station/tooth_shading.h"

namespace cavum::station {
namespace {

/// Triangles whose corners are known by their place alone.
class Pile {
 public:
  void add(const std::array<std::array<float, 3>, 3>& corners) {
    std::array<int, 3> n{};
    for (std::size_t i = 0; i < 3; ++i)
      n[i] = number_.emplace(corners[i], static_cast<int>(number_.size())).first->second;
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = n[i], b = n[(i + 1) % 3];
      if (a < b) ++edge_[{a, b}];
      if (a > b) --edge_[{b, a}];
    }
    ++triangles_;
    for (std::size_t i = 0; i < 3; ++i)
      six_volume_ += corners[0][i] * (corners[1][(i + 1) % 3] * corners[2][(i + 2) % 3] -
                                      corners[1][(i + 2) % 3] * corners[2][(i + 1) % 3]);
  }
  /// As many triangles along an edge one way as the other.
  [[nodiscard]] bool closed() const {
    return std::all_of(edge_.begin(), edge_.end(), [](const auto& e) { return e.second == 0; });
  }
  [[nodiscard]] std::size_t triangles() const { return triangles_; }
  [[nodiscard]] double volume() const { return six_volume_ / 6.0; }

 private:
  std::map<std::array<float, 3>, int> number_;
  std::map<std::pair<int, int>, int> edge_;
  std::size_t triangles_ = 0;
  double six_volume_ = 0;
};

TEST(ThinnedPatches, AreClosedTogetherWhateverTheirCells) {
  Random random(testing_basics::drawn_seed("ThinnedPatches.AreClosedTogetherWhateverTheirCells"));
  MolarShape shape;
  shape.leaf_mm = 0.15;
  Tooth tooth = make_molar(shape);
  tooth.octree.reserve_edits(20000);
  std::vector<RemovedLeaf> removed;
  removed.reserve(1 << 16);
  const testing_tooth::Ball cut{{0.4, -0.3, 0.0}, 1.2};
  const Vec3 reach{2, 2, 2};
  ASSERT_TRUE(tooth.octree.carve(cut.centre_mm - reach, cut.centre_mm + reach, cut, removed));
  const LeafBlocks leaves(tooth.octree);
  for (const std::uint8_t own :
       {SurfacePatches::k_hard_tissue, static_cast<std::uint8_t>(k_pulp)}) {
    const SurfacePatches surface(leaves, own);
    const IVec3 size = surface.size();
    for (const std::vector<int>& drawn :
         {std::vector<int>{1, 2, 2, 2}, {1, 4, 4, 4}, {1, 2, 4, 4}, {1, 2, 4, 8}}) {
      std::vector<int> cells(surface.count());
      for (int& c : cells) c = drawn[random.below(drawn.size())];
      Pile thin, all;
      for (std::size_t i = 0; i < surface.count(); ++i) {
        const auto n = static_cast<int>(i);
        PatchPosition place{{n % size.x, n / size.x % size.y, n / size.x / size.y},
                            leaves.leaf_mm(),
                            leaves.origin_mm(),
                            {}};
        for (int dz = -1; dz <= 1; ++dz)
          for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx) {
              const IVec3 p = place.number + IVec3{dx, dy, dz};
              const bool there = lies_in(p, size);
              if (there)
                place.cells[PatchPosition::beside(dx, dy, dz)] =
                    cells[static_cast<std::size_t>((p.z * size.y + p.y) * size.x + p.x)];
            }
        const SurfacePatch made = thinned(surface.patch(i), place);
        for (const auto& t : made.triangles)
          thin.add({made.vertices[t[0]].position_mm, made.vertices[t[1]].position_mm,
                    made.vertices[t[2]].position_mm});
        const SurfacePatch& before = surface.patch(i);
        for (const auto& t : before.triangles)
          all.add({before.vertices[t[0]].position_mm, before.vertices[t[1]].position_mm,
                   before.vertices[t[2]].position_mm});
      }
      ASSERT_TRUE(all.closed());
      const int coarsest = drawn.back();
      EXPECT_TRUE(thin.closed()) << "tissue " << int{own} << ", cells of up to " << coarsest;
      EXPECT_LT(thin.triangles(), all.triangles() * 3 / 4);
      EXPECT_NEAR(thin.volume(), all.volume(),
                  0.02 * coarsest * all.volume());  // chords lie inside what bulges
    }
  }
}

TEST(ThinnedPatches, RefuseCellsThatDoNotFit) {
  PatchPosition place;
  EXPECT_THROW(static_cast<void>(thinned({}, place)), Error);  // none of its own
  place.cells.fill(3);
  EXPECT_THROW(static_cast<void>(thinned({}, place)), Error);
}

TEST(ToothShading, LittleLightReachesTheFloorOfADeepHole) {
  Tooth tooth = make_block({6, 6, 5}, {{"enamel", 1.5}, {"dentin", 3.5}}, 0.05);
  tooth.octree.reserve_edits(40000);
  ToothShading shading{LeafBlocks(tooth.octree)};
  const float flat = shading.open({0, 0, 0}, {0, 0, 1});
  EXPECT_GT(flat, 0.9F);
  std::vector<RemovedLeaf> removed;
  removed.reserve(1 << 18);
  LeafBlocks leaves(tooth.octree);
  float before = flat;
  for (const double deep_mm : {0.5, 1.0, 2.0}) {
    const auto hole = [deep_mm](Vec3 mm) {
      return std::max(std::hypot(mm.x, mm.y) - 0.7, -deep_mm - mm.z);
    };
    ASSERT_TRUE(tooth.octree.carve({-1, -1, -2.5}, {1, 1, 0.5}, hole, removed));
    std::vector<LeafBounds> changed;
    leaves.take(tooth.octree, changed);
    shading.update(leaves, changed);
    const float open = shading.open({0, 0, static_cast<float>(-deep_mm)}, {0, 0, 1});
    std::printf("open on the floor %.1f mm deep: %.2f\n", deep_mm, static_cast<double>(open));
    EXPECT_LT(open, before - 0.05F);
    before = open;
    // as if it had been made anew
    EXPECT_FLOAT_EQ(open,
                    ToothShading{leaves}.open({0, 0, static_cast<float>(-deep_mm)}, {0, 0, 1}));
  }
  EXPECT_LT(before, 0.45F);
}

// The line between enamel and dentin runs at an angle to the leaves; where the shares are equal
// must not follow their steps.
TEST(ToothShading, TheBorderOfEnamelAndDentinRunsSmoothly) {
  TissueGrid grid;
  constexpr double k_leaf_of_slope_mm = 0.05, k_slope = 0.23;
  grid.allocate({60, 60, 40}, k_leaf_of_slope_mm, {-1.5, -1.5, -2.0});
  const auto border_mm = [](double x) { return -1.0 + k_slope * x; };
  for (int z = 0; z < 40; ++z)
    for (int y = 0; y < 60; ++y)
      for (int x = 0; x < 60; ++x) {
        const Vec3 mm = grid.centre_mm({x, y, z});
        const double outside_mm =
            std::max({std::fabs(mm.x) - 1.2, std::fabs(mm.y) - 1.2, mm.z + 0.2, -1.8 - mm.z});
        const bool in = outside_mm < 0;
        grid.distance[grid.index({x, y, z})] = encode_distance(outside_mm / k_leaf_of_slope_mm);
        grid.tissue[grid.index({x, y, z})] = !in                      ? k_air
                                             : mm.z > border_mm(mm.x) ? k_enamel
                                                                      : k_dentin;
      }
  const Octree tree(grid, standard_tissues());
  const LeafBlocks leaves(tree);
  const ToothShading shading(leaves);
  const SurfacePatches surface(leaves);
  const IVec3 size = surface.size();
  double worst_mm = 0;
  int looked_at = 0;
  for (std::size_t i = 0; i < surface.count(); ++i) {
    const auto n = static_cast<int>(i);
    const auto shaded = shading.shaded(
        leaves, surface.patch(i), {n % size.x, n / size.x % size.y, n / size.x / size.y}, k_air);
    const auto dentin = [&](std::size_t v) {
      const auto& t = shaded[v].tissue;
      return (t[0] == k_dentin ? 255 - t[2] : 0) + (t[1] == k_dentin && t[0] != t[1] ? t[2] : 0);
    };
    for (const auto& t : surface.patch(i).triangles)
      for (std::size_t e = 0; e < 3; ++e) {
        const std::size_t a = t[e], b = t[(e + 1) % 3];
        const auto &p = shaded[a].at_mm, &q = shaded[b].at_mm;
        if (p[1] < 1.15F || q[1] < 1.15F || std::fabs(p[0]) > 0.9F)
          continue;  // one side of the block
        const double da = dentin(a) - 127.5, db = dentin(b) - 127.5;
        if (da * db >= 0) continue;
        const double f = da / (da - db), x = p[0] + f * (q[0] - p[0]), z = p[2] + f * (q[2] - p[2]);
        worst_mm = std::max(worst_mm, std::fabs(z - border_mm(x)));
        ++looked_at;
      }
  }
  std::printf("the border is off by %.3f mm at most, at %d places\n", worst_mm, looked_at);
  EXPECT_GT(looked_at, 50);
  EXPECT_LT(worst_mm, 0.5 * k_leaf_of_slope_mm);  // steps of labels: up to a leaf
}

TEST(InstrumentMesh, AllItsBodiesAreClosedAndFaceOutwards) {
  const auto check = [](const MeshData& mesh, const std::string& name) {
    Pile pile;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
      pile.add({mesh.vertices[mesh.indices[i]].at_mm, mesh.vertices[mesh.indices[i + 1]].at_mm,
                mesh.vertices[mesh.indices[i + 2]].at_mm});
    EXPECT_TRUE(pile.closed()) << name;
    EXPECT_GT(pile.volume(), 0.0) << name;
  };
  for (const std::string& name : testing_engine::bur_names()) {
    const Bur bur = testing_engine::shipped_bur(name);
    check(diamond_head_mesh(bur), name);
    check(shank_mesh(bur), name + ", shank");
  }
  check(handpiece_mesh(), "handpiece");
}

TEST(EffectGovernor, SettlesOnTheRichestLevelThatTheComputerKeepsUpWith) {
  // what a picture of each level takes, ms, by budget 60
  const std::vector<std::pair<std::array<double, 6>, std::size_t>> computers{
      {{400, 200, 150, 90, 50, 30}, 4},
      {{400, 300, 250, 200, 150, 100}, 5},
      {{20, 15, 12, 10, 8, 6}, 0},
      {{200, 100, 50, 20, 10, 8}, 2}};
  for (const auto& [ms, settled] : computers) {
    EffectGovernor governor(60.0, 3);
    for (int i = 0; i < 20000; ++i) governor.took(ms[governor.level()]);
    int elsewhere = 0;
    for (int i = 0; i < 5000; ++i) {
      governor.took(ms[governor.level()]);
      elsewhere += governor.level() != settled ? 1 : 0;
    }
    EXPECT_LT(elsewhere, 100) << settled;
  }
}

TEST(EffectGovernor, ASinglePictureThatTakesLongChangesNothing) {
  EffectGovernor governor(60.0, 3);
  for (int i = 0; i < 50; ++i) governor.took(i % 10 == 9 ? 500.0 : 40.0);
  EXPECT_EQ(governor.level(), 3u);
}

}  // namespace
}  // namespace cavum::station
