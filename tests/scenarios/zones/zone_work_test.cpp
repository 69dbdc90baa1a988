// Texts of a few lines that would take minutes and gigabytes are refused with the limit named,
// before the work is done; what is taken is laid in time.
#include "scenarios/zones/zone_work.h"

#include <gtest/gtest.h>

#include <ctime>

#include "scenarios/zones/mesh_body.h"
#include "scenarios/zones/zone_map.h"
#include "tests/engine/support/basics.h"
#include "tests/scenarios/test_teeth.h"

namespace cavum::scenarios {
namespace {

const Tooth& molar() {
  static const Tooth k_molar =
      load_tooth_file(std::string(CAVUM_SOURCE_DIR) + "/data/teeth/lower_molar.cvt");
  return k_molar;
}

/// What build_zones says of these zones in a molar of 17 million leaves, and the processor's
/// seconds that it takes.
struct Laid {
  std::optional<Error> refusal;
  double seconds = 0;
};
Laid lay(const std::string& zones) {
  const Scenario s = parse_scenario(testing::scenario_text(zones), "s.toml");
  Laid laid;
  static_cast<void>(molar());
  const std::clock_t began = std::clock();
  laid.refusal = testing_basics::thrown_by([&] { static_cast<void>(build_zones(s, molar())); });
  laid.seconds = static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC;
  return laid;
}

std::string times(int count, const std::string& text) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

/// Points of a line to and fro across the crown.
std::string zigzag(int points, const std::string& half) {
  std::string list;
  for (int i = 0; i < points; ++i)
    list += std::string(i % 2 != 0 ? "[" : "[-") + half + ", " + std::to_string(0.001 * i) + "], ";
  return "outline = { kind = \"stroke\", width_mm = 1.4, points_mm = [" + list + "] }\n";
}

constexpr double k_max_seconds =
    5;  // on the machine that tests run on; as built, without sanitizers

void expect_refused(const std::string& zones, int limit) {
  const Laid laid = lay(zones);
  EXPECT_EQ(testing_basics::code_of(laid.refusal), Mistake::too_large);
  EXPECT_TRUE(testing_basics::tells(laid.refusal, limit)) << limit;
  EXPECT_LT(laid.seconds, k_max_seconds) << zones;
}

TEST(ZoneWork, ATargetOfTheWholeToothIsRefused) {
  expect_refused("[[zones.target]]\nshape = \"ball\"\nat_mm = [0, 0, 0]\nradius_mm = 100\n",
                 16000000);
}

TEST(ZoneWork, ManyTissuesGrownAreRefused) {
  const std::string grown =
      "[[zones.target]]\nshape = \"tissue\"\ntissue = \"dentin\"\noffset_mm = 5\n";
  expect_refused(times(2, grown), 20000000);
  expect_refused(
      times(12, "[[zones.target]]\nshape = \"tissue\"\ntissue = \"pulp\"\noffset_mm = 2\n"),
      20000000);
}

TEST(ZoneWork, ManyPiecesAtEachLeafAreRefused) {
  expect_refused(times(12, "[[zones.target]]\nshape = \"canal_cone\"\n"), 250000000);
  expect_refused(
      "[[zones.target]]\nshape = \"prism\"\nat_mm = [0, 0, 0]\nheight_mm = 4\n" + zigzag(100, "4"),
      250000000);
}

TEST(ZoneWork, ASurfaceOfManyLargeTrianglesIsRefused) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < 2000; ++i) {
    const double z = -1 - 0.001 * i;
    mesh.vertices_mm.insert(mesh.vertices_mm.end(), {{-5, -5, z}, {5, -5, z}, {0, 5, z}});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  ZoneWork work("plates.stl");
  EXPECT_TRUE(testing_basics::tells(
      testing_basics::thrown_by([&] { count_mesh_body(molar(), mesh, work); }), 250'000'000));
}

// It took 7.5 s while the outline was looked at once for each leaf instead of once for each column.
TEST(ZoneWork, AColumnOfAsManyPointsAsAreAllowedIsLaidInTime) {
  const Laid laid = lay(
      "[[zones.target]]\nshape = \"column\"\nbottom = { kind = \"below_lowest\", depth_mm = 1.8 }\n" +
      zigzag(100, "4"));
  EXPECT_FALSE(laid.refusal);
  EXPECT_LT(laid.seconds, k_max_seconds);
}

// The table of columns holds what the outline itself says: a stroke laid twice, once as a column,
// once as the prism that reaches through the tooth.
TEST(ZoneWork, AColumnsOutlineIsTheSameAtEachLeafAsThatOfAPrism) {
  const Tooth block = testing::dentin_block(3, 3, 0.1);
  const auto zones_of = [&](const std::string& body) {
    return build_zones(parse_scenario(testing::scenario_text(body), "s.toml"), block);
  };
  const ZoneMap
      column = zones_of(
          "[[zones.target]]\nshape = \"column\"\nbottom = { kind = \"level\", z_mm = -2 }\n" +
          zigzag(5, "1")),
      prism = zones_of("[[zones.target]]\nshape = \"prism\"\nat_mm = [0, 0, -2]\nheight_mm = 9\n" +
                       zigzag(5, "1"));
  ASSERT_EQ(column.counts(), prism.counts());
  column.for_each_leaf([&](IVec3 leaf, Zone zone) {
    ASSERT_EQ(zone, prism.zone(leaf)) << leaf.x << " " << leaf.y << " " << leaf.z;
  });
}

}  // namespace
}  // namespace cavum::scenarios
