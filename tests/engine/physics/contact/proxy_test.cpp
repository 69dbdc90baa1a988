#include "engine/physics/contact/proxy.h"

#include <gtest/gtest.h>

#include "engine/base/det_math.h"
#include "engine/tooth/make/make_block.h"
#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

constexpr double k_leaf = 0.05;

/// A rotation whose tool axis leans at most `lean_rad` from `up`.
Quat leaning(Random& random, Vec3 up, double lean_rad) {
  const Vec3 side = normalized(cross(up, random_direction(random)));
  const double lean = random.uniform(0, lean_rad);
  const auto sc = det_sincos(lean);
  return rotation_between({0, 0, 1}, normalized(up * sc.cos + side * sc.sin));
}

double degrees_between(Vec3 a, Vec3 b) {
  return std::atan2(length(cross(a, b)), dot(a, b)) * 180 / k_pi;
}

/// Deepest sample of a tool below a surface given by its signed distance, mm (0 when none is).
template <class Distance>
double deepest_mm(const ContactTool& tool, Vec3 tip, Quat q, const Distance& distance) {
  const Mat3 m = rotation(q);
  double deepest = 0;
  for (const auto& s : tool.samples) deepest = std::max(deepest, -distance(tip + m * s.at_mm));
  return deepest;
}

struct Figures {
  double at_rest_percent = 0, at_rest_degrees = 0;            // after pressing
  double depth_percent = 0, ripple_percent = 0, degrees = 0;  // while sliding
  double dropped = 0;  // ticks without force although the proxy is held off by X
  void grow(const Figures& f) {
    at_rest_percent = std::max(at_rest_percent, f.at_rest_percent);
    at_rest_degrees = std::max(at_rest_degrees, f.at_rest_degrees);
    depth_percent = std::max(depth_percent, f.depth_percent);
    ripple_percent = std::max(ripple_percent, f.ripple_percent);
    degrees = std::max(degrees, f.degrees);
    dropped += f.dropped;
  }
};

/// Presses a bur onto a random plane to X = 0.25 mm and slides it 2 mm.
Figures press_and_slide(Random& random, const Bur& bur, double speed_mm_s = 2.0) {
  const Vec3 normal = random_direction(random), on_it = normal * random.uniform(-0.05, 0.05);
  const Tooth tooth = half_space_tooth(normal, on_it, 2.0, k_leaf);
  const Quat turned = leaning(random, normal, 50 * k_pi / 180);
  const Vec3 slide = normalized(cross(normal, random_direction(random)));
  // where the tip is when the bur just touches, 1 mm back along the slide
  Vec3 touch = slide * -1.0;
  touch += normal * (dot(on_it, normal) - dot(touch, normal));
  touch += normal * -height_over_plane_mm(bur, touch, turned, normal, dot(on_it, normal));
  constexpr double x = 0.25;
  Rig rig(tooth, {bur}, hard_model(0.8, 0), touch + normal * 0.3);
  (void)rig.travel(touch + normal * 0.3, touch - normal * x, 10, 0, turned);
  TickOutput out;
  for (int i = 0; i < 20; ++i) out = rig.tick(touch - normal * x, 0, turned);
  Figures f;
  f.at_rest_degrees = degrees_between(out.normal, normal);
  f.at_rest_percent = std::fabs(out.penetration_mm - x) / x * 100;
  double least = 1e9, most = 0;
  const int n = static_cast<int>(2000 / speed_mm_s);
  for (int i = 0; i <= n; ++i) {
    out = rig.tick(touch - normal * x + slide * (2.0 * i / n), 0, turned);
    least = std::min(least, out.penetration_mm);
    most = std::max(most, out.penetration_mm);
    f.degrees = std::max(f.degrees, degrees_between(out.normal, normal));
    f.depth_percent = std::max(f.depth_percent, std::fabs(out.penetration_mm - x) / x * 100);
    f.dropped += std::fabs(out.model_force_n - 0.8 * out.penetration_mm) > 1e-6;
  }
  f.ripple_percent = (most - least) / x * 100;
  return f;
}

TEST(Proxy, OnAPlaneXIsTheAnalyticDepthWhateverTheOrientation) {
  Random random(drawn_seed("Proxy.OnAPlaneXIsTheAnalyticDepthWhateverTheOrientation"));
  Figures worst;
  for (int i = 0; i < 50; ++i) worst.grow(press_and_slide(random, shipped_bur("round-1.0")));
  std::printf(
      "plane, round-1.0, 50 orientations: X at rest %.2f %% and %.2f deg; sliding at 2 mm/s: X %.2f %%, ripple %.2f %%, direction %.2f deg\n",
      worst.at_rest_percent, worst.at_rest_degrees, worst.depth_percent, worst.ripple_percent,
      worst.degrees);
  EXPECT_LE(worst.at_rest_percent, 1.0);
  EXPECT_LE(worst.at_rest_degrees, 2.0);
  EXPECT_LE(worst.depth_percent, 1.0);
  EXPECT_LE(worst.ripple_percent, 1.5);
  EXPECT_LE(worst.degrees, 3.0);
  EXPECT_EQ(worst.dropped, 0);
}

TEST(Proxy, DirectionDoesNotLagBehindAFasterSlide) {
  Random random(drawn_seed("Proxy.DirectionDoesNotLagBehindAFasterSlide"));
  for (const double speed : {0.5, 2.0, 10.0, 50.0}) {
    Figures worst;
    for (int i = 0; i < 6; ++i)
      worst.grow(press_and_slide(random, shipped_bur("round-1.0"), speed));
    std::printf(
        "plane, round-1.0, sliding at %4.1f mm/s: X %.2f %%, ripple %.2f %%, direction %.2f deg\n",
        speed, worst.depth_percent, worst.ripple_percent, worst.degrees);
    EXPECT_LE(worst.degrees, 3.0) << speed;
    EXPECT_LE(worst.ripple_percent, 2.0) << speed;
  }
}

TEST(Proxy, EveryBurFeelsAPlane) {
  Random random(drawn_seed("Proxy.EveryBurFeelsAPlane"));
  for (const auto& name : bur_names()) {
    Figures worst;
    for (int i = 0; i < 5; ++i) worst.grow(press_and_slide(random, shipped_bur(name)));
    std::printf(
        "plane, %-18s: X at rest %5.2f %%, sliding: X %5.2f %%, ripple %5.2f %%, direction %5.2f deg\n",
        name.c_str(), worst.at_rest_percent, worst.depth_percent, worst.ripple_percent,
        worst.degrees);
    // An edge is felt 0.08 mm round (contact_tool.h), so up to 0.04 of 0.25 mm are missing on heads
    // that end in one; on all others nothing is.
    const bool edged =
        name == "cylinder-flat-1.0" || name == "inverted-cone-1.0" || name == "taper-flat-1.0";
    EXPECT_LE(worst.depth_percent, edged ? 20.0 : 1.0) << name;
    EXPECT_LE(worst.ripple_percent, 1.5) << name;
    EXPECT_LE(worst.degrees, 3.0) << name;
  }
}

TEST(Proxy, ForceNeverDropsOutWhileTheToothHoldsTheBurOff) {
  // Sharp burs touch with a single sample; still k must be that of the tissue, in every tick.
  const auto drops = [](const char* name, std::uint64_t seed) {
    Random random(seed);
    const double dropped = press_and_slide(random, shipped_bur(name)).dropped;
    EXPECT_EQ(dropped, 0) << name << ", seed " << seed << ": ticks with F other than k X";
  };
  const std::uint64_t seed = drawn_seed("Proxy.ForceNeverDropsOutWhileTheToothHoldsTheBurOff");
  for (const char* name :
       {"taper-flat-1.0", "cylinder-flat-1.0", "inverted-cone-1.0", "needle-0.8"})
    for (std::uint64_t i = 0; i < 8; ++i) drops(name, seed + i);
  drops("needle-0.8", 74);  // these once did
  drops("needle-0.8", 81);
  drops("taper-flat-1.0", 69);
  drops("cylinder-flat-1.0", 68);
}

/// Presses the ball of round-1.0 radially onto a curved surface and slides it around; worst error
/// of X in percent.
double curved_error_percent(const Tooth& tooth, Vec3 middle, double radius, Vec3 from, Vec3 to) {
  constexpr double x = 0.25;
  Rig rig(tooth, {shipped_bur("round-1.0")}, hard_model(0.8, 0), {0, 0, 9});
  double worst = 0;
  const auto pose = [&](double f, double depth) {
    const Vec3 out = normalized(from + (to - from) * f);
    // the tool stands along the surface's normal; the ball's centre is 0.5 mm from the tip
    return std::pair{middle + out * (radius - depth), rotation_between({0, 0, 1}, out)};
  };
  const auto start = pose(0, -0.3);
  rig.state = make_servo_state(rig.model, tooth, start.first);
  for (int i = 0; i <= 55; ++i) {
    const auto [tip, turned] = pose(0, -0.3 + 0.01 * i);
    (void)rig.tick(tip, 0, turned);
  }
  for (int i = 0; i <= 1000; ++i) {
    const auto [tip, turned] = pose(i / 1000.0, x);
    const TickOutput out = rig.tick(tip, 0, turned);
    worst = std::max(worst, std::fabs(out.model_force_n / 0.8 - x) / x * 100);
  }
  return worst;
}

TEST(Proxy, OnABallAndACylinderForceIsWithin3Percent) {
  Random random(drawn_seed("Proxy.OnABallAndACylinderForceIsWithin3Percent"));
  double ball = 0, cylinder = 0;
  for (int i = 0; i < 6; ++i) {
    const Vec3 middle{random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05),
                      random.uniform(-0.05, 0.05)};
    const double radius = random.uniform(1.5, 2.0);
    const Vec3 h{2.4, 2.4, 2.4};
    const Tooth round =
        tooth_of([&](Vec3 p) { return length(p - middle) - radius; }, -h, h, k_leaf);
    const Vec3 from = random_direction(random),
               aside = normalized(cross(from, random_direction(random)));
    ball = std::max(ball, curved_error_percent(round, middle, radius, from, from * 0.5 + aside));
    const Vec3 axis = random_direction(random),
               u = normalized(cross(axis, random_direction(random))), v = cross(axis, u);
    const Tooth rod =
        tooth_of([&](Vec3 p) { return length(cross(p - middle, axis)) - radius; }, -h, h, k_leaf);
    cylinder =
        std::max(cylinder, curved_error_percent(rod, middle, radius, u, normalized(u * 0.5 + v)));
  }
  std::printf("ball of 1.5-2 mm: X error %.2f %%; cylinder: %.2f %%\n", ball, cylinder);
  EXPECT_LE(ball, 3.0);
  EXPECT_LE(cylinder, 3.0);
}

constexpr int k_pushes =
    42;  // by each of twelve burs, against a thin wall and into a corner: 1,008 in all

struct PushFigures {
  double inside_leaves = 0, flipped = 0, peak_x = 0;
};

/// Pushes from the free side; the device ends where k = 0.8 N/mm gives 3.3 N. `distance` is that of
/// the solid, `out` a way out of it.
template <class Distance>
PushFigures push(Random& random, const ContactTool& tool, const Octree& tooth, Vec3 start, Vec3 end,
                 Quat turned, const Distance& distance, Vec3 out) {
  ContactState state = make_contact_state({tool}, start);
  ContactScratch scratch = make_contact_scratch({tool});
  PushFigures f;
  const double speed = std::exp(random.uniform(std::log(2.0), std::log(200.0)));  // mm/s
  const int n = std::clamp(static_cast<int>(length(end - start) / speed * 1000), 10, 1000);
  for (int i = 1; i <= n + 20; ++i) {
    const double share = std::min(1.0, static_cast<double>(i) / n);
    const auto r =
        solve_proxy(tooth, tool, 0, {start + (end - start) * share, turned}, state, scratch);
    if (r.touching) f.flipped = std::max(f.flipped, -dot(r.normal, out));
    f.peak_x = std::max(f.peak_x, r.penetration_mm);
    if (i % 8 == 0 || i >= n)
      f.inside_leaves =
          std::max(f.inside_leaves, deepest_mm(tool, state.proxy_mm, turned, distance) / k_leaf);
  }
  return f;
}

TEST(Proxy, NoBurPopsThroughAThinWallUpTo3_3N) {
  Random random(drawn_seed("Proxy.NoBurPopsThroughAThinWallUpTo3_3N"));
  constexpr double thickness = 0.3;
  const Tooth wall = make_block({16, 16, thickness}, {{"enamel", thickness}}, k_leaf);
  const auto distance = [](Vec3 p) { return std::max(p.z, -thickness - p.z); };
  double inside = 0;
  for (const auto& name : bur_names()) {
    const ContactTool tool = make_contact_tool(shipped_bur(name));
    for (int i = 0; i < k_pushes; ++i) {
      const Quat turned = leaning(random, {0, 0, 1}, 40 * k_pi / 180);
      const double lift = -height_over_plane_mm(tool.bur, {0, 0, 0}, turned, {0, 0, 1}, 0);
      const Vec3 start{random.uniform(-1, 1), random.uniform(-1, 1),
                       lift + random.uniform(0.02, 0.3)};
      const Vec3 end{start.x + random.uniform(-1.5, 1.5), start.y + random.uniform(-1.5, 1.5),
                     lift - 3.3 / 0.8};
      const auto f = push(random, tool, wall.octree, start, end, turned, distance, {0, 0, 1});
      inside = std::max(inside, f.inside_leaves);
      ASSERT_LE(f.inside_leaves, 0.5) << name << " push " << i;
      ASSERT_LE(f.flipped, 0.0) << name << " push " << i;
      ASSERT_GT(f.peak_x, 3.3 / 0.8 - 0.05) << name << " push " << i;
    }
  }
  std::printf("thin wall: proxy at most %.3f leaves inside\n", inside);
}

TEST(Proxy, NoBurPopsIntoAnInnerCornerUpTo3_3N) {
  Random random(drawn_seed("Proxy.NoBurPopsIntoAnInnerCornerUpTo3_3N"));
  const auto distance = [](Vec3 p) {
    return p.x < 0 && p.z < 0 ? -std::hypot(p.x, p.z) : std::min(p.x, p.z);
  };
  const Tooth corner = tooth_of(distance, {-1, -2.5, -1}, {6, 2.5, 6}, k_leaf);
  double inside = 0;
  for (const auto& name : bur_names()) {
    const ContactTool tool = make_contact_tool(shipped_bur(name));
    for (int i = 0; i < k_pushes; ++i) {
      const Vec3 out = normalized(Vec3{1, 0, 1});
      const Quat turned = leaning(random, out, 25 * k_pi / 180);
      const Vec3 start = out * random.uniform(1.2, 2.0) + Vec3{0, random.uniform(-0.5, 0.5), 0};
      const double way =
          random.uniform(-0.6, 0.6);  // into the corner, more against one wall or the other
      const Vec3 end = start + normalized(Vec3{-1 + way, random.uniform(-0.2, 0.2), -1 - way}) *
                                   (length(start) + 3.3 / 0.8 - 1);
      const auto f = push(random, tool, corner.octree, start, end, turned, distance, out);
      inside = std::max(inside, f.inside_leaves);
      ASSERT_LE(f.inside_leaves, 0.75) << name << " push " << i;
      ASSERT_LE(f.flipped, 0.0) << name << " push " << i;
      ASSERT_GT(f.peak_x, 1.0) << name << " push " << i;
    }
  }
  std::printf("inner corner: proxy at most %.3f leaves inside\n", inside);
}

TEST(Proxy, ABallInAnInnerCornerRestsWhereGeometryPutsIt) {
  Random random(drawn_seed("Proxy.ABallInAnInnerCornerRestsWhereGeometryPutsIt"));
  const auto distance = [](Vec3 p) {
    return p.x < 0 && p.z < 0 ? -std::hypot(p.x, p.z) : std::min(p.x, p.z);
  };
  const Tooth corner = tooth_of(distance, {-1, -1.5, -1}, {4, 1.5, 4}, k_leaf);
  const ContactTool tool = make_contact_tool(shipped_bur("round-1.0"));
  const Quat turned = rotation_between({0, 0, 1}, normalized(Vec3{1, 0, 1}));
  const Vec3 to_centre = rotation(turned) * Vec3{0, 0, 0.5};
  double worst = 0, worst_degrees = 0;
  for (int i = 0; i < 60; ++i) {
    ContactState state = make_contact_state({tool}, Vec3{1.5, 0, 1.5} - to_centre);
    ContactScratch scratch = make_contact_scratch({tool});
    const Vec3 centre{random.uniform(-0.5, 1), random.uniform(-0.2, 0.2),
                      random.uniform(-0.5, 0.3)};
    ContactResult r;
    for (int t = 1; t <= 400; ++t) {
      const Vec3 at = Vec3{1.5, 0, 1.5} + (centre - Vec3{1.5, 0, 1.5}) * std::min(1.0, t / 300.0);
      r = solve_proxy(corner.octree, tool, 0, {at - to_centre, turned}, state, scratch);
    }
    const Vec3 rests{std::max(centre.x, 0.5), centre.y,
                     std::max(centre.z, 0.5)};  // nearest place where the ball fits
    const double x = length(rests - centre);
    if (x < 0.2) continue;
    worst = std::max(worst, std::fabs(r.penetration_mm - x) / x * 100);
    worst_degrees = std::max(worst_degrees, degrees_between(r.normal, rests - centre));
  }
  std::printf("ball in an inner corner: X error %.2f %%, direction %.2f deg\n", worst,
              worst_degrees);
  EXPECT_LE(worst, 3.0);
  EXPECT_LE(worst_degrees, 6.0);
}

TEST(Proxy, InAirThereIsNoForceAndTheProxyIsTheDevice) {
  Random random(drawn_seed("Proxy.InAirThereIsNoForceAndTheProxyIsTheDevice"));
  const Tooth block = make_block({2, 2, 2}, {{"enamel", 2}}, k_leaf);
  for (const auto& name : bur_names()) {
    const Bur bur = shipped_bur(name);
    Rig rig(block, {bur}, shipped_model("paper"), {0, 0, 3});
    Vec3 tip{0, 0, 3};
    for (int i = 0; i < 600; ++i) {
      // Nothing may stand in the way: the tool turns where it is, then moves; both places are over
      // the top face.
      const Quat turned = leaning(random, {0, 0, 1}, 1.2);
      Vec3 next = tip + random_direction(random) * 0.1;
      next = {std::clamp(next.x, -3.0, 3.0), std::clamp(next.y, -3.0, 3.0), std::min(next.z, 4.0)};
      const double over = std::min(height_over_plane_mm(bur, next, turned, {0, 0, 1}, 0),
                                   height_over_plane_mm(bur, tip, turned, {0, 0, 1}, 0));
      if (over < 0.005) continue;
      tip = next;
      const TickOutput out = rig.tick(tip, 1.0, turned);
      ASSERT_EQ(out.model_force_n, 0.0) << name;
      ASSERT_EQ(out.penetration_mm, 0.0) << name;
      ASSERT_EQ(length(out.rendered_force_n), 0.0) << name;
      ASSERT_FALSE(out.contact) << name;
      ASSERT_LE(length(out.proxy_mm - tip), 3e-5) << name;
      ASSERT_EQ(out.removed_count, 0u) << name;
    }
  }
}

TEST(Proxy, TheMeansOfTwoTissuesAreThoseOfTheAreasTouched) {
  // A flat end over a border between two tissues: k must be weighted by the share of the disc on
  // each side.
  const double r = 0.5;
  for (const double border : {-0.6, -0.3, -0.1, 0.0, 0.2, 0.35, 0.6}) {
    const Tooth tooth = tooth_of([](Vec3 p) { return p.z; }, {-1, -1, -1}, {1, 1, 1}, k_leaf,
                                 [&](Vec3 p) { return p.x < border ? k_enamel : k_dentin; });
    ForceModel force = hard_model(0.4, 0);
    force.materials.find("enamel")->second.voigt.stiffness_n_per_mm = 1.2;
    Rig rig(tooth, {shipped_bur("cylinder-flat-1.0")}, force, {0, 0, 0.2});
    (void)rig.travel({0, 0, 0.2}, {0, 0, -0.2}, 10);
    const TickOutput out = rig.tick({0, 0, -0.2}, 0);
    const double b = std::clamp(border, -r, r);
    const double enamel =
        (r * r * (std::asin(b / r) + k_pi / 2) + b * std::sqrt(r * r - b * b)) / (k_pi * r * r);
    EXPECT_NEAR(out.stiffness_n_per_mm, 0.4 + 0.8 * enamel, 0.06) << "border at " << border;
  }
}

}  // namespace
}  // namespace cavum
