// What every tooth made from formulae must be, tried on each of them.
#include "engine/tooth/make/formula_tooth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

#include "engine/base/error.h"
#include "engine/base/random.h"
#include "engine/tooth/make/make_incisor.h"
#include "engine/tooth/make/make_molar.h"
#include "engine/tooth/make/make_premolar.h"
#include "engine/tooth/octree_edit.h"
#include "tests/engine/tooth/tooth_testing.h"

namespace cavum {
namespace {

constexpr double k_leaf = 0.1;

struct MolarCase {
  using Formula = Molar;
  using Shape = MolarShape;
  static Tooth make(const Shape& s) { return make_molar(s); }
  static constexpr const char* k_name = "molar";
  // textbook means, mm: crown mesiodistally, buccolingually, high; whole tooth (crown and root)
  static constexpr double k_length = 11, k_width = 10, k_crown = 7, k_whole = 20;
};
struct PremolarCase {
  using Formula = Premolar;
  using Shape = PremolarShape;
  static Tooth make(const Shape& s) { return make_premolar(s); }
  static constexpr const char* k_name = "premolar";
  static constexpr double k_length = 7, k_width = 9, k_crown = 8.5, k_whole = 22.5;
};
struct IncisorCase {
  using Formula = Incisor;
  using Shape = IncisorShape;
  static Tooth make(const Shape& s) { return make_incisor(s); }
  static constexpr const char* k_name = "incisor";
  static constexpr double k_length = 8.5, k_width = 7, k_crown = 10.5, k_whole = 23.5;
};

template <class Case>
typename Case::Shape coarse() {
  typename Case::Shape shape;
  shape.leaf_mm = k_leaf;
  return shape;
}
template <class Case>
const Tooth& tooth() {
  static const Tooth made = Case::make(coarse<Case>());
  return made;
}

struct Range {
  double low = 1e9, high = -1e9;
  void add(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
  [[nodiscard]] double size() const { return high - low; }
};

template <class Case>
class FormulaTeeth : public ::testing::Test {};
using Cases = ::testing::Types<MolarCase, PremolarCase, IncisorCase>;
TYPED_TEST_SUITE(FormulaTeeth, Cases);

TYPED_TEST(FormulaTeeth, HaveTheMeasuresOfTheTextbook) {
  Range x, y, z, all_z;
  tooth<TypeParam>().octree.for_each_cube([&](IVec3 at, int edge, std::uint8_t t) {
    if (t == k_periodontium) return;
    const Vec3 low = tooth<TypeParam>().octree.origin_mm() + to_vec3(at) * k_leaf;
    for (const double e : {0.0, edge * k_leaf}) {
      all_z.add(low.z + e);
      if (t != k_enamel) continue;
      x.add(low.x + e);
      y.add(low.y + e);
      z.add(low.z + e);
    }
  });
  std::cout << TypeParam::k_name << ": enamel " << x.size() << " x " << y.size() << " x "
            << z.size() << " mm, whole " << all_z.size() << " mm\n";
  EXPECT_NEAR(x.size(), TypeParam::k_length, 0.4);
  EXPECT_NEAR(y.size(), TypeParam::k_width, 0.4);
  EXPECT_NEAR(z.size(), TypeParam::k_crown, 0.6);
  EXPECT_NEAR(all_z.size(), TypeParam::k_whole, 1.0);
  EXPECT_NEAR(x.high + x.low, 0, 0.3) << "the origin is the crown's centre";
  EXPECT_NEAR(y.high + y.low, 0, 0.4);
  EXPECT_NEAR(z.high + z.low, 0, 0.4);
}

TYPED_TEST(FormulaTeeth, EncloseOneBodyOfPulpInDentin) {
  const TissueGrid grid = tooth<TypeParam>().octree.to_grid();
  EXPECT_EQ(testing_tooth::count_bodies(grid, k_pulp, 0, grid.size.z - 1), 1);
  EXPECT_EQ(testing_tooth::count_bodies(grid, k_enamel, 0, grid.size.z - 1), 1);
  for (std::int32_t z = 1; z + 1 < grid.size.z; ++z)
    for (std::int32_t y = 1; y + 1 < grid.size.y; ++y)
      for (std::int32_t x = 1; x + 1 < grid.size.x; ++x)
        if (grid.tissue[grid.index({x, y, z})] == k_pulp)
          for (const IVec3 s : {IVec3{1, 0, 0}, IVec3{-1, 0, 0}, IVec3{0, 1, 0}, IVec3{0, -1, 0},
                                IVec3{0, 0, 1}, IVec3{0, 0, -1}}) {
            const auto t = grid.tissue[grid.index(IVec3{x, y, z} + s)];
            ASSERT_TRUE(t == k_pulp || t == k_dentin) << x << ' ' << y << ' ' << z;
          }
}

// The stored distance leads to the formula's own zero, which the octree never saw.
TYPED_TEST(FormulaTeeth, StoreDistancesThatLeadToTheTrueSurface) {
  Random random(testing_tooth::drawn_seed("FormulaTeeth.StoreDistancesThatLeadToTheTrueSurface"));
  const typename TypeParam::Formula formula(coarse<TypeParam>());
  const auto f = [&](Vec3 p) { return std::max(formula.outside(p), -formula.pulp(p)); };
  const Octree& octree = tooth<TypeParam>().octree;
  const Vec3 low = octree.origin_mm(),
             size{octree.size().x * k_leaf, octree.size().y * k_leaf, octree.size().z * k_leaf};
  Octree::Cursor cursor;
  std::vector<double> error;
  while (error.size() < 20000) {
    const Vec3 p =
        low + Vec3{random.uniform(0, size.x), random.uniform(0, size.y), random.uniform(0, size.z)};
    const auto s = octree.sample(p, cursor);
    if (std::fabs(s.distance_mm) > 0.1 || length(s.gradient) < 0.9) continue;
    const Vec3 foot = p - s.gradient * (s.distance_mm / dot(s.gradient, s.gradient));
    const double h = 1e-4;
    const Vec3 g = Vec3{f(foot + Vec3{h, 0, 0}) - f(foot - Vec3{h, 0, 0}),
                        f(foot + Vec3{0, h, 0}) - f(foot - Vec3{0, h, 0}),
                        f(foot + Vec3{0, 0, h}) - f(foot - Vec3{0, 0, h})} /
                   (2 * h);
    error.push_back(std::fabs(f(foot)) / length(g));
  }
  std::sort(error.begin(), error.end());
  std::cout << TypeParam::k_name << ", surface error, um: median " << 1e3 * error[10000]
            << ", 95 % " << 1e3 * error[19000] << ", 99 % " << 1e3 * error[19800] << '\n';
  EXPECT_LT(error[10000], 0.002);
  EXPECT_LT(error[19000], 0.012);  // leaf 0.1 mm; four times less at 0.05 mm
}

// Whole blocks of leaves are passed over on the strength of it.
TYPED_TEST(FormulaTeeth, AreNoNearerToTheirZeroThanTheySay) {
  Random random(testing_tooth::drawn_seed("FormulaTeeth.AreNoNearerToTheirZeroThanTheySay"));
  using Formula = typename TypeParam::Formula;
  const Formula formula(coarse<TypeParam>());
  const Octree& octree = tooth<TypeParam>().octree;
  const Vec3 low = octree.origin_mm(),
             size{octree.size().x * k_leaf, octree.size().y * k_leaf, octree.size().z * k_leaf};
  double steepest[3] = {};
  for (int i = 0; i < 600000; ++i) {
    const Vec3 p =
        low + Vec3{random.uniform(0, size.x), random.uniform(0, size.y), random.uniform(0, size.z)};
    const double away_mm = random.uniform(0.05, 0.5);
    const Vec3 q =
        p + normalized(Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}) *
                away_mm;
    const auto ask = [&](double& most, auto f) {
      const double here = f(p), there = f(q);
      if ((here < 0) != (there < 0)) most = std::max(most, std::fabs(here) / away_mm);
    };
    ask(steepest[0], [&](Vec3 x) { return formula.outside(x); });
    if (formula.outside(p) > 0) continue;  // the others are asked inside only
    ask(steepest[1], [&](Vec3 x) { return formula.pulp(x); });
    ask(steepest[2], [&](Vec3 x) { return formula.core(x); });
  }
  std::cout << TypeParam::k_name << ", steepest way to the zero: outside " << steepest[0]
            << ", pulp " << steepest[1] << ", core " << steepest[2] << '\n';
  for (const double s : steepest) EXPECT_LE(s, Formula::k_steepest);
  EXPECT_GT(steepest[0], 0.9) << "the zero was never crossed";
}

TYPED_TEST(FormulaTeeth, GiveTheSameBytesEveryTime) {
  EXPECT_EQ(tooth_hash(TypeParam::make(coarse<TypeParam>())), tooth_hash(tooth<TypeParam>()));
}

TYPED_TEST(FormulaTeeth, RefuseWhatIsOutOfRange) {
  auto shape = coarse<TypeParam>();
  shape.leaf_mm = 0.0;
  EXPECT_THROW((void)TypeParam::make(shape), Error);
  shape = coarse<TypeParam>();
  shape.periodontium_mm = -1;
  EXPECT_THROW((void)TypeParam::make(shape), Error);
  shape = coarse<TypeParam>();
  shape.lateral_enamel_mm = 9;
  EXPECT_THROW((void)TypeParam::make(shape), Error);
}

}  // namespace
}  // namespace cavum
