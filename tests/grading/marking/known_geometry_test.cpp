// Cylinder, box, cone and ball cavities cut in a block of 0.05 mm leaves at 20 random poses each,
// against closed forms that know nothing of leaves: volumes, wall distances, taper and outline,
// each within its limit and within the bound that the result states.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <string_view>

#include "engine/base/random.h"
#include "grading/marking/grade.h"
#include "tests/engine/support/basics.h"
#include "tests/grading/carved.h"

namespace cavum::grading {
namespace {

using testing::Carved;
using testing::dentin_block;
using testing::scenario_text;
using testing_basics::drawn_seed;

constexpr double k_leaf = 0.05,
                 k_top = 6.0;  // bodies rise this far from their lower face, beyond the block
const int k_poses = std::getenv("CAVUM_DEEP") != nullptr
                        ? 200
                        : 20;  // of a body whose lengths are drawn with each pose

/// A body standing at `at`, its axis tilted by `tilt` towards `azimuth` and turned about it by
/// `turn` (radians).
struct Pose {
  Vec3 at, x, y, z;
  Pose(Random& random, double depth, double most_tilt) {
    at = {random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), -depth};
    const double tilt = random.uniform(0, most_tilt) * std::numbers::pi / 180,
                 azimuth = random.uniform(0, 2 * std::numbers::pi);
    z = {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)};
    const Vec3 x0 = normalized(Vec3{1, 0, 0} - z * z.x), y0 = cross(z, x0);
    const double turn = random.uniform(0, 2 * std::numbers::pi);
    x = x0 * std::cos(turn) + y0 * std::sin(turn);
    y = y0 * std::cos(turn) - x0 * std::sin(turn);
  }
  [[nodiscard]] Vec3 local(Vec3 p) const {
    return {dot(p - at, x), dot(p - at, y), dot(p - at, z)};
  }
  [[nodiscard]] Vec3 world(Vec3 q) const { return at + x * q.x + y * q.y + z * q.z; }
};

std::string plain(double v) { return fmt::format("{:.15g}", v); }
std::string vector(Vec3 v) {
  return "[" + plain(v.x) + ", " + plain(v.y) + ", " + plain(v.z) + "]";
}

double meet(double a, double b) {
  return a > 0 && b > 0 ? std::sqrt(a * a + b * b) : std::max(a, b);
}

/// A cavity: what is cut, and the closed forms of what grading must find.
struct Known {
  std::string target_toml;
  std::function<double(Vec3)> cut;                      // signed distance
  double target_mm3 = 0, removed_mm3 = 0;               // below z = 0
  double sides_mm = 0, floor_mm = 0, furthest_mm = 0;   // overcut
  double low_x = 0, high_x = 0, low_y = 0, high_y = 0;  // outline at z = 0
  double depth_mm = 0, taper_deg = 0;
  bool upright = false;
};

void outline_from(Known& k, const std::vector<Vec3>& points) {
  k.low_x = k.low_y = 1e9;
  k.high_x = k.high_y = -1e9;
  for (const Vec3 p : points) {
    k.low_x = std::min(k.low_x, p.x);
    k.high_x = std::max(k.high_x, p.x);
    k.low_y = std::min(k.low_y, p.y);
    k.high_y = std::max(k.high_y, p.y);
  }
}
/// Where the line through two points meets the block's top.
Vec3 at_top(Vec3 a, Vec3 b) { return a + (b - a) * (a.z / (a.z - b.z)); }

/// Cylinder (slope 0) and cone: radius `r` at the lower face, growing by `slope` per mm. The cut is
/// wider by `s` and deeper by `f`, perpendicular to the surface.
Known round_body(Random& random, double most_tilt, double slope) {
  Known k;
  const double depth = random.uniform(1.8, 2.8), r = random.uniform(1.1, 1.5),
               s = random.uniform(0.02, 0.18), f = random.uniform(0.02, 0.18);
  const Pose pose(random, depth, most_tilt);
  k.upright = most_tilt == 0;
  k.target_toml = "[[zones.target]]\nshape = \"cone\"\nat_mm = " + vector(pose.at) +
                  "\naxis = " + vector(pose.z) + "\nradius_mm = " + plain(r) +
                  "\ntop_radius_mm = " + plain(r + slope * k_top) +
                  "\nheight_mm = " + plain(k_top) + "\n";
  const double cosine = 1 / std::sqrt(1 + slope * slope), wider = s / cosine;
  k.cut = [=](Vec3 p) {
    const Vec3 q = pose.local(p);
    return meet((std::sqrt(q.x * q.x + q.y * q.y) - r - wider - slope * q.z) * cosine, -f - q.z);
  };
  // a cone cut obliquely is a third of its elliptic base times its height; the axis passes through
  // the ellipse's middle only for a cylinder
  const auto volume = [&](double radius, double below) {
    const Vec3 low = pose.world({0, 0, -below});
    const double c = pose.z.z, axis = -low.z / c;  // length of the axis up to the top face
    const double foot = radius - slope * below;
    if (slope == 0) return std::numbers::pi * foot * foot * axis;
    const double to_apex = foot / slope, t2 = slope * slope, sine2 = 1 - c * c;
    const double height = (to_apex + axis) * c;  // of the apex under the top face
    const double e =
        c * c - t2 * sine2;  // ellipse of the section: areas from the plane's distance to the apex
    const double area = std::numbers::pi * t2 * height * height / (e * std::sqrt(e));
    return area * height / 3 - std::numbers::pi * foot * foot * to_apex / 3;
  };
  k.target_mm3 = volume(r, 0);
  k.removed_mm3 = volume(r + wider, f);
  k.sides_mm = s;
  k.floor_mm = f;
  // the lower edge of the cut from the lower edge of the target
  const double edge = r + wider - slope * f;
  k.furthest_mm = std::sqrt((edge - r) * (edge - r) + f * f);
  k.furthest_mm = std::max(k.furthest_mm, std::max(s, f));
  std::vector<Vec3> rim;
  for (int i = 0; i < 7200; ++i) {
    const double a = i * std::numbers::pi / 3600, big = r + wider + slope * k_top;
    rim.push_back(at_top(pose.world({(r + wider) * std::cos(a), (r + wider) * std::sin(a), 0}),
                         pose.world({big * std::cos(a), big * std::sin(a), k_top})));
  }
  outline_from(k, rim);
  double lowest = 0;
  for (int i = 0; i < 3600; ++i) {
    const double a = i * std::numbers::pi / 1800;
    lowest = std::min(lowest, pose.world({edge * std::cos(a), edge * std::sin(a), -f}).z);
  }
  k.depth_mm = -lowest;
  k.taper_deg = std::atan(slope) * 180 / std::numbers::pi;
  return k;
}

Known box_body(Random& random, double most_tilt) {
  Known k;
  const double depth = random.uniform(1.8, 2.8), a = random.uniform(1.2, 1.9),
               b = random.uniform(0.9, 1.4);
  const double s = random.uniform(0.02, 0.18), f = random.uniform(0.02, 0.18);
  const Pose pose(random, depth, most_tilt);
  k.upright = most_tilt == 0;
  std::string points;
  for (const Vec3 p : {Vec3{-a, -b, 0}, {a, -b, 0}, {a, b, 0}, {-a, b, 0}}) {
    const Vec3 q = pose.x * p.x + pose.y * p.y;
    points += (points.empty() ? "" : ", ") + ("[" + plain(q.x) + ", " + plain(q.y) + "]");
  }
  // as the corners are given in the tilted frame by `turn_deg`, the angle of our x from the frame's
  // own
  const Vec3 x0 = std::fabs(pose.z.x) < 0.9 ? normalized(Vec3{1, 0, 0} - pose.z * pose.z.x)
                                            : Vec3{0, 1, 0},
             y0 = cross(pose.z, x0);
  const double turn = std::atan2(dot(pose.x, y0), dot(pose.x, x0)) * 180 / std::numbers::pi;
  k.target_toml =
      "[[zones.target]]\nshape = \"box\"\nat_mm = " + vector(pose.world({0, 0, k_top / 2})) +
      "\naxis = " + vector(pose.z) + "\nturn_deg = " + plain(turn) +
      "\nsize_mm = " + vector({2 * a, 2 * b, k_top}) + "\n";
  k.cut = [=](Vec3 p) {
    const Vec3 q = pose.local(p);
    return meet(meet(std::fabs(q.x) - a - s, std::fabs(q.y) - b - s), -f - q.z);
  };
  const auto volume = [&](double half_a, double half_b, double below) {
    return 4 * half_a * half_b * (-pose.world({0, 0, -below}).z / pose.z.z);
  };
  k.target_mm3 = volume(a, b, 0);
  k.removed_mm3 = volume(a + s, b + s, f);
  k.sides_mm = s;
  k.floor_mm = f;
  k.furthest_mm = std::sqrt(2 * s * s + f * f);
  std::vector<Vec3> rim;
  double lowest = 0;
  for (const Vec3 p :
       {Vec3{-a - s, -b - s, -f}, {a + s, -b - s, -f}, {a + s, b + s, -f}, {-a - s, b + s, -f}}) {
    rim.push_back(at_top(pose.world(p), pose.world(p + Vec3{0, 0, k_top})));
    lowest = std::min(lowest, pose.world(p).z);
  }
  outline_from(k, rim);
  k.depth_mm = -lowest;
  return k;
}

Known ball_body(Random& random) {
  Known k;
  const double r = random.uniform(1.4, 1.9), s = random.uniform(0.02, 0.18),
               deep = random.uniform(0.2, 0.9);  // of the centre, below the top
  const Vec3 at{random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), -deep};
  k.target_toml = "[[zones.target]]\nshape = \"ball\"\nat_mm = " + vector(at) +
                  "\nradius_mm = " + plain(r) + "\n";
  k.cut = [=](Vec3 p) { return length(p - at) - r - s; };
  const auto volume = [&](double radius) {  // the ball without its cap above the top
    const double cap = radius - deep;
    return std::numbers::pi * (4.0 / 3 * radius * radius * radius - cap * cap * (radius - cap / 3));
  };
  k.target_mm3 = volume(r);
  k.removed_mm3 = volume(r + s);
  k.sides_mm = k.floor_mm = k.furthest_mm = s;
  const double rim = std::sqrt((r + s) * (r + s) - deep * deep);
  outline_from(k, {at + Vec3{rim, rim, 0}, at - Vec3{rim, rim, 0}});
  k.depth_mm = deep + r + s;
  return k;
}

/// The largest of what was found wrong, by figure.
struct Worst {
  double volume_percent = 0, mean_mm = 0, p95_mm = 0, wall_mm = 0, taper_deg = 0, outline_mm = 0,
         depth_mm = 0;
  double of_volume_bound = 0, of_zone_bound = 0, of_mean_bound = 0, of_p95_bound = 0,
         of_wall_bound = 0, of_outline_bound = 0,
         of_taper_bound = 0;  // errors, as shares of the stated bound
};

void compare(const Known& k, Worst& worst, const std::string& where) {
  SCOPED_TRACE(where);
  static const Tooth block = dentin_block(3.8, 3.6, k_leaf);
  Carved c(scenario_text(k.target_toml), block);
  c.carve(k.cut, 0);
  const Result r = c.graded();
  const auto volume = [&](const char* name, const BoundedVolume& found, double truth,
                          double scale) {
    worst.volume_percent =
        std::max(worst.volume_percent, 100 * std::fabs(found.mm3 - truth) / scale);
    double& of_bound =
        std::string_view(name) == "overcut" ? worst.of_zone_bound : worst.of_volume_bound;
    of_bound = std::max(of_bound, std::fabs(found.mm3 - truth) / found.bound_mm3);
    EXPECT_NEAR(found.mm3, truth, 0.005 * scale) << name;
    EXPECT_NEAR(found.mm3, truth, found.bound_mm3) << name << ": outside its bound";
  };
  volume("target", r.volumes.target, k.target_mm3, k.target_mm3);
  volume("removed", r.volumes.removed, k.removed_mm3, k.removed_mm3);
  volume("target removed",
         r.volumes.zone[static_cast<std::size_t>(scenarios::Zone::target)].removed, k.target_mm3,
         k.target_mm3);
  BoundedVolume beyond;  // the zones beyond the target, which are thin: against what was removed
  for (std::size_t z = 0; z < scenarios::k_zones; ++z) {
    if (z == static_cast<std::size_t>(scenarios::Zone::target)) continue;
    beyond.mm3 += r.volumes.zone[z].removed.mm3;
    beyond.bound_mm3 += r.volumes.zone[z].removed.bound_mm3;
  }
  volume("overcut", beyond, k.removed_mm3 - k.target_mm3, k.removed_mm3);
  EXPECT_NEAR(r.volumes.dice, 2 * k.target_mm3 / (k.target_mm3 + k.removed_mm3), 0.005);
  EXPECT_NEAR(r.volumes.dice, 2 * k.target_mm3 / (k.target_mm3 + k.removed_mm3),
              r.volumes.dice_bound);
  EXPECT_NEAR(r.volumes.target_removed_percent, 100, 1e-9);
  const auto distance = [&](double& kept, double& of_bound, const char* name, double found,
                            double truth) {
    kept = std::max(kept, std::fabs(found - truth));
    of_bound = std::max(of_bound, std::fabs(found - truth) / r.shape.bound_mm);
    EXPECT_NEAR(found, truth, std::min(k_leaf, r.shape.bound_mm)) << name;
  };
  double furthest = 0;
  for (std::size_t w = 0; w < scenarios::k_walls; ++w) {
    const WallMeasures& m = r.shape.wall[w];
    ASSERT_GT(m.samples, 0u) << scenarios::wall_name(static_cast<scenarios::Wall>(w));
    const bool floor = w == static_cast<std::size_t>(scenarios::Wall::floor);
    distance(worst.mean_mm, worst.of_mean_bound,
             scenarios::wall_name(static_cast<scenarios::Wall>(w)), m.mean_mm,
             floor ? k.floor_mm : k.sides_mm);
    EXPECT_NEAR(m.mean_mm, floor ? k.floor_mm : k.sides_mm, m.mean_bound_mm);
    if (k.upright) {  // all of a wall lies as far out, but for some places in the corner below it
      worst.p95_mm =
          std::max(worst.p95_mm, std::fabs(m.p95_mm - (floor ? k.floor_mm : k.sides_mm)));
      worst.of_p95_bound =
          std::max(worst.of_p95_bound,
                   std::fabs(m.p95_mm - (floor ? k.floor_mm : k.sides_mm)) / m.p95_bound_mm);
      EXPECT_NEAR(m.p95_mm, floor ? k.floor_mm : k.sides_mm, m.p95_bound_mm);
    }
    furthest = std::max(furthest, m.max_over_mm);
    EXPECT_LE(m.max_under_mm, r.shape.bound_mm);
  }
  distance(worst.wall_mm, worst.of_wall_bound, "furthest", furthest, k.furthest_mm);
  distance(worst.outline_mm, worst.of_outline_bound, "length", *r.shape.length_mm,
           k.high_x - k.low_x);
  distance(worst.outline_mm, worst.of_outline_bound, "width", *r.shape.width_mm,
           k.high_y - k.low_y);
  distance(worst.depth_mm, worst.of_outline_bound, "depth", *r.shape.depth_mm, k.depth_mm);
  if (!k.upright) return;
  worst.taper_deg = std::max(worst.taper_deg, std::fabs(*r.shape.taper_deg - k.taper_deg));
  worst.of_taper_bound = std::max(
      worst.of_taper_bound, std::fabs(*r.shape.taper_deg - k.taper_deg) / r.shape.taper_bound_deg);
  EXPECT_NEAR(*r.shape.taper_deg, k.taper_deg, std::min(1.0, r.shape.taper_bound_deg));
}

void run(const char* name, const std::function<Known(Random&, bool upright)>& make) {
  const std::uint64_t seed = drawn_seed(name);
  Random random(seed);
  Worst worst;
  for (int pose = 0; pose < k_poses; ++pose) {
    const bool upright = pose % 2 == 0;
    compare(
        make(random, upright), worst,
        std::string(name) + ", pose " + std::to_string(pose) + ", seed " + std::to_string(seed));
  }
  std::printf(
      "%-8s %d poses, largest errors (share of the stated bound): volume %.3f %% (%.2f; zones beyond the target %.2f), ",
      name, k_poses, worst.volume_percent, worst.of_volume_bound, worst.of_zone_bound);
  std::printf("wall's mean %.4f mm (%.2f), p95 %.4f mm (%.2f), furthest %.4f mm (%.2f), ",
              worst.mean_mm, worst.of_mean_bound, worst.p95_mm, worst.of_p95_bound, worst.wall_mm,
              worst.of_wall_bound);
  std::printf("outline %.4f mm, depth %.4f mm (%.2f), taper %.3f deg (%.2f)\n", worst.outline_mm,
              worst.depth_mm, worst.of_outline_bound, worst.taper_deg, worst.of_taper_bound);
}

TEST(KnownGeometry, CylinderAtRandomPoses) {
  run("cylinder",
      [](Random& random, bool upright) { return round_body(random, upright ? 0 : 15, 0.0); });
}
TEST(KnownGeometry, BoxAtRandomPoses) {
  run("box", [](Random& random, bool upright) { return box_body(random, upright ? 0 : 15); });
}
TEST(KnownGeometry, ConeAtRandomPoses) {
  run("cone", [](Random& random, bool upright) {
    const double slope = std::tan(random.uniform(3, 15) * std::numbers::pi / 180);
    return round_body(random, upright ? 0 : 15, slope);
  });
}
TEST(KnownGeometry, BallAtRandomPoses) {
  run("ball", [](Random& random, bool) {
    Known k = ball_body(random);
    k.upright = false;  // a ball has no taper
    return k;
  });
}

/// Area of a convex polygon beyond the line dot(p, normal) = level.
double area_beyond(const std::vector<Vec3>& corners, Vec3 normal, double level) {
  std::vector<Vec3> kept;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 a = corners[i], b = corners[(i + 1) % corners.size()];
    const double at_a = dot(a, normal) - level, at_b = dot(b, normal) - level;
    if (at_a > 0) kept.push_back(a);
    if ((at_a > 0) != (at_b > 0)) kept.push_back(a + (b - a) * (at_a / (at_a - at_b)));
  }
  double twice = 0;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const Vec3 a = kept[i], b = kept[(i + 1) % kept.size()];
    twice += a.x * b.y - a.y * b.x;
  }
  return std::fabs(twice) / 2;
}

// A straight lip of dentin left over one of two canals' mouths, 0.4 x 0.6 mm each: on a grid that
// their walls lie on, and on one that they do not.
TEST(KnownGeometry, CanalsUnderALip) {
  const std::uint64_t seed = drawn_seed("KnownGeometry.CanalsUnderALip");
  Random random(seed);
  double most = 0, of_bound = 0, largest_bound = 0;
  for (const double leaf_mm : {0.05, 0.06}) {
    const Tooth block = testing::chambered_block(leaf_mm);
    for (int pose = 0; pose < k_poses / 2; ++pose) {
      const double turn = random.uniform(0, 2 * std::numbers::pi),
                   off = random.uniform(-0.45, 0.45);
      const Vec3 normal{std::cos(turn), std::sin(turn), 0};
      const double level = normal.x * 1.0 + off;
      Carved c(testing::opening_pulp(testing::k_chamber_target), block);
      const auto whole = testing::box_hole(-1.5, 1.5, -1, 1, -4.5);
      // the lip: beyond the line, within 0.6 mm of the mouth at x = 1, from z = -2.4 to -1.6
      c.carve(
          [=](Vec3 p) {
            const double lip = std::max({level - dot(p, normal), std::fabs(p.x - 1) - 0.49,
                                         std::fabs(p.y) - 0.6, std::fabs(p.z + 2) - 0.4});
            return std::max(whole(p), -lip);
          },
          0);
      const Result r = c.graded();
      const double truth =
          100 *
          area_beyond({{0.8, -0.3, 0}, {1.2, -0.3, 0}, {1.2, 0.3, 0}, {0.8, 0.3, 0}}, normal,
                      level) /
          (2 * 0.4 * 0.6);
      ASSERT_TRUE(r.access.canals_covered_percent);
      const double error = std::fabs(*r.access.canals_covered_percent - truth),
                   bound = r.access.canals_bound_percent;
      EXPECT_LE(error, bound + 1e-9)
          << "leaf " << leaf_mm << ", pose " << pose << ", seed " << seed << ": "
          << *r.access.canals_covered_percent << " for " << truth;
      most = std::max(most, error);
      if (bound > 0) of_bound = std::max(of_bound, error / bound);
      largest_bound = std::max(largest_bound, bound);
    }
  }
  std::printf(
      "lip      %d poses, largest error %.2f %% (%.2f of the stated bound), largest bound %.2f %%\n",
      2 * (k_poses / 2), most, of_bound, largest_bound);
}

}  // namespace
}  // namespace cavum::grading
