#include "engine/physics/bur/profile.h"

#include <gtest/gtest.h>

#include "engine/base/det_math.h"
#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

constexpr double k_step_mm = 0.001;

/// The profile as a polyline with steps of at most k_step_mm, made from its description alone.
std::vector<ProfilePoint> polyline(const Profile& profile) {
  std::vector<ProfilePoint> line{{0, 0}};
  for (const auto& s : profile.segments()) {
    const ProfilePoint a = line.back();
    if (!s.arc) {
      const double length = std::hypot(s.end.r_mm - a.r_mm, s.end.z_mm - a.z_mm);
      const int n = std::max(1, static_cast<int>(std::ceil(length / k_step_mm)));
      for (int i = 1; i <= n; ++i)
        line.push_back(
            {a.r_mm + (s.end.r_mm - a.r_mm) * i / n, a.z_mm + (s.end.z_mm - a.z_mm) * i / n});
    } else {
      const double radius = std::hypot(a.r_mm - s.centre.r_mm, a.z_mm - s.centre.z_mm);
      const double from = std::atan2(a.z_mm - s.centre.z_mm, a.r_mm - s.centre.r_mm);
      double turn = std::atan2(s.end.z_mm - s.centre.z_mm, s.end.r_mm - s.centre.r_mm) - from;
      if (turn > k_pi) turn -= 2 * k_pi;
      if (turn < -k_pi) turn += 2 * k_pi;
      const int n = std::max(1, static_cast<int>(std::ceil(std::fabs(turn) * radius / k_step_mm)));
      for (int i = 1; i <= n; ++i)
        line.push_back({s.centre.r_mm + radius * std::cos(from + turn * i / n),
                        s.centre.z_mm + radius * std::sin(from + turn * i / n)});
    }
  }
  return line;
}

/// Inside by parity: how often a ray outwards from (r, z) crosses the polyline.
bool inside(const std::vector<ProfilePoint>& line, double r, double z) {
  bool in = false;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const auto &a = line[i], &b = line[i + 1];
    if ((a.z_mm > z) == (b.z_mm > z)) continue;
    if (a.r_mm + (b.r_mm - a.r_mm) * (z - a.z_mm) / (b.z_mm - a.z_mm) > r) in = !in;
  }
  return in;
}

TEST(Profile, DistanceIsThatOfABallAtARoundTip) {
  Random random(drawn_seed("Profile.DistanceIsThatOfABallAtARoundTip"));
  const Bur round = shipped_bur("round-1.0");
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p{random.uniform(-1, 1), random.uniform(-1, 1),
                 random.uniform(-1, 0.5)};  // below the equator the ball is nearest
    EXPECT_NEAR(round.profile.distance_mm(p), length(p - Vec3{0, 0, 0.5}) - 0.5, 1e-12);
  }
}

TEST(Profile, DistanceIsThatOfACylinderAtItsSide) {
  Random random(drawn_seed("Profile.DistanceIsThatOfACylinderAtItsSide"));
  const Bur cylinder = shipped_bur("cylinder-flat-1.0");
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 2.5)};
    const double r = std::hypot(p.x, p.y), across = r - 0.5, below = -p.z;
    const double expected =
        across > 0 && below > 0 ? std::hypot(across, below) : std::max(across, below);
    EXPECT_NEAR(cylinder.profile.distance_mm(p), expected, 1e-12);
  }
}

TEST(Profile, DistanceIsThatOfAConeAtATaperedSide) {
  Random random(drawn_seed("Profile.DistanceIsThatOfAConeAtATaperedSide"));
  const Bur taper = shipped_bur("taper-flat-1.0");
  const double lean = std::atan(0.14 / 4);
  for (int i = 0; i < 5000; ++i) {
    const double r = random.uniform(0.3, 0.8), z = random.uniform(1, 3),
                 turn = random.uniform(-k_pi, k_pi);
    const double expected = (r - 0.36) * std::cos(lean) - z * std::sin(lean);
    EXPECT_NEAR(taper.profile.distance_mm({r * std::cos(turn), r * std::sin(turn), z}), expected,
                1e-12);
  }
}

TEST(Profile, DistanceOfEveryBurIsThatToTheNearestOfItsDenseOutline) {
  Random random(drawn_seed("Profile.DistanceOfEveryBurIsThatToTheNearestOfItsDenseOutline"));
  for (const auto& name : bur_names()) {
    const Bur bur = shipped_bur(name);
    const auto line = polyline(bur.profile);
    for (int i = 0; i < 300; ++i) {
      const double r = random.uniform(0, 1.6),
                   z = i % 3 == 0 ? random.uniform(-1, 20)
                                  : random.uniform(-0.5, bur.cutting_length_mm + 1);
      double nearest2 = 1e9;
      for (const auto& p : line)
        nearest2 = std::min(nearest2, (p.r_mm - r) * (p.r_mm - r) + (p.z_mm - z) * (p.z_mm - z));
      const double turn = random.uniform(-k_pi, k_pi);
      const double d = bur.profile.distance_mm({r * std::cos(turn), r * std::sin(turn), z});
      // the nearest of points k_step apart is at most half a step from the foot, which may lie on
      // an arc of 0.12 mm
      ASSERT_LE(std::fabs(d), std::sqrt(nearest2) + 1e-9) << name << " at r " << r << " z " << z;
      ASSERT_GE(std::sqrt(d * d + k_step_mm * k_step_mm / 4 * (1 + std::fabs(d) / 0.12)) + 1e-7,
                std::sqrt(nearest2))
          << name << " at r " << r << " z " << z;
      if (std::fabs(d) > 1e-4) {
        ASSERT_EQ(d < 0, inside(line, r, z)) << name << " at r " << r << " z " << z;
      }
    }
  }
}

TEST(Profile, GoesOnUpwardsAsACylinder) {
  const Bur round = shipped_bur("round-1.0");
  EXPECT_NEAR(round.profile.distance_mm({1.0, 0, 40}), 0.2, 1e-12);
  EXPECT_NEAR(round.profile.distance_mm({0, 0.5, 400}), -0.3, 1e-12);
  EXPECT_NEAR(round.profile.radius_mm(100), 0.8, 1e-12);
}

TEST(Profile, WalkStaysOnTheOutlineWithOutwardNormals) {
  for (const auto& name : bur_names()) {
    const Bur bur = shipped_bur(name);
    for (const auto& p : bur.profile.walk(0.01, bur.profile.length_mm())) {
      EXPECT_NEAR(std::hypot(p.normal.r_mm, p.normal.z_mm), 1.0, 1e-9) << name;
      EXPECT_NEAR(bur.profile.distance_mm({p.at.r_mm, 0, p.at.z_mm}), 0.0, 1e-9) << name;
      EXPECT_NEAR(bur.profile.distance_mm(
                      {p.at.r_mm + 1e-3 * p.normal.r_mm, 0, p.at.z_mm + 1e-3 * p.normal.z_mm}),
                  1e-3, 1e-5)
          << name << " " << p.at.z_mm;
    }
  }
}

TEST(Profile, ImpossibleOutlinesAreRefused) {
  const auto line = [](double r, double z) { return ProfileSegment{{r, z}, false, {}}; };
  const auto arc = [](double r, double z, double centre_r, double centre_z) {
    return ProfileSegment{{r, z}, true, {centre_r, centre_z}};
  };
  const auto refused = [](std::vector<ProfileSegment> s) {
    return thrown_by([&] { Profile p(std::move(s)); }).has_value();
  };
  EXPECT_TRUE(refused({}));
  EXPECT_TRUE(refused({line(0.5, 2), line(0.5, 1)})) << "heights fall";
  EXPECT_TRUE(refused({line(-0.5, 1)})) << "negative radius";
  EXPECT_TRUE(refused({line(0, 1)})) << "a shank without radius";
  EXPECT_TRUE(refused({arc(0.5, 0.5, 0, 0.4)})) << "arc whose ends are not equally far";
  EXPECT_TRUE(refused({line(NAN, 1)}));
  EXPECT_TRUE(refused({arc(0.5, 0.5, NAN, 0.5)})) << "arc about a centre that is no number";
  EXPECT_FALSE(refused({arc(0.5, 0.5, 0, 0.5), line(0.5, 3)}));
}

}  // namespace
}  // namespace cavum
