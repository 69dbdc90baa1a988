// The access to a front tooth: a tissue seen along a leaning way, and the target on the incisor
// that ships.
#include "scenarios/zones/leaning_column.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/base/error.h"
#include "engine/tooth/octree_edit.h"
#include "scenarios/zones/zone_map.h"
#include "tests/engine/support/basics.h"
#include "tests/scenarios/test_teeth.h"

namespace cavum::scenarios {
namespace {

using testing::make_tooth;
using testing::scenario_text;

ShapeFrame leaning(double cosine, double sine, Vec3 at) {
  return {at, {1, 0, 0}, {0, cosine, sine}, {0, -sine, cosine}};
}

TEST(ReliefAlong, ASlabIsAsThickAlongTheWayAsItsSlantSays) {
  // pulp between z = -3 and -2, 3 mm long and 8 mm wide, in dentin
  const Tooth tooth = make_tooth(
      {-3, -5, -5}, {3, 5, 0.5}, 0.1,
      [](Vec3 p) -> std::uint8_t {
        if (p.z > 0) return k_air;
        return p.z > -3 && p.z < -2 && std::fabs(p.x) < 1.5 && std::fabs(p.y) < 4 ? k_pulp
                                                                                  : k_dentin;
      },
      [](Vec3 p) { return p.z; });
  const double sine = 0.5, cosine = std::sqrt(0.75);
  const TissueRelief relief =
      relief_along(tooth, leaning(cosine, sine, {0, 0, -3}), "pulp", TissuePart::all, Name{"here"});
  for (const double x : {-1.2, 0.0, 1.2})
    for (const double y : {-1.5, 0.0, 1.5})
      EXPECT_NEAR(relief.roof_mm.at(x, y) - relief.floor_mm.at(x, y), 1 / cosine, 0.06)
          << x << " " << y;
  EXPECT_NEAR(relief.middle_mm.z, -2.5, 0.02);
  // the floor's plane z = -3 in the frame's lengths: -3 + sine y + cosine h = -3
  EXPECT_NEAR(relief.floor_mm.at(0, 1.0), -sine / cosine, 0.06);
  EXPECT_THROW(static_cast<void>(relief_along(tooth, leaning(cosine, sine, {0, 0, 0}), "pulp",
                                              TissuePart::chamber, Name{"here"})),
               Error);
}

TEST(LeaningColumn, OpensTheIncisorThatShipsFromLingual) {
  const Tooth tooth = load_tooth_file(testing_basics::data_path("teeth/upper_incisor.cvt"));
  const Landmarks landmarks = find_landmarks(tooth);
  const ZoneMap zones = build_zones(
      parse_scenario(
          scenario_text(
              "[[zones.target]]\nshape = \"column\"\nlean = \"lingual\"\n"
              "outline = { kind = \"projection\", tissue = \"pulp\", part = \"chamber\", offset_mm = 0.1, rounding_mm = 0.55 }\n"
              "bottom = { kind = \"tissue_floor\", tissue = \"pulp\", part = \"chamber\" }\n"),
          "s.toml"),
      tooth);
  const Vec3 way = zones.approach();
  EXPECT_NEAR(way.x, 0, 0.1);
  EXPECT_LT(way.y, -0.25);  // 15 to 45 degrees towards lingual
  EXPECT_GT(way.y, -0.71);
  ASSERT_FALSE(landmarks.canal_mouths.empty());
  const double mouth_z = landmarks.canal_mouths[0].at_mm.z;
  std::size_t pulp = 0, opened = 0;
  tooth.octree.for_each_cube([&](IVec3 at, int edge, std::uint8_t t) {
    if (t != k_pulp) return;
    for (int i = 0; i < edge * edge * edge; ++i) {
      const IVec3 leaf = at + IVec3{i % edge, i / edge % edge, i / (edge * edge)};
      if (tooth.octree.centre_mm(leaf).z < mouth_z + 0.1) continue;
      ++pulp;
      opened += zones.zone(leaf) == Zone::target ? 1 : 0;
    }
  });
  EXPECT_GT(static_cast<double>(opened), 0.95 * static_cast<double>(pulp));
  // from each leaf of it the way out is free: target or air all along
  std::size_t leaves = 0, blocked = 0, below = 0, edge = 0;
  double edge_z = -1e9;
  for (const Vec3& p : landmarks.incisal_edge_mm) edge_z = std::max(edge_z, p.z);
  zones.for_each_target_leaf([&](IVec3 leaf) {
    ++leaves;
    const Vec3 p = zones.centre_mm(leaf);
    below += p.z < mouth_z - 0.3 ? 1 : 0;
    edge += p.z > edge_z - 1.0 ? 1 : 0;
    for (double up = 0.2; up < 8; up += 0.2)
      if (const Vec3 over = p + way * up;
          tooth.octree.tissue_at(over) != k_air && zones.distance_mm(over) > 0.08) {
        ++blocked;
        break;
      }
  });
  EXPECT_LT(static_cast<double>(blocked), 0.01 * static_cast<double>(leaves));
  EXPECT_EQ(below, 0u);
  EXPECT_EQ(edge, 0u);  // a millimetre of the edge stays
}

TEST(LeaningColumn, IsRefusedWhereNoEdgeIs) {
  const Tooth molar = load_tooth_file(testing_basics::data_path("teeth/lower_molar.cvt"));
  EXPECT_THROW(static_cast<void>(lingual_way(molar, find_landmarks(molar), Name{"here"})), Error);
}

}  // namespace
}  // namespace cavum::scenarios
