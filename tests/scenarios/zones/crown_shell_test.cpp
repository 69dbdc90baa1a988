// What a crown takes the place of, on a round tooth: the stump's walls, chamfer and top against the
// closed form.
#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "scenarios/zones/placed.h"
#include "scenarios/zones/zone_map.h"
#include "tests/scenarios/test_crowns.h"

namespace cavum::scenarios {
namespace {

using testing::round_landmarks;
using testing::round_tooth;
using testing::scenario_text;

constexpr double k_radius_mm = 4, k_neck_mm = -6, k_leaf_mm = 0.1, k_chamfer_mm = 1,
                 k_margin_mm = k_neck_mm + 0.5, k_top_mm = -1.5;
constexpr double k_tan_6 = 0.10510423526567647;

ZoneMap crown(const Landmarks& landmarks) {
  return build_zones(
      parse_scenario(
          scenario_text(
              "[[zones.target]]\nshape = \"crown\"\nabove_neck_mm = 0.5\ndepth_mm = 1.0\ntaper_deg = 6\nocclusal_mm = 1.5\n"),
          "s.toml"),
      round_tooth(k_radius_mm, -8, k_leaf_mm), landmarks);
}

/// Radius of the stump at a height.
double radius_at(double z) {
  const double up = z - k_margin_mm;
  if (up < k_chamfer_mm)
    return k_radius_mm -
           std::sqrt(k_chamfer_mm * k_chamfer_mm - (k_chamfer_mm - up) * (k_chamfer_mm - up));
  return k_radius_mm - k_chamfer_mm - k_tan_6 * (up - k_chamfer_mm);
}

TEST(CrownShell, ItsStumpTapersAsAsked) {
  const ZoneMap zones = crown(round_landmarks(k_radius_mm, k_neck_mm));
  EXPECT_EQ(zones.approach(), (Vec3{0, 0, 1}));
  const auto wall_at = [&](double angle,
                           double z) {  // where the distance changes its sign coming from the axis
    const Vec3 way{std::cos(angle), std::sin(angle), 0};
    double r = 1.5;
    while (r < k_radius_mm && zones.distance_mm(way * r + Vec3{0, 0, z}) > 0) r += 0.002;
    return r;
  };
  for (double angle = 0.1; angle < 6.2; angle += 0.7) {
    for (const double z : {-5.2, -4.8, -4.3, -3.5, -2.5})
      EXPECT_NEAR(wall_at(angle, z), radius_at(z), 0.3 * k_leaf_mm) << angle << " " << z;
    EXPECT_NEAR((wall_at(angle, -4.3) - wall_at(angle, -2.3)) / 2.0, k_tan_6, 0.015)
        << angle;  // 12 degrees of convergence, to 1.7
  }
}

TEST(CrownShell, HasTheVolumeOutsideTheStump) {
  const ZoneMap zones = crown(round_landmarks(k_radius_mm, k_neck_mm));
  double mm3 = 3.14159265358979 * k_radius_mm * k_radius_mm * (0 - k_margin_mm);
  constexpr double k_step_mm = 0.001;
  for (double z = k_margin_mm + 0.5 * k_step_mm; z < k_top_mm; z += k_step_mm)
    mm3 -= 3.14159265358979 * radius_at(z) * radius_at(z) * k_step_mm;
  const double ours =
      static_cast<double>(zones.target_shares()) / ZoneMap::k_share_units * zones.leaf_volume_mm3();
  EXPECT_NEAR(ours, mm3, 0.01 * mm3);
}

TEST(CrownShell, ItsFinishLineFollowsTheNeckAndNothingBelowIsTaken) {
  const double rise = 1.5;
  const ZoneMap zones = crown(round_landmarks(k_radius_mm, k_neck_mm, rise));
  for (const double angle : {0.0, 0.8, 1.57, 2.4}) {
    const double c = std::cos(angle), margin = k_margin_mm + rise * c * c;
    const Vec3 rim{3.9 * c, 3.9 * std::sin(angle), 0};
    double z = k_neck_mm - 0.5;
    while (z < 0 && zones.distance_mm(rim + Vec3{0, 0, z}) > 0) z += 0.005;
    // the chamfer's outer end, 0.1 mm inside the surface, is 0.005 mm high; waves are smoothed over
    // 35 degrees
    EXPECT_NEAR(z, margin, 0.1) << angle;
  }
}

TEST(CrownShell, IsRefusedWithoutANeck) { EXPECT_THROW(static_cast<void>(crown({})), Error); }

}  // namespace
}  // namespace cavum::scenarios
