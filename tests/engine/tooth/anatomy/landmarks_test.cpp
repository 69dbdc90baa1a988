// Landmarks of teeth that are made, against the formulae they are made from.
#include "engine/tooth/anatomy/landmarks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>

#include "engine/tooth/anatomy/placed.h"
#include "engine/tooth/make/make_block.h"
#include "engine/tooth/make/make_incisor.h"
#include "engine/tooth/make/make_molar.h"
#include "engine/tooth/make/make_premolar.h"
#include "engine/tooth/make/tooth_shapes.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

constexpr double k_leaf_mm = 0.1;

MolarShape molar_shape() {
  MolarShape shape;
  shape.leaf_mm = k_leaf_mm;
  return shape;
}
const Tooth& molar() {
  static const Tooth tooth = make_molar(molar_shape());
  return tooth;
}
const Landmarks& molar_landmarks() {
  static const Landmarks l = find_landmarks(molar());
  return l;
}

double flat(Vec3 a, Vec3 b) { return length({a.x - b.x, a.y - b.y, 0}); }

/// Height of a formula's surface over a place, by halving; `field` is negative inside.
template <class Field>
double surface_z(const Field& field, double x, double y) {
  double high = 8, low = 8;
  while (low > -6 && field(Vec3{x, y, low}) > 0) low -= 0.1;
  high = low + 0.1;
  for (int i = 0; i < 30; ++i)
    (field(Vec3{x, y, 0.5 * (low + high)}) > 0 ? high : low) = 0.5 * (low + high);
  return low;
}

/// The highest place of a formula's surface within `reach` of (x, y).
template <class Field>
Vec3 formula_top(const Field& field, double x, double y, double reach) {
  Vec3 best{0, 0, -1e9};
  for (double v = y - reach; v <= y + reach; v += 0.025)
    for (double u = x - reach; u <= x + reach; u += 0.025)
      if (const double z = surface_z(field, u, v); z > best.z) best = {u, v, z};
  return best;
}

TEST(Landmarks, CuspsOfTheMolarStandWhereItsFormulaIsHighest) {
  const Molar shape(molar_shape());
  const auto field = [&](Vec3 p) { return shape.outside(p); };
  const auto& l = molar_landmarks();
  ASSERT_EQ(l.cusps.size(), 5u);
  const std::array<const char*, 5> names{"mesiobuccal", "distobuccal", "distal", "mesiolingual",
                                         "distolingual"};
  const std::array<Vec3, 5> near{
      {{2.4, 2.6, 0}, {-0.95, 2.95, 0}, {-3.7, 1.75, 0}, {2.4, -2.6, 0}, {-2.0, -2.7, 0}}};
  double worst = 0;
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(l.cusps[i].name, names[i]);
    const Vec3 top = formula_top(field, near[i].x, near[i].y, 0.4);
    worst = std::max(worst, length(l.cusps[i].tip_mm - top));
    EXPECT_LT(length(l.cusps[i].tip_mm - top), 0.2) << names[i];
  }
  std::cout << "cusp tips of the molar: within " << worst << " mm of the formula's\n";
  EXPECT_EQ(l.tooth_class.kind, ToothClass::molar);
  EXPECT_GT(l.tooth_class.probability, 0.9);
  EXPECT_LT(l.long_axis.tilt_deg, 1.0);
}

TEST(Landmarks, FissureAndPitsOfTheMolarFollowItsFormula) {
  const auto& l = molar_landmarks();
  ASSERT_TRUE(l.mesial_pit_mm && l.central_pit_mm && l.distal_pit_mm);
  // the corners of the main fissure in make_molar.cpp; the central pit lies where the arms leave
  // it, between 0.2 and 0.7
  EXPECT_LT(flat(*l.mesial_pit_mm, {3.1, 0.05, 0}), 0.35);
  EXPECT_LT(flat(*l.distal_pit_mm, {-3.3, -0.3, 0}), 0.35);
  EXPECT_LT(flat(*l.central_pit_mm, {0.45, 0.1, 0}), 0.4);
  const std::array<std::array<double, 4>, 3> parts{
      {{3.1, 0.05, 0.7, 0.2}, {0.7, 0.2, -1.2, -0.25}, {-1.2, -0.25, -3.3, -0.3}}};
  double worst = 0;
  for (const Vec3 p : l.central_fissure_mm) {
    double d = 1e9;
    for (const auto& s : parts) d = std::min(d, segment_distance(p.x, p.y, s[0], s[1], s[2], s[3]));
    worst = std::max(worst, d);
  }
  EXPECT_LT(worst, 0.3);
  EXPECT_GT(l.central_fissure_mm.size(), 20u);
  EXPECT_EQ(l.fissure_branches_mm.size(), 3u) << "two buccal grooves, one lingual";
  std::cout << "molar: pits " << flat(*l.mesial_pit_mm, {3.1, 0.05, 0}) << ", "
            << flat(*l.central_pit_mm, {0.45, 0.1, 0}) << ", "
            << flat(*l.distal_pit_mm, {-3.3, -0.3, 0}) << " mm, fissure within " << worst
            << " mm of the formula\n";
}

TEST(Landmarks, RidgesOfTheMolarAreItsRidges) {
  const auto& l = molar_landmarks();
  ASSERT_TRUE(l.mesial_ridge.lowest_mm && l.distal_ridge.lowest_mm);
  const Molar shape(molar_shape());
  const auto field = [&](Vec3 p) { return shape.outside(p); };
  // the crest: the highest way out of the pits; along y = 0 the formula's own profile tells it
  for (const auto& [ridge, from, to] :
       {std::tuple{l.mesial_ridge, 3.4, 5.2}, std::tuple{l.distal_ridge, -5.2, -3.4}}) {
    double best = -1e9;
    for (double x = from; x <= to; x += 0.02)
      best = std::max(best, surface_z(field, x, ridge.lowest_mm->y));
    EXPECT_NEAR(ridge.lowest_mm->z, best, 0.08);
    EXPECT_TRUE(ridge.lowest_mm->x > from && ridge.lowest_mm->x < to) << ridge.lowest_mm->x;
    EXPECT_GT(ridge.crest_mm.front().y, 1.0) << "from buccal";
    EXPECT_LT(ridge.crest_mm.back().y, -1.0) << "to lingual";
  }
  EXPECT_EQ(l.cusp_ridges.size(), 5u);
  EXPECT_GT(l.occlusal_table_mm.size(), 30u);
}

TEST(Landmarks, NeckAndContourOfTheMolarFollowItsFormula) {
  const auto& l = molar_landmarks();
  ASSERT_EQ(l.neck_mm.size(), 72u);
  double worst = 0;
  for (const Vec3 p : l.neck_mm) worst = std::max(worst, std::fabs(p.z - Molar::neck_mm(p.x, p.y)));
  EXPECT_LT(worst, 0.35);
  std::cout << "neck of the molar: within " << worst << " mm of the formula\n";
  ASSERT_EQ(l.height_of_contour_mm.size(), 72u);
  // k_half_x is widest at z 0.4, k_half_y at -0.6 (knots of make_molar.cpp)
  EXPECT_NEAR(l.height_of_contour_mm[0].z, 0.4, 0.4);
  EXPECT_NEAR(l.height_of_contour_mm[36].z, 0.4, 0.4);
  EXPECT_NEAR(l.height_of_contour_mm[18].z, -1.0, 0.6);
  EXPECT_NEAR(l.height_of_contour_mm[0].x, 5.5, 0.1);
  EXPECT_NEAR(l.height_of_contour_mm[18].y, 5.0, 0.1);
}

TEST(Landmarks, PulpOfTheMolarIsFound) {
  const auto& l = molar_landmarks();
  const MolarShape shape = molar_shape();
  ASSERT_EQ(l.pulp_horns_mm.size(), 5u);
  ASSERT_TRUE(l.chamber_roof_mm && l.chamber_floor_mm);
  EXPECT_NEAR(l.chamber_roof_mm->z, shape.chamber_roof_mm, 0.15);
  EXPECT_NEAR(l.chamber_floor_mm->z, shape.chamber_roof_mm - shape.chamber_height_mm, 0.15);
  ASSERT_EQ(l.canal_mouths.size(), 3u);
  for (const Vec3 at : {Vec3{1.7, 1.45, 0}, Vec3{1.7, -1.4, 0}, Vec3{-1.9, 0, 0}})
    EXPECT_TRUE(std::any_of(l.canal_mouths.begin(), l.canal_mouths.end(),
                            [&](const CanalOpening& c) { return flat(c.at_mm, at) < 0.2; }))
        << at.x << ' ' << at.y;
  // horns as make_molar.cpp puts them: under the cusps, at 0.74 of x and 0.60 of y, 0.13 above the
  // cone's end
  for (const Vec3 c : {Vec3{2.55, 2.85, 3.25}, Vec3{-0.95, 3.05, 3.05}, Vec3{2.5, -2.75, 3.5},
                       Vec3{-2.0, -2.8, 3.35}}) {
    const Vec3 tip{c.x * 0.74, c.y * 0.60, shape.chamber_roof_mm + 1.15 + 0.5 * (c.z - 3.0) + 0.13};
    EXPECT_TRUE(std::any_of(l.pulp_horns_mm.begin(), l.pulp_horns_mm.end(),
                            [&](Vec3 h) { return length(h - tip) < 0.3; }))
        << tip.x << ' ' << tip.y;
  }
  ASSERT_EQ(l.apices_mm.size(), 2u);
  for (const Vec3 a : l.apices_mm) EXPECT_NEAR(a.z, -16.4, 0.15);
}

TEST(Landmarks, FourAndTwoCanalsAreCounted) {
  for (const int canals : {2, 4}) {
    MolarShape shape = molar_shape();
    shape.canals = canals;
    EXPECT_EQ(find_landmarks(make_molar(shape)).canal_mouths.size(),
              static_cast<std::size_t>(canals));
  }
}

TEST(Landmarks, PremolarHasTwoCuspsOneFissureAndNoFloor) {
  PremolarShape shape;
  shape.leaf_mm = k_leaf_mm;
  const Landmarks l = find_landmarks(make_premolar(shape));
  EXPECT_EQ(l.tooth_class.kind, ToothClass::premolar) << l.tooth_class.reason;
  ASSERT_EQ(l.cusps.size(), 2u);
  const Premolar formula(shape);
  const auto field = [&](Vec3 p) { return formula.outside(p); };
  EXPECT_EQ(l.cusps[0].name, "buccal");
  EXPECT_EQ(l.cusps[1].name, "lingual");
  EXPECT_LT(length(l.cusps[0].tip_mm - formula_top(field, 0, 2.3, 0.5)), 0.2);
  EXPECT_LT(length(l.cusps[1].tip_mm - formula_top(field, 0.3, -2.3, 0.5)), 0.2);
  ASSERT_TRUE(l.mesial_pit_mm && l.distal_pit_mm);
  EXPECT_LT(flat(*l.mesial_pit_mm, {1.5, 0.05, 0}), 0.3);
  EXPECT_LT(flat(*l.distal_pit_mm, {-1.45, 0.05, 0}), 0.3);
  for (const Vec3 p : l.central_fissure_mm)
    EXPECT_LT(segment_distance(p.x, p.y, 1.5, 0.05, -1.45, 0.05), 0.3)
        << "a class I is to lie within 0.3 mm of it";
  EXPECT_FALSE(l.central_pit_mm);
  EXPECT_FALSE(l.chamber_floor_mm) << "one canal";
  EXPECT_EQ(l.canal_mouths.size(), 1u);
  EXPECT_EQ(l.pulp_horns_mm.size(), 2u);
  EXPECT_EQ(l.apices_mm.size(), 1u);
}

TEST(Landmarks, IncisorHasAnEdgeAndNoTable) {
  IncisorShape shape;
  shape.leaf_mm = k_leaf_mm;
  const Landmarks l = find_landmarks(make_incisor(shape));
  EXPECT_EQ(l.tooth_class.kind, ToothClass::incisor) << l.tooth_class.reason;
  EXPECT_TRUE(l.cusps.empty() && l.occlusal_table_mm.empty() && l.central_fissure_mm.empty() &&
              !l.mesial_pit_mm);
  ASSERT_GT(l.incisal_edge_mm.size(), 15u);
  EXPECT_GT(l.incisal_edge_mm.front().x, 3.0);
  EXPECT_LT(l.incisal_edge_mm.back().x, -3.0);
  const Incisor formula(shape);
  const auto field = [&](Vec3 p) { return formula.outside(p); };
  for (const Vec3 p : l.incisal_edge_mm) EXPECT_NEAR(p.z, surface_z(field, p.x, p.y), 0.12) << p.x;
  ASSERT_EQ(l.neck_mm.size(), 72u);
  double sum = 0;
  for (const Vec3 p : l.neck_mm) sum += std::fabs(p.z - Incisor::neck_mm(p.x, p.y));
  EXPECT_LT(sum / 72, 0.25);
  EXPECT_EQ(l.pulp_horns_mm.size(), 2u);
  EXPECT_EQ(l.canal_mouths.size(), 1u);
}

TEST(Landmarks, BlocksAndTeethWithoutEnamelHaveNone) {
  const auto is_bare = [](const Landmarks& l) {
    return named_points(l).empty() && l.neck_mm.empty() && l.height_of_contour_mm.empty() &&
           l.occlusal_table_mm.empty() && l.tooth_class.kind == ToothClass::unknown &&
           !l.notes.empty();
  };
  EXPECT_TRUE(
      is_bare(find_landmarks(make_block({10, 10, 6}, {{"enamel", 3.0}, {"dentin", 3.0}}, 0.2))));
  EXPECT_TRUE(is_bare(find_landmarks(make_cube(5, "dentin", 0.2))));
  EXPECT_TRUE(is_bare(find_landmarks(make_cube(1, "enamel", 0.1))));
  EXPECT_TRUE(is_bare(find_landmarks(Tooth{})));
}

TEST(Landmarks, OfTheShippedMolarAreTheSameEveryTime) {
  const Tooth tooth = load_tooth_file(testing_basics::data_path("teeth/lower_molar.cvt"));
  const auto once = named_points(find_landmarks(tooth)),
             again = named_points(find_landmarks(tooth));
  EXPECT_EQ(once, again);
  EXPECT_EQ(once.size(), 22u);
}

TEST(PlacedLandmarks, TheFissureEndsWhereAPersonPutsItsPits) {
  Landmarks l;
  for (int i = 0; i <= 10; ++i)
    l.central_fissure_mm.push_back({3.0 - 0.6 * i, 0, 0});  // from mesial, x = 3, to distal, x = -3
  Landmarks beyond = l, aside = l;
  place_landmarks({{"mesial_pit", {1.7, 0.3, 0}}, {"distal_pit", {-2.5, 0, 0}}}, l);
  ASSERT_EQ(l.central_fissure_mm.size(), 8u);
  EXPECT_EQ(l.central_fissure_mm.front(), (Vec3{1.7, 0.3, 0})) << "what lay beyond it is gone";
  EXPECT_NEAR(l.central_fissure_mm[1].x, 1.2, 1e-9);
  EXPECT_EQ(l.central_fissure_mm.back(), (Vec3{-2.5, 0, 0}));
  place_landmarks({{"mesial_pit", {3.5, 0, 0}}}, beyond);
  EXPECT_EQ(beyond.central_fissure_mm.size(), 11u);
  EXPECT_EQ(beyond.central_fissure_mm.front(), (Vec3{3.5, 0, 0}));
  place_landmarks({{"mesial_pit", {-9, 0, 0}}}, aside);
  EXPECT_GE(aside.central_fissure_mm.size(), 2u) << "a line stays one";
}

TEST(PlacedLandmarks, StandInPlaceOfWhatWasFound) {
  Tooth tooth = molar();
  tooth.placed_landmarks = {
      {"central_pit", {0.1, 0.2, 1.0}}, {"cusp_6", {1, 2, 3}}, {"mesial_pit", {3, 0, 2}},
      {"cusp_2", {-1, 3, 3}},           {"cusp_9", {0, 0, 0}}, {"nose", {0, 0, 0}}};
  const Landmarks l = find_landmarks(tooth);
  EXPECT_EQ(*l.central_pit_mm, (Vec3{0.1, 0.2, 1.0}));
  EXPECT_EQ(*l.mesial_pit_mm, (Vec3{3, 0, 2}));
  EXPECT_EQ(l.central_fissure_mm.front(), (Vec3{3, 0, 2})) << "the fissure begins at its pit";
  ASSERT_EQ(l.cusps.size(), 6u);
  EXPECT_EQ(l.cusps[5].tip_mm, (Vec3{1, 2, 3}));
  EXPECT_EQ(l.cusps[1].tip_mm, (Vec3{-1, 3, 3}));
  EXPECT_EQ(l.cusps[1].name, "distobuccal");
  EXPECT_EQ(l.moved.size(), 4u);
  EXPECT_EQ(l.notes.size(), molar_landmarks().notes.size() + 2)
      << "two that could not be put are named";
  for (const auto& [name, at] : named_points(l)) EXPECT_TRUE(is_landmark_name(name)) << name;
  for (const char* bad :
       {"", "cusp", "cusp_0", "cusp_17", "cusp_1x", "cusp_01", "nose", "central_pit_1"})
    EXPECT_FALSE(is_landmark_name(bad)) << bad;
}

}  // namespace
}  // namespace cavum
