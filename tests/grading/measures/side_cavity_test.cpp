// Marks of a cavity in the side of a round tooth, cut wrongly by known amounts: depth, outline and
// walls as seen from the side.
#include <gtest/gtest.h>

#include "grading/result/loss.h"
#include "scenarios/zones/placed.h"
#include "tests/grading/carved.h"
#include "tests/scenarios/test_crowns.h"

namespace cavum::grading {
namespace {

constexpr double k_side_radius_mm = 4, k_side_neck_mm = -5, k_side_leaf_mm = 0.05;

/// A cavity 4 mm wide and 2 mm high, 1 mm above the neck, its axial wall at radius 2.8; cut with
/// the axial wall at `radius_mm`, the mesial wall at x = `mesial_mm` and the gingival one at z =
/// `gingival_mm`.
Result cut_from_side(double radius_mm, double mesial_mm, double gingival_mm, int side = 1) {
  const scenarios::Scenario scenario = scenarios::parse_scenario(
      testing::scenario_text(
          std::string("[[zones.target]]\nshape = \"side_cavity\"\nside = \"") +
          (side > 0 ? "buccal" : "lingual") +
          "\"\ndepth_mm = 1.2\noutline = { kind = \"polygon\", points_mm = [[-2, 1], [2, 1], [2, 3], [-2, 3]] }\n"),
      "s.toml");
  const Tooth tooth = testing::round_tooth(k_side_radius_mm, -6, k_side_leaf_mm);
  const scenarios::ZoneMap zones = scenarios::build_zones(
      scenario, tooth, testing::round_landmarks(k_side_radius_mm, k_side_neck_mm));
  Octree after = tooth.octree;
  after.reserve_edits(60000);
  std::vector<RemovedLeaf> leaves;
  leaves.reserve(1000000);
  EXPECT_TRUE(after.carve(
      {-5, -5, -6}, {5, 5, 1},
      [=](Vec3 p) {
        const double y = p.y * side;
        const double across = std::max({p.x - mesial_mm, -2 - p.x, gingival_mm - p.z, p.z + 2}),
                     in = radius_mm - std::sqrt(p.x * p.x + y * y);
        return std::max({across, in, -y});
      },
      leaves));
  std::vector<RemovedAt> removed;
  for (const auto& l : leaves) removed.push_back({0, l});
  std::vector<TickInput> inputs(1);
  std::vector<TickRecord> records(1);
  records[0].removed = static_cast<std::uint32_t>(leaves.size());
  return grade({scenario, tooth, zones, after, inputs, records, removed, {}}, scenario.rubric);
}

const WallMeasures& wall(const Result& r, scenarios::Wall w) {
  return r.shape.wall[static_cast<std::size_t>(w)];
}

TEST(SideCavityMarks, ExactlyTheTargetIsExact) {
  const Result r = cut_from_side(2.8, 2, -4);
  EXPECT_GT(r.volumes.target_removed_percent, 99.0);
  EXPECT_NEAR(wall(r, scenarios::Wall::floor).mean_mm, 0, 0.02);
  EXPECT_NEAR(*r.shape.length_error_mm, 0, 0.06);
  EXPECT_NEAR(*r.shape.width_error_mm, 0, 0.06);
  // from the mean of the surface over the cavity (mean of sqrt(16 - x²) for |x| < 2) to the axial
  // wall's deepest place, at its mesial and distal ends
  const double opening = 3.8264, deepest = std::sqrt(2.8 * 2.8 - 4);
  EXPECT_NEAR(*r.shape.depth_mm, opening - deepest, 2 * k_side_leaf_mm);
  EXPECT_NEAR(r.shape.target_depth_mm, opening - deepest, 2 * k_side_leaf_mm);
}

TEST(SideCavityMarks, TooDeepAndTooWideAreFoundAtTheirWalls) {
  for (const int side : {1, -1}) {
    const Result r = cut_from_side(2.5, 2.2, -4.15, side);
    EXPECT_NEAR(wall(r, scenarios::Wall::floor).mean_mm, 0.3, 0.03) << side;
    // at its edge with the axial wall, 0.3 mm too deep, it lies as far off as both together; which
    // wall the edge's leaves count to is open
    EXPECT_GE(wall(r, scenarios::Wall::mesial).max_over_mm, 0.2 - k_side_leaf_mm) << side;
    EXPECT_LE(wall(r, scenarios::Wall::mesial).max_over_mm, std::hypot(0.2, 0.3) + k_side_leaf_mm)
        << side;
    EXPECT_NEAR(wall(r, scenarios::Wall::mesial).mean_mm, 0.2, 0.05) << side;
    EXPECT_NEAR(wall(r, scenarios::Wall::distal).mean_mm, 0.0, 0.05) << side;
    EXPECT_NEAR(wall(r, scenarios::Wall::lingual).mean_mm, 0.15, 0.05)
        << side;  // towards the gingiva
    EXPECT_NEAR(wall(r, scenarios::Wall::buccal).mean_mm, 0.0, 0.05) << side;
    EXPECT_NEAR(*r.shape.length_mm, 4.2, 0.06) << side;
    EXPECT_NEAR(*r.shape.width_mm, 2.15, 0.06) << side;
    EXPECT_NEAR(*r.shape.length_error_mm, 0.2, 0.06) << side;
    EXPECT_NEAR(*r.shape.depth_mm - r.shape.target_depth_mm,
                std::sqrt(2.8 * 2.8 - 4) - std::sqrt(2.5 * 2.5 - 2.2 * 2.2), 3 * k_side_leaf_mm)
        << side;
    EXPECT_GT(r.volumes.zone[static_cast<std::size_t>(scenarios::Zone::leeway_bottom)].removed.mm3,
              0.5)
        << side;
    EXPECT_TRUE(r.shape.facing.lateral()) << "its lingual wall is the gingival one";
  }
}

TEST(SideCavityMarks, UprightWallsHaveNoTaper) {
  const Result r = cut_from_side(2.8, 2, -4);
  EXPECT_NEAR(*r.shape.taper_deg, 0, r.shape.taper_bound_deg);
  EXPECT_LT(r.shape.taper_bound_deg, 6);
}

}  // namespace
}  // namespace cavum::grading
