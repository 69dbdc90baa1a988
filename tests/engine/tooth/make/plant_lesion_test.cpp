#include "engine/tooth/make/plant_lesion.h"

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "engine/tooth/make/make_block.h"
#include "tests/engine/tooth/tooth_testing.h"

namespace cavum {
namespace {

using namespace testing_basics;
using testing_tooth::volume_mm3;

Tooth block() {
  return make_block({6, 6, 5}, parse_layers("enamel:1.0,dentin:2.5,pulp:0.5,dentin:1.0"), 0.05);
}

TEST(PlantLesion, HasTheVolumeOfItsEllipsoidAndTakesItFromTheDentinAlone) {
  const Tooth before = block(), after = plant_lesion(block(), {{0.3, -0.2, -2.2}, {1.4, 1.0, 0.8}});
  const std::uint8_t id = after.tissue_id("lesion");
  const double ellipsoid = 4.0 / 3 * 3.14159265358979 * 1.4 * 1.0 * 0.8;
  EXPECT_NEAR(volume_mm3(after, id), ellipsoid, 0.01 * ellipsoid);
  EXPECT_NEAR(volume_mm3(after, k_dentin), volume_mm3(before, k_dentin) - volume_mm3(after, id),
              1e-9);
  EXPECT_EQ(volume_mm3(after, k_enamel), volume_mm3(before, k_enamel));
  EXPECT_TRUE(after.octree.is_solid(id));
}

TEST(PlantLesion, LeavesTheSurfaceAsItWasAndTheEnamelSound) {
  const Tooth before = block(),
              after = plant_lesion(
                  block(), {{0, 0, -1.4}, {1.5, 1.5, 0.9}});  // reaches 0.5 mm into the enamel
  EXPECT_EQ(volume_mm3(after, k_enamel), volume_mm3(before, k_enamel));
  Random random(testing_tooth::drawn_seed("PlantLesion.LeavesTheSurfaceAsItWas"));
  Octree::Cursor a, b;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p{random.uniform(-3.2, 3.2), random.uniform(-3.2, 3.2), random.uniform(-5.2, 0.2)};
    ASSERT_EQ(before.octree.sample(p, a).distance_mm, after.octree.sample(p, b).distance_mm);
  }
}

TEST(PlantLesion, ThatWouldOpenIntoPulpOrAirOrHitsNoDentinIsRefused) {
  const auto refusal = [](const LesionShape& lesion) {
    return thrown_by([&] { static_cast<void>(plant_lesion(block(), lesion)); });
  };
  EXPECT_TRUE(tells(refusal({{0, 0, -3.0}, {1, 1, 0.6}}), "pulp"));
  EXPECT_TRUE(tells(refusal({{2.5, 0, -2}, {1, 0.5, 0.5}}), "air"));
  for (const LesionShape& nothing :
       {LesionShape{{0, 0, -0.5}, {1, 1, 0.3}}, LesionShape{{0, 0, -2}, {1, 0, 0.5}}})
    EXPECT_TRUE(refusal(nothing));
}

}  // namespace
}  // namespace cavum
