// Teeth set beside a tooth: how they touch, against closed forms of balls; that the tooth stays
// what it was; where the gum lies.
#include "engine/tooth/make/add_adjacent.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "engine/base/error.h"
#include "engine/tooth/adjacent.h"
#include "engine/tooth/make/in_a_row.h"
#include "engine/tooth/make/make_block.h"
#include "engine/tooth/make/make_molar.h"
#include "engine/tooth/make/make_premolar.h"
#include "engine/tooth/octree_edit.h"
#include "tests/engine/support/basics.h"
#include "tests/scenarios/test_teeth.h"

namespace cavum {
namespace {

constexpr double k_radius_mm = 2.0;

/// A ball of enamel about the origin.
Tooth ball(double radius_mm, double leaf_mm) {
  const auto field = [radius_mm](Vec3 p) { return length(p) - radius_mm; };
  const double r = radius_mm + 0.5;
  return testing::make_tooth(
      {-r, -r, -r}, {r, r, r}, leaf_mm, [&](Vec3 p) { return field(p) < 0 ? k_enamel : k_air; },
      field);
}

TEST(AddedAdjacent, BallsStandAsFarApartAsTheirCentresSay) {
  const Tooth one = ball(k_radius_mm, 0.05), other = ball(1.5, 0.05);
  for (const double wanted : {0.0, 0.03, 0.05}) {
    AdjacentSpec spec;
    spec.mesial.tooth = &other;
    spec.contact_mm = wanted;
    const AddedAdjacent set = add_adjacent(one, spec, "here");
    ASSERT_TRUE(set.mesial);
    EXPECT_NEAR(set.mesial->gap_mm, wanted, 0.002);
    EXPECT_NEAR(length(set.mesial->at_mm - Vec3{k_radius_mm, 0, 0}), 0.0, 0.05);
    // the neighbour's far side is cut off at the reach; its near pole and its waist are where a
    // ball of 1.5 mm at that distance has them
    const Octree neighbour = neighbours_alone(set.tooth);
    const Vec3 centre{k_radius_mm + wanted + 1.5, 0, 0};
    Octree::Cursor cursor;
    for (const Vec3 way : {Vec3{-1, 0, 0}, Vec3{-0.8, 0.6, 0}, Vec3{-0.6, 0, 0.8}, Vec3{0, 1, 0}})
      EXPECT_NEAR(neighbour.sample(centre + way * 1.53, cursor).distance_mm, 0.03, 0.006)
          << wanted << " " << way.x;
    // within 0.05 mm of the least: rho²/2 (1/R + 1/r) = 0.05
    const double rho = std::sqrt(0.1 / (1 / k_radius_mm + 1 / 1.5));
    EXPECT_NEAR(set.mesial->width_mm, 2 * rho, 0.12);
  }
}

TEST(AddedAdjacent, OnTheDistalSideToo) {
  const Tooth one = ball(k_radius_mm, 0.1);
  AdjacentSpec spec;
  spec.distal.tooth = &one;
  const AddedAdjacent set = add_adjacent(one, spec, "here");
  ASSERT_TRUE(set.distal);
  EXPECT_FALSE(set.mesial);
  EXPECT_NEAR(set.distal->at_mm.x, -k_radius_mm, 0.05);
  EXPECT_EQ(set.tooth.octree.tissue_at({-k_radius_mm - 0.5, 0, 0}), k_neighbour_enamel);
  EXPECT_EQ(set.tooth.octree.tissue_at({-k_radius_mm + 0.5, 0, 0}), k_enamel);
}

/// Molar beside premolar, in gum; as the paper's teeth go, at coarse leaves.
const Tooth& row_molar() {
  static const Tooth tooth = [] {
    MolarShape shape;
    shape.leaf_mm = 0.1;
    return make_molar(shape);
  }();
  return tooth;
}
const AddedAdjacent& molar_in_row() {
  static const AddedAdjacent set = [] {
    PremolarShape shape;
    shape.leaf_mm = 0.1;
    const Tooth premolar = make_premolar(shape);
    AdjacentSpec spec;
    spec.mesial.tooth = &premolar;
    spec.distal.tooth = &row_molar();
    spec.gum = true;
    spec.confirmed = true;  // a lower molar between an upper premolar and its own like
    return add_adjacent(row_molar(), spec, "here");
  }();
  return set;
}

TEST(AddedAdjacent, TheToothKeepsItsLeavesAndItsLandmarks) {
  const Tooth &alone = row_molar(), own = own_tooth(molar_in_row().tooth);
  EXPECT_EQ(own.octree.count_leaves(), alone.octree.count_leaves());
  const Vec3 by = (own.octree.origin_mm() - alone.octree.origin_mm()) / alone.octree.leaf_mm();
  const IVec3 shift{static_cast<int>(std::lround(-by.x)), static_cast<int>(std::lround(-by.y)),
                    static_cast<int>(std::lround(-by.z))};
  std::uint64_t other_tissue = 0;
  double most = 0;
  const IVec3 n = alone.octree.size();
  for (int z = 0; z < n.z; ++z)
    for (int y = 0; y < n.y; ++y)
      for (int x = 0; x < n.x; ++x) {
        const IVec3 leaf{x, y, z};
        other_tissue += own.octree.tissue(leaf + shift) != alone.octree.tissue(leaf) ? 1 : 0;
        most = std::max(most, std::fabs(decode_distance(own.octree.distance_code(leaf + shift)) -
                                        decode_distance(alone.octree.distance_code(leaf))));
      }
  EXPECT_EQ(other_tissue, 0u);
  EXPECT_LT(most, 0.2);  // leaves
  const Landmarks a = find_landmarks(alone), b = find_landmarks(molar_in_row().tooth);
  const auto p = named_points(a), q = named_points(b);
  ASSERT_EQ(p.size(), q.size());
  for (std::size_t i = 0; i < p.size(); ++i) {
    EXPECT_EQ(p[i].name, q[i].name);
    EXPECT_LT(length(p[i].at_mm - q[i].at_mm), 1e-6) << p[i].name;
  }
  ASSERT_EQ(a.height_of_contour_mm.size(), b.height_of_contour_mm.size());
  for (std::size_t i = 0; i < a.height_of_contour_mm.size(); ++i)
    EXPECT_LT(length(a.height_of_contour_mm[i] - b.height_of_contour_mm[i]), 0.02) << i;
}

TEST(AddedAdjacent, TeethTouchInAnAreaAndTheGumTouchesNone) {
  const AddedAdjacent& set = molar_in_row();
  for (const auto& c : {set.mesial, set.distal}) {
    ASSERT_TRUE(c);
    std::cout << "contact at " << c->at_mm.x << ", " << c->at_mm.y << ", " << c->at_mm.z << ": "
              << c->width_mm << " x " << c->height_mm << " mm, " << c->gap_mm << " mm apart\n";
    EXPECT_NEAR(c->gap_mm, 0.0, 0.005);
    EXPECT_GT(c->width_mm, 0.5);
    EXPECT_LT(c->width_mm, 3.0);
  }
  const Octree& tree = set.tooth.octree;
  const std::uint8_t gum = set.tooth.tissue_id("gingiva");
  std::uint64_t touching = 0, leaves = 0, above_contact = 0;
  tree.for_each_cube([&](IVec3 at, int edge, std::uint8_t t) {
    if (t != gum) return;
    for (int z = 0; z < edge; ++z)
      for (int y = 0; y < edge; ++y)
        for (int x = 0; x < edge; ++x) {
          const IVec3 leaf = at + IVec3{x, y, z};
          ++leaves;
          above_contact +=
              tree.centre_mm(leaf).z > set.mesial->at_mm.z - 0.5 && tree.centre_mm(leaf).x > 0 ? 1
                                                                                               : 0;
          for (const IVec3 step : {IVec3{1, 0, 0}, IVec3{-1, 0, 0}, IVec3{0, 1, 0}, IVec3{0, -1, 0},
                                   IVec3{0, 0, 1}, IVec3{0, 0, -1}}) {
            const std::uint8_t beside = tree.tissue(leaf + step);
            touching += beside != gum && tree.is_solid(beside) ? 1 : 0;
          }
        }
  });
  EXPECT_GT(static_cast<double>(leaves) * tree.leaf_volume_mm3(), 20.0);
  EXPECT_EQ(touching, 0u);
  EXPECT_EQ(above_contact, 0u);
  // a papilla stands between the teeth: higher than the margin over the neck
  const Vec3 below{set.mesial->at_mm.x, set.mesial->at_mm.y, set.mesial->at_mm.z};
  double papilla = -1e9;
  for (double z = below.z; z > below.z - 4; z -= 0.05)
    for (double x = -0.6; x < 0.8; x += 0.05)
      if (tree.tissue_at({below.x + x, below.y, z}) == gum) papilla = std::max(papilla, z);
  EXPECT_NEAR(papilla, below.z - 1.2, 0.35);
}

TEST(AddedAdjacent, WhatCannotStandTogetherIsRefused) {
  const Tooth one = ball(k_radius_mm, 0.1), fine = ball(1.0, 0.05);
  AdjacentSpec spec;
  EXPECT_THROW(static_cast<void>(add_adjacent(one, spec, "here")), Error);
  spec.mesial.tooth = &fine;
  EXPECT_THROW(static_cast<void>(add_adjacent(one, spec, "here")), Error);  // other leaves
  spec.mesial.tooth = &one;
  spec.contact_mm = 0.5;
  EXPECT_THROW(static_cast<void>(add_adjacent(one, spec, "here")), Error);
  spec.contact_mm = 0.0;
  spec.gum = true;
  EXPECT_THROW(
      static_cast<void>(add_adjacent(make_block({2, 2, 2}, {{"enamel", 2.0}}, 0.1), spec, "here")),
      Error);  // a block has no neck
  EXPECT_THROW(static_cast<void>(add_adjacent(molar_in_row().tooth, spec, "here")), Error);
}

/// A tooth that is known by what was said and the class of its shape alone.
RowVerdict row_of(const ToothKind& tooth, ToothClass kind, const ToothKind& beside,
                  ToothClass other, int side) {
  const ClassGuess a{kind, 0.9, {}}, b{other, 0.9, {}};
  return stand_in_a_row({"a", tooth, a}, {"b", beside, b}, side);
}
ToothKind numbered(int fdi) { return ToothKind(from_fdi(fdi, "x")); }
const ToothKind k_scan;

TEST(InARow, NumbersMustFollowEachOtherOnOneSideOfOneJaw) {
  constexpr auto k_any = ToothClass::unknown;
  for (const auto& [tooth, beside, side] : {std::tuple(36, 35, 1),
                                            {36, 37, -1},
                                            {11, 12, -1},
                                            {13, 12, 1},
                                            {47, 46, 1},
                                            {25, 26, -1}}) {
    EXPECT_TRUE(row_of(numbered(tooth), k_any, numbered(beside), k_any, side).why_not.empty())
        << tooth << ' ' << beside;
    EXPECT_EQ(row_of(numbered(tooth), k_any, numbered(beside), k_any, side).unchecked, Message());
    EXPECT_FALSE(row_of(numbered(tooth), k_any, numbered(beside), k_any, -side).why_not.empty())
        << "on the other side";
    EXPECT_FALSE(row_of(numbered(tooth), k_any, numbered(from_fdi(beside, "x").other_side().fdi),
                        k_any, side)
                     .why_not.empty())
        << "of the other half";
  }
  EXPECT_EQ(
      testing_basics::figures_in(row_of(numbered(37), k_any, numbered(34), k_any, -1).why_not),
      (std::vector<double>{37, 38, 34}));
  EXPECT_EQ(
      testing_basics::figures_in(row_of(numbered(38), k_any, numbered(37), k_any, -1).why_not),
      (std::vector<double>{38}))
      << "the last one";
  EXPECT_EQ(testing_basics::figures_in(row_of(numbered(11), k_any, numbered(21), k_any, 1).why_not),
            (std::vector<double>{11, 21}))
      << "over the midline";
}

TEST(InARow, WithoutNumbersClassAndJawDecide) {
  constexpr auto k_molar = ToothClass::molar, k_premolar = ToothClass::premolar,
                 k_incisor = ToothClass::incisor;
  EXPECT_TRUE(row_of(k_scan, k_molar, k_scan, k_premolar, 1).why_not.empty());
  EXPECT_NE(row_of(k_scan, k_molar, k_scan, k_premolar, 1).unchecked, Message())
      << "their numbers were not said";
  EXPECT_FALSE(row_of(k_scan, k_molar, k_scan, k_premolar, -1).why_not.empty());
  EXPECT_FALSE(row_of(k_scan, k_molar, k_scan, k_incisor, 1).why_not.empty());
  EXPECT_FALSE(row_of(numbered(37), k_molar, k_scan, k_premolar, -1).why_not.empty())
      << "a premolar distal of a second molar";
  EXPECT_FALSE(row_of(numbered(37), k_molar, k_scan, k_premolar, 1).why_not.empty())
      << "nor mesial: a first molar stands there";
  EXPECT_TRUE(row_of(k_scan, k_premolar, k_scan, k_molar, -1).why_not.empty());
  EXPECT_FALSE(row_of({Jaw::lower, ToothClass::unknown}, k_molar, {Jaw::upper, ToothClass::unknown},
                      k_premolar, 1)
                   .why_not.empty());
  EXPECT_TRUE(row_of(k_scan, ToothClass::unknown, k_scan, k_molar, 1).why_not.empty());
  EXPECT_NE(row_of(k_scan, ToothClass::unknown, k_scan, k_molar, 1).unchecked, Message());
}

TEST(AddedAdjacent, TeethThatAreNoNeighboursAreRefusedUnlessConfirmedAndThatIsKept) {
  PremolarShape shape;
  shape.leaf_mm = 0.2;
  Tooth premolar = make_premolar(shape);
  AdjacentSpec spec;
  spec.distal.tooth = &premolar;
  Tooth tooth = premolar;
  tooth.kind = numbered(15);
  premolar.kind = numbered(14);
  EXPECT_THROW(static_cast<void>(add_adjacent(tooth, spec, "here")), Error);
  spec.confirmed = true;
  const auto warnings = add_adjacent(tooth, spec, "here").tooth.notes_of(ToothNote::Kind::warning);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].values().size(), 1u) << "what speaks against it";
}

}  // namespace
}  // namespace cavum
