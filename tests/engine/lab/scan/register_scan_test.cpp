// Registration against poses that are known, and what a scan shows of the tooth.
#include "engine/lab/scan/register_scan.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/lab/scan/cut_by_scan.h"
#include "engine/lab/scan/holes.h"
#include "engine/lab/scan/scale_fit.h"
#include "engine/lab/scan/scan_fit.h"
#include "engine/tooth/make/make_block.h"
#include "engine/tooth/make/make_molar.h"
#include "engine/tooth/octree_edit.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

using testing_basics::drawn_seed;

Mat3 any_turn(Random& random) {
  return rotation(
      normalized(Quat{random.normal(), random.normal(), random.normal(), random.normal()}));
}

const Tooth& molar() {
  static const Tooth k_tooth = make_molar({.leaf_mm = 0.1});
  return k_tooth;
}
const OuterSurface& outside() {
  static const OuterSurface k_outside(molar());
  return k_outside;
}

/// 4 mm long, 1.6 mm wide, down to 0.5 mm.
Tooth molar_with_a_slot() {
  Tooth tooth = molar();
  std::vector<RemovedLeaf> removed;
  removed.reserve(400000);
  tooth.octree.reserve_edits(40000);
  const bool carved = tooth.octree.carve(
      {-3, -2, -1}, {3, 2, 5},
      [](Vec3 p) {
        return std::max({std::fabs(p.x) - 2.0, std::fabs(p.y) - 0.8, 0.5 - p.z});
      },
      removed);
  EXPECT_TRUE(carved);
  return tooth;
}

/// What tells two poses apart: the largest way between them of the corners of a box as large as the
/// tooth.
double apart_mm(const Rigid& a, const Rigid& b) {
  double most = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3 p{(i & 1) != 0 ? 5.0 : -5.0, (i & 2) != 0 ? 5.0 : -5.0, (i & 4) != 0 ? 3.0 : -15.0};
    most = std::max(most, length(a * p - b * p));
  }
  return most;
}

TEST(Registration, ASmallMotionIsWorkedOutFromPlanesAlone) {
  Random random(drawn_seed("Registration.ASmallMotion"));
  const Rigid true_motion{rotation(normalized(Quat{1, 0.001, -0.002, 0.0015})),
                          {0.01, -0.02, 0.03}};
  PlaneSteps steps({1, 2, 3});
  for (int i = 0; i < 200; ++i) {
    const Vec3 p{random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-5, 5)},
        n = normalized(Vec3{random.normal(), random.normal(), random.normal()});
    steps.add(p, n, dot(p - true_motion * p, n), 1.0);
  }
  const auto found = steps.solve();
  ASSERT_TRUE(found.has_value());
  EXPECT_LT(apart_mm(*found, true_motion), 2e-4);  // second order of a motion of 0.05 mm
  EXPECT_FALSE(PlaneSteps({}).solve().has_value());
}

TEST(Registration, FindsAnyPoseOfANoisyCrownWithACavity) {
  Random random(drawn_seed("Registration.FindsAnyPose"));
  const Tooth drilled = molar_with_a_slot();
  TriangleMesh mesh = outer_surface(drilled, outside().outside());
  TriangleMesh crown{mesh.vertices_mm, {}};
  for (const auto& t : mesh.triangles)
    if (std::all_of(t.begin(), t.end(),
                    [&](std::uint32_t v) { return mesh.vertices_mm[v].z > -3.5; }))
      crown.triangles.push_back(t);
  for (Vec3& v : crown.vertices_mm)
    v += Vec3{random.normal(), random.normal(), random.normal()} * 0.01;

  for (int pose = 0; pose < 4; ++pose) {
    const Mat3 turn = any_turn(random);
    const Rigid true_pose{
        turn, Vec3{random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-50, 50)}};
    TriangleMesh scan = crown;  // true_pose carries the scan into the tooth's frame
    for (Vec3& v : scan.vertices_mm) v = turn.transposed(v - true_pose.shift_mm);
    const auto points = surface_points(scan, 0.15, "scan");
    const auto found = register_scan(points, outside());
    ASSERT_TRUE(found.has_value());
    double most = 0;
    for (std::size_t i = 0; i < scan.vertices_mm.size(); i += 997)
      most = std::max(most, length(found->best.to_tooth * scan.vertices_mm[i] -
                                   true_pose * scan.vertices_mm[i]));
    EXPECT_LT(most, 0.005);
    if (found->second) {
      EXPECT_LT(found->second->share, 0.8 * found->best.share);
    }
    const ScanFit fit = fit_of(points, found->best.to_tooth, outside());
    EXPECT_LT(fit.form_mm, 0.006);
    EXPECT_GT(agreement(fit), 0.96);
    EXPECT_NO_THROW(require_same_tooth(fit, "scan.stl"));
  }
}

TEST(Registration, WhatIsCutIsWhatWasCarvedAndTheRootThatIsNotSeenStays) {
  Tooth drilled = molar();
  std::vector<RemovedLeaf> carved;
  carved.reserve(400000);
  drilled.octree.reserve_edits(40000);
  ASSERT_TRUE(drilled.octree.carve(
      {-3, -2, -1}, {3, 2, 5},
      [](Vec3 p) {
        return std::max({std::fabs(p.x) - 2.03, std::fabs(p.y) - 0.82, 0.47 - p.z});
      },
      carved));
  const TriangleMesh whole = outer_surface(drilled, outside().outside());
  TriangleMesh crown{whole.vertices_mm, {}};
  for (const auto& t : whole.triangles)
    if (std::all_of(t.begin(), t.end(),
                    [&](std::uint32_t v) { return whole.vertices_mm[v].z > -4.0; }))
      crown.triangles.push_back(t);
  for (const TriangleMesh* scan : {&whole, static_cast<const TriangleMesh*>(&crown)}) {
    const auto rims = rims_of(*scan);
    const ScanCut cut = cut_by_scan(*scan, caps_over(*scan, rims), outside(), 0.02, "scan.stl");
    EXPECT_EQ(cut.cavities, 1);
    // leaves whose centre lies within a hundredth of a millimetre of the surface may go either way,
    // and those in a rim thinner than 0.02 mm stay
    EXPECT_NEAR(static_cast<double>(cut.removed.size()), static_cast<double>(carved.size()),
                0.01 * static_cast<double>(carved.size()));
    std::size_t wrong = 0;
    for (const auto& r : cut.removed) wrong += drilled.octree.tissue(r.leaf()) != k_air ? 1 : 0;
    EXPECT_LT(wrong, carved.size() / 200);
    // distances of what was left: those of the carve, to a fifth of a leaf
    double off = 0;
    int count = 0;
    for (const auto& r : cut.removed)
      for (const IVec3 step : {IVec3{1, 0, 0}, IVec3{0, 1, 0}, IVec3{0, 0, -1}}) {
        const IVec3 leaf = r.leaf() + step;
        if (!drilled.octree.is_solid(drilled.octree.tissue(leaf)) ||
            !cut.after.is_solid(cut.after.tissue(leaf)))
          continue;
        off += std::fabs(decode_distance(drilled.octree.distance_code(leaf)) -
                         decode_distance(cut.after.distance_code(leaf)));
        ++count;
      }
    ASSERT_GT(count, 500);
    EXPECT_LT(off / count, 0.2);
    if (scan == &crown) {
      EXPECT_GT(cut.unseen_mm3, 50.0);
    }
  }
}

/// A ball whose deepest place lies `deep_mm` inside the crown, on the way from (0, 0, z) along
/// `to`: by the vertices of the surface alone.
Vec3 ball_into(const TriangleMesh& surface, Vec3 from, Vec3 to, double radius_mm, double deep_mm) {
  const auto nearest = [&](Vec3 c) {
    double least = 1e9;
    for (const Vec3& v : surface.vertices_mm) least = std::min(least, length(v - c));
    return least;
  };
  // from far outside inwards: the first place where the surface is as near as the ball is to reach
  // into it
  double far = 12;
  while (nearest(from + to * far) > radius_mm - deep_mm) far -= 0.005;
  return from + to * far;
}

ScanCut cut_of_slot_and_ball(Vec3 centre, double radius_mm, std::vector<RemovedLeaf>& ball) {
  Tooth tooth = molar_with_a_slot();
  ball.reserve(400000);
  tooth.octree.reserve_edits(40000);
  const Vec3 r{radius_mm + 0.3, radius_mm + 0.3, radius_mm + 0.3};
  EXPECT_TRUE(tooth.octree.carve(
      centre - r, centre + r, [&](Vec3 p) { return length(p - centre) - radius_mm; }, ball));
  const TriangleMesh scan = outer_surface(tooth, outside().outside());
  return cut_by_scan(scan, caps_over(scan, rims_of(scan)), outside(), 0.02, "scan.stl");
}

// What is thin and lies apart is named and stays; what is thick there, or thin but part of the
// cavity, is removed.
TEST(Registration, AThinPieceApartIsNamedAndNotCountedAThickOneIs) {
  const TriangleMesh surface = outer_surface(molar(), outside().outside());
  const Vec3 side = normalized(Vec3{0.9, 0.43, 0.0});
  for (const double deep_mm : {0.2, 0.45}) {
    std::vector<RemovedLeaf> ball;
    const Vec3 centre = ball_into(surface, {0, 0, -1.0}, side, 1.0, deep_mm);
    const ScanCut cut = cut_of_slot_and_ball(centre, 1.0, ball);
    ASSERT_GT(ball.size(), 50u);
    std::size_t gone = 0;
    for (const auto& r : ball) gone += cut.after.tissue(r.leaf()) == k_air ? 1 : 0;
    if (deep_mm < 0.3) {
      EXPECT_EQ(cut.cavities, 1);
      EXPECT_EQ(gone, 0u);
      ASSERT_EQ(cut.apart.size(), 1u);
      EXPECT_NEAR(cut.apart[0].deep_mm, deep_mm, 0.03);
      EXPECT_LT(length(cut.apart[0].at_mm - centre), 1.1);
      EXPECT_NEAR(cut.apart[0].mm3, static_cast<double>(ball.size()) * 0.001,
                  0.3 * static_cast<double>(ball.size()) * 0.001);
    } else {
      EXPECT_EQ(cut.cavities, 2);
      EXPECT_TRUE(cut.apart.empty());
      EXPECT_NEAR(static_cast<double>(gone), static_cast<double>(ball.size()),
                  0.05 * static_cast<double>(ball.size()));
    }
  }
  // as thin as the first, but beside the slot and joined to it: nothing is left out
  std::vector<RemovedLeaf> ball;
  const double radius_mm = 0.8;
  double height = 5;
  for (const Vec3 v : surface.vertices_mm)
    if (std::fabs(v.x - 1.9) < 0.1 && std::fabs(v.y) < 0.1) height = v.z;
  const ScanCut cut = cut_of_slot_and_ball({2.0, 0, height + radius_mm - 0.2}, radius_mm, ball);
  std::size_t gone = 0;
  for (const auto& r : ball) gone += cut.after.tissue(r.leaf()) == k_air ? 1 : 0;
  ASSERT_GT(ball.size(), 20u);
  EXPECT_EQ(cut.cavities, 1);
  EXPECT_TRUE(cut.apart.empty());
  EXPECT_GT(gone, ball.size() * 8 / 10);
}

// A block with a hole, and a shallow hollow beside it: 0.09 mm deep, 1.9 mm wide.
TEST(Registration, AShallowGrindingOfSomeSquareMillimetresIsNamed) {
  const Tooth block = make_block({8, 5, 3}, {{"enamel", 1.0}, {"dentin", 2.0}}, 0.05);
  const OuterSurface surface(block);
  Tooth ground = block;
  ground.octree.reserve_edits(40000);
  std::vector<RemovedLeaf> removed;
  removed.reserve(400000);
  const double radius_mm = 5.0, deep_mm = 0.09;
  const Vec3 centre{2.0, 0, radius_mm - deep_mm};
  ASSERT_TRUE(ground.octree.carve(
      {-3, -1.5, -1.5}, {-1, 1.5, 0.5},
      [](Vec3 p) { return std::max(std::hypot(p.x + 2, p.y) - 0.7, -1.0 - p.z); }, removed));
  ASSERT_TRUE(ground.octree.carve(
      {0.5, -1.5, -0.5}, {3.5, 1.5, 0.5}, [&](Vec3 p) { return length(p - centre) - radius_mm; },
      removed));
  const TriangleMesh scan = outer_surface(ground, surface.outside());
  const ScanCut cut = cut_by_scan(scan, caps_over(scan, rims_of(scan)), surface, 0.03, "scan.stl");
  EXPECT_EQ(cut.cavities, 1);
  ASSERT_EQ(cut.apart.size(), 1u);
  EXPECT_NEAR(cut.apart[0].deep_mm, deep_mm, 0.03);
  EXPECT_NEAR(cut.apart[0].at_mm.x, centre.x, 1.0);
}

// A crown with a cavity and 10 um of noise, measured too large or too small by a scanner.
TEST(ScaleFit, TellsByHowMuchAScanIsTooLarge) {
  Random random(drawn_seed("ScaleFit.TellsByHowMuch"));
  const Tooth drilled = molar_with_a_slot();
  const TriangleMesh whole = outer_surface(drilled, outside().outside());
  for (const double size : {1.01, 0.985, 1.03, 0.95}) {
    TriangleMesh scan{whole.vertices_mm, {}};
    for (const auto& t : whole.triangles)
      if (std::all_of(t.begin(), t.end(),
                      [&](std::uint32_t v) { return whole.vertices_mm[v].z > -3.5; }))
        scan.triangles.push_back(t);
    const Mat3 turn = any_turn(random);
    for (Vec3& v : scan.vertices_mm)
      v = turn * (v + Vec3{random.normal(), random.normal(), random.normal()} * 0.01) * size +
          Vec3{7, -3, 20};
    const auto points = surface_points(scan, 0.15, "scan");
    const auto found = register_scan(points, outside());
    ASSERT_TRUE(found.has_value());
    EXPECT_FALSE(fits_tooth(fit_of(points, found->best.to_tooth, outside()))) << size;
    const auto sized = fit_with_scale(points, found->best.to_tooth, outside());
    ASSERT_TRUE(sized.has_value()) << size;
    EXPECT_NEAR(sized->scale * size, 1.0, 0.001);
    EXPECT_TRUE(fits_tooth(fit_of(in_size(points, sized->scale), sized->to_tooth, outside())))
        << size;
  }
}

TEST(Registration, AMirroredToothIsRefusedWithWhatWasFound) {
  Random random(drawn_seed("Registration.AMirroredTooth"));
  TriangleMesh mesh = outer_surface(molar(), outside().outside());
  for (Vec3& v : mesh.vertices_mm) v.x = -v.x;
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  const Mat3 turn = any_turn(random);
  for (Vec3& v : mesh.vertices_mm) v = turn * v;
  const auto points = surface_points(mesh, 0.15, "scan");
  const auto found = register_scan(points, outside());
  ASSERT_TRUE(found.has_value());
  const auto refused = testing_basics::thrown_by(
      [&] { require_same_tooth(fit_of(points, found->best.to_tooth, outside()), "scan.stl"); });
  EXPECT_EQ(testing_basics::code_of(refused), ScanError::another_tooth);
  EXPECT_EQ(testing_basics::place_of(refused), "scan.stl");
}

}  // namespace
}  // namespace cavum
