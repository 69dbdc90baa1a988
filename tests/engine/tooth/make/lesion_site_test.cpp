// Lesions on every side of teeth whose contacts stand higher than their dentin.
#include "engine/tooth/make/lesion_site.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/base/error.h"
#include "engine/tooth/make/grow_teeth.h"
#include "engine/tooth/make/make_molar.h"
#include "engine/tooth/make/make_premolar.h"
#include "tests/engine/tooth/tooth_testing.h"

namespace cavum {
namespace {

using testing_tooth::volume_mm3;

/// The border of enamel and dentin lies at the lesion's middle, and all of the way to it from
/// outside is enamel.
void expect_under_sound_enamel(const Tooth& tooth, const LesionShape& lesion, Vec3 out,
                               const std::string& what) {
  const double leaf = tooth.octree.leaf_mm();
  EXPECT_EQ(tooth.octree.tissue_at(lesion.centre_mm - out * leaf), k_dentin) << what;
  bool air = false;
  for (double way = leaf; way < 4; way += leaf / 2) {
    const std::uint8_t t = tooth.octree.tissue_at(lesion.centre_mm + out * way);
    air = air || t == k_air;
    EXPECT_EQ(t, air ? k_air : k_enamel) << what << ", " << way << " mm outwards";
  }
  EXPECT_TRUE(air) << what;
}

TEST(LesionSite, EverySideOfAMolarAndAPremolarHasDentinUnderItsEnamel) {
  constexpr double k_coarse_mm = 0.1;
  MolarShape molar;
  molar.leaf_mm = k_coarse_mm;
  PremolarShape premolar;
  premolar.leaf_mm = k_coarse_mm;
  const std::pair<const char*, Tooth> teeth[] = {
      {"molar that ships", make_molar(molar)},
      {"molar of seed 3", grow_molar({3, k_coarse_mm, 1})},
      {"premolar that ships", make_premolar(premolar)},
      {"premolar of seed 4", grow_premolar({4, k_coarse_mm, 1})}};
  for (const auto& [name, tooth] : teeth) {
    const Landmarks landmarks = find_landmarks(tooth);
    for (const auto& [surface, out] : {std::pair("mesial", Vec3{1, 0, 0}),
                                       {"distal", Vec3{-1, 0, 0}},
                                       {"buccal", Vec3{0, 1, 0}},
                                       {"lingual", Vec3{0, -1, 0}}}) {
      const std::string what = std::string(name) + ", " + surface;
      const LesionShape lesion = place_lesion(tooth, landmarks, {surface, 1.5, 0.6});
      expect_under_sound_enamel(tooth, lesion, out, what);
      const Tooth ill = plant_lesion(tooth, lesion);
      EXPECT_GT(volume_mm3(ill, ill.tissue_id("lesion")),
                0.25 * 4.0 / 3 * 3.14159 * 0.75 * 0.75 * 0.6)
          << what << ": about half of its ellipsoid";
    }
  }
}

TEST(LesionSite, NoSuchSurfaceAndNoSuchLengthAreRefused) {
  MolarShape shape;
  shape.leaf_mm = 0.2;
  const Tooth tooth = make_molar(shape);
  const Landmarks landmarks = find_landmarks(tooth);
  for (const LesionSite& bad :
       {LesionSite{"palatal", 2, 0.8}, LesionSite{"mesial", 9, 0.8}, LesionSite{"mesial", 2, 0}})
    EXPECT_THROW(static_cast<void>(place_lesion(tooth, landmarks, bad)), Error) << bad.surface;
  EXPECT_THROW(static_cast<void>(place_lesion(tooth, {}, {"mesial", 2, 0.8})), Error)
      << "no height of contour";
}

}  // namespace
}  // namespace cavum
