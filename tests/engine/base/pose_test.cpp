#include "engine/base/pose.h"

#include <gtest/gtest.h>

#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

void expect_near(Vec3 a, Vec3 b, double tolerance) { EXPECT_LE(length(a - b), tolerance); }

/// v turned by unit quaternion q as q v q*, multiplied out: a second way to the same rotation.
Vec3 sandwich(Quat q, Vec3 v) {
  const Vec3 u{q.x, q.y, q.z};
  const Vec3 t = cross(u, v) * 2.0;
  return v + t * q.w + cross(u, t);
}

TEST(Pose, RotationMatricesAreOrthonormalAndRightHanded) {
  Random random(drawn_seed("Pose.RotationMatricesAreOrthonormalAndRightHanded"));
  for (int i = 0; i < 2000; ++i) {
    const Mat3 m = rotation(random_rotation(random));
    for (const Vec3 row : {m.row_x, m.row_y, m.row_z}) EXPECT_NEAR(length(row), 1.0, 1e-14);
    EXPECT_NEAR(dot(m.row_x, m.row_y), 0, 1e-14);
    EXPECT_NEAR(dot(m.row_y, m.row_z), 0, 1e-14);
    EXPECT_NEAR(dot(m.row_z, m.row_x), 0, 1e-14);
    expect_near(cross(m.row_x, m.row_y), m.row_z, 1e-14);
    const Vec3 v = random_direction(random);
    expect_near(m.transposed(m * v), v, 1e-14);
  }
}

TEST(Pose, MatrixTurnsAsTheQuaternionDoes) {
  Random random(drawn_seed("Pose.MatrixTurnsAsTheQuaternionDoes"));
  for (int i = 0; i < 2000; ++i) {
    const Quat q = random_rotation(random);
    const Vec3 v = random_direction(random);
    expect_near(rotation(q) * v, sandwich(q, v), 1e-14);
  }
  const double h = std::sqrt(0.5);  // a quarter turn about z carries x to y
  expect_near(rotation({h, 0, 0, h}) * Vec3{1, 0, 0}, {0, 1, 0}, 1e-15);
}

TEST(Pose, RotationBetweenCarriesOneDirectionOntoTheOther) {
  Random random(drawn_seed("Pose.RotationBetweenCarriesOneDirectionOntoTheOther"));
  for (int i = 0; i < 2000; ++i) {
    const Vec3 from = random_direction(random), to = random_direction(random);
    expect_near(rotation(rotation_between(from, to)) * from, to, 1e-9);
  }
  for (const Vec3 from : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
    expect_near(rotation(rotation_between(from, -from)) * from, -from, 1e-12);
    expect_near(rotation(rotation_between(from, from)) * from, from, 1e-15);
  }
}

// Half the angle between two unit vectors is that of a right triangle with the legs |to - from| and
// |to + from|: good to the last digits everywhere.
TEST(Pose, RotationBetweenIsTheShortestUpToOppositeDirections) {
  Random random(drawn_seed("Pose.RotationBetweenIsTheShortestUpToOppositeDirections"));
  for (int i = 0; i < 40000; ++i) {
    const Vec3 from = random_direction(random);
    const Vec3 across = normalized(cross(from, random_direction(random)));
    const double off =
        i % 50 == 49 ? 0.0
                     : std::pow(10.0, -i % 50 / 2.5);  // 1 down to 1e-19 rad from the opposite
    const Vec3 to = normalized(across * std::sin(off) - from * std::cos(off));
    const Quat q = rotation_between(from, to);
    const Vec3 v{q.x, q.y, q.z};
    ASSERT_NEAR(q.w * q.w + dot(v, v), 1.0, 1e-15) << off;
    ASSERT_LE(length(rotation(q) * from - to), 1e-12) << off << " rad from the opposite";
    ASSERT_LE(length(sandwich(q, from) - to), 1e-12) << off;
    ASSERT_NEAR(2 * std::atan2(length(v), q.w),
                2 * std::atan2(length(to - from), length(to + from)), 1e-12)
        << off;
    ASSERT_NEAR(dot(v, from), 0.0, 1e-12) << "the axis of the shortest lies across both, " << off;
    ASSERT_NEAR(dot(v, to), 0.0, 1e-12) << off;
  }
}

// Kept exams were recorded with it.
TEST(Pose, RotationBetweenKeepsItsBitsAwayFromOppositeDirections) {
  Random random(drawn_seed("Pose.RotationBetweenKeepsItsBitsAwayFromOppositeDirections"));
  for (int i = 0; i < 2000; ++i) {
    const Vec3 from = random_direction(random);
    const Vec3 across = normalized(cross(from, random_direction(random)));
    const double off = 0.0015 * std::pow(2000.0, random.uniform());
    const Vec3 to = normalized(across * std::sin(off) - from * std::cos(off)), c = cross(from, to);
    EXPECT_EQ(rotation_between(from, to), normalized(Quat{1.0 + dot(from, to), c.x, c.y, c.z}))
        << off;
  }
}

TEST(Pose, ShortQuaternionBecomesNoRotation) {
  EXPECT_EQ(normalized(Quat{0, 0, 0, 0}), Quat{});
  EXPECT_EQ(normalized(Quat{NAN, 0, 0, 0}), Quat{});
}

}  // namespace
}  // namespace cavum
