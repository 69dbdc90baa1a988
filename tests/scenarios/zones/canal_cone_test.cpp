// Cones on the canals' mouths: where the mouths are, and that such a zone is the cone of the same
// numbers.
#include <gtest/gtest.h>

#include "scenarios/zones/relief.h"
#include "scenarios/zones/zone_map.h"
#include "tests/engine/support/basics.h"
#include "tests/scenarios/test_teeth.h"

namespace cavum::scenarios {
namespace {

using testing::chambered_block;
using testing::scenario_text;

ZoneMap zones_of(const std::string& shapes, const Tooth& tooth) {
  return build_zones(parse_scenario(scenario_text(shapes), "s.toml"), tooth);
}

TEST(CanalCone, MouthsLieWhereTheCanalsLeaveTheChamber) {
  const Tooth tooth = chambered_block(0.1);
  const auto mouths = canal_mouths(
      tooth, "pulp", Name{"here"});  // two canals of 0.4 x 0.6 mm under a floor at -4.5
  ASSERT_EQ(mouths.size(), 2u);
  for (const auto& m : mouths) {
    EXPECT_NEAR(std::fabs(m.at_mm.x), 1.0, 0.05);
    EXPECT_NEAR(m.at_mm.y, 0, 0.05);
    EXPECT_NEAR(m.at_mm.z, -4.5, 1e-9);
    EXPECT_NEAR(m.radius_mm, std::sqrt(0.4 * 0.6 / 3.14159265358979), 0.05);
  }
  EXPECT_LT(mouths[0].at_mm.x * mouths[1].at_mm.x, 0);
}

TEST(CanalCone, TheTeethThatShipHaveTheCanalsTheyWereMadeWith) {
  const auto count = [](const char* file) {
    return canal_mouths(load_tooth_file(testing_basics::data_path(std::string("teeth/") + file)),
                        "pulp", Name{file})
        .size();
  };
  EXPECT_EQ(count("lower_molar.cvt"), 3u);
  EXPECT_EQ(count("upper_premolar.cvt"), 1u);
  EXPECT_EQ(count("upper_incisor.cvt"), 1u);
}

TEST(CanalCone, IsTheConeOfTheSameNumbers) {
  const Tooth tooth = chambered_block(0.1);
  const Vec3 mouth = [&] {
    for (const auto& m : canal_mouths(tooth, "pulp", Name{"here"}))
      if (m.at_mm.x > 0) return m.at_mm;
    return Vec3{};
  }();
  char cone[300];
  std::snprintf(
      cone, sizeof cone,
      "[[zones.target]]\nshape = \"cone\"\nat_mm = [%.17g, %.17g, %.17g]\nradius_mm = 0.3\ntop_radius_mm = %.17g\nheight_mm = 8\n",
      mouth.x, mouth.y, mouth.z - 0.2, 0.3 + 8 * 0.17632698070846498);  // tan 10 degrees
  const ZoneMap exact = zones_of(cone, tooth);
  const ZoneMap ours = zones_of(
      "[[zones.target]]\nshape = \"canal_cone\"\ncanals = \"mesial\"\nradius_mm = 0.3\ntaper_deg = 10\ndeeper_mm = 0.2\n",
      tooth);
  EXPECT_GT(exact.count(Zone::target), 1000u);
  EXPECT_EQ(exact.counts(), ours.counts());
  // both canals: the mirror image beside it
  const ZoneMap both =
      zones_of("[[zones.target]]\nshape = \"canal_cone\"\nradius_mm = 0.3\ntaper_deg = 5\n", tooth);
  const ZoneMap one = zones_of(
      "[[zones.target]]\nshape = \"canal_cone\"\ncanals = \"distal\"\nradius_mm = 0.3\ntaper_deg = 5\n",
      tooth);
  EXPECT_NEAR(static_cast<double>(both.count(Zone::target)),
              2.0 * static_cast<double>(one.count(Zone::target)), 4);
  // without a radius, the mouth's own
  const ZoneMap own = zones_of(
      "[[zones.target]]\nshape = \"canal_cone\"\ncanals = \"mesial\"\ntaper_deg = 0\n", tooth);
  EXPECT_NEAR(static_cast<double>(own.count(Zone::target)) * own.leaf_volume_mm3(), 0.24 * 4.5,
              0.12 * 0.24 * 4.5);
}

TEST(CanalCone, OnTheMolarOneMayBeNamedByItsSide) {
  const Tooth molar = load_tooth_file(testing_basics::data_path("teeth/lower_molar.cvt"));
  const auto middle_of = [&](const std::string& side) {
    const ZoneMap z = zones_of(
        "[[zones.target]]\nshape = \"canal_cone\"\ntaper_deg = 0\ncanals = \"" + side + "\"\n",
        molar);
    return (z.target_low_mm() + z.target_high_mm()) * 0.5;
  };
  for (const auto& m : canal_mouths(molar, "pulp", Name{"here"})) {
    const Vec3 found = middle_of(m.at_mm.x < 0   ? "distal"
                                 : m.at_mm.y > 0 ? "mesiobuccal"
                                                 : "mesiolingual");
    EXPECT_NEAR(found.x, m.at_mm.x, 0.1);
    EXPECT_NEAR(found.y, m.at_mm.y, 0.1);
  }
}

TEST(CanalCone, SaysWhereTheMouthsAreWhenNoneLiesOnTheSideAskedFor) {
  const Tooth tooth = chambered_block(0.1);
  const auto said = [&](const std::string& shape) {
    return testing_basics::thrown_by([&] {
      static_cast<void>(zones_of("[[zones.target]]\nshape = \"canal_cone\"\n" + shape, tooth));
    });
  };
  const auto enamel = said("tissue = \"enamel\"\n");
  EXPECT_EQ(testing_basics::place_of(enamel), "s.toml:20:1");
  EXPECT_TRUE(testing_basics::tells(enamel, "enamel") &&
              testing_basics::tells(enamel, "test tooth"));
  const Tooth incisor = load_tooth_file(testing_basics::data_path("teeth/upper_incisor.cvt"));
  const auto mouth = canal_mouths(incisor, "pulp", Name{"here"}).at(0);
  const double middle =
      tissue_relief(incisor, "pulp", TissuePart::chamber, Name{"here"}).middle_mm.y;
  const std::string side = mouth.at_mm.y > middle ? "lingual" : "buccal",
                    other = mouth.at_mm.y > middle ? "buccal" : "lingual";
  const auto zone = [&](const std::string& which) {
    return testing_basics::thrown_by([&] {
      static_cast<void>(zones_of(
          "[[zones.target]]\nshape = \"canal_cone\"\ncanals = \"" + which + "\"\n", incisor));
    });
  };
  EXPECT_TRUE(zone(side));
  EXPECT_FALSE(zone(other));
}

}  // namespace
}  // namespace cavum::scenarios
