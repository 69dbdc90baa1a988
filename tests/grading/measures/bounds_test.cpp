// Bounds of figures that are made of others: the true value of known geometry lies within, and so
// do points and score.
#include "grading/measures/bounds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "grading/result/result_json.h"
#include "tests/grading/carved.h"

namespace cavum::grading {
namespace {

using testing::box_hole;
using testing::Carved;
using testing::dentin_block;
using testing::scenario_text;

const char k_round_target[] =
    "[[zones.target]]\nshape = \"column\"\noutline = { kind = \"circle\", radius_mm = 1.5 }\nbottom = { kind = \"level\", z_mm = -2 }\n";
const char k_boxed[] =
    "[[zones.target]]\nshape = \"column\"\noutline = { kind = \"polygon\", points_mm = [[-1.5, -1], [1.5, -1], [1.5, 1], [-1.5, 1]] }\nbottom = { "
    "kind = \"level\", z_mm = -2 }\n";

const WallMeasures& wall_measures(const Result& r, scenarios::Wall w) {
  return r.shape.wall[static_cast<std::size_t>(w)];
}

TEST(Bounds, TrueFiguresLieWithinTheirBoundsAndSoDoPointsAndScore) {
  const std::string more = R"([[rubric.criteria]]
id = "dice"
metric = "dice"
full = 1
zero = 0
points = 30
[[rubric.criteria]]
id = "floor"
metric = "floor_mean_mm"
full = 0
zero = 1
points = 30
[[rubric.criteria]]
id = "taper"
metric = "taper_deg"
full = 0
zero = 10
points = 30
[[rubric.criteria]]
id = "removed_all"
metric = "removed_mm3"
full = 0
zero = 40
points = 30
)";
  for (const double degrees : {2.0, 9.0})
    for (const double deeper : {-0.43, 0.17}) {
      SCOPED_TRACE(std::to_string(degrees) + " degrees, " + std::to_string(deeper) + " mm");
      Carved c(scenario_text(k_round_target, more), dentin_block(4, 4, 0.05));
      const double t = std::tan(degrees * std::numbers::pi / 180),
                   cosine = std::cos(degrees * std::numbers::pi / 180), depth = 2 + deeper,
                   foot = 1.15;
      c.carve(
          [&](Vec3 p) {
            return std::max((std::sqrt(p.x * p.x + p.y * p.y) - foot - t * (p.z + depth)) * cosine,
                            -depth - p.z);
          },
          0);
      const Result r = c.graded();
      // closed forms: frusta of the cone of the cut, and of what of it lies above the target's
      // floor
      const auto frustum = [&](double low, double high) {
        return std::numbers::pi * (high - low) / 3 * ([&] {
                 const double a = foot + t * (low + depth), b = foot + t * (high + depth);
                 return a * a + a * b + b * b;
               }());
      };
      const double target = std::numbers::pi * 2.25 * 2, removed = frustum(-depth, 0),
                   inside = frustum(std::max(-depth, -2.0), 0);
      ASSERT_LT(foot + t * depth, 1.5);
      const double percent = 100 * inside / target, dice = 2 * inside / (removed + target);
      EXPECT_NEAR(r.volumes.target_removed_percent, percent,
                  r.volumes.target_removed_bound_percent);
      EXPECT_NEAR(r.volumes.dice, dice, r.volumes.dice_bound);
      EXPECT_LT(r.volumes.dice_bound, 0.12);
      EXPECT_NEAR(*r.shape.taper_deg, degrees, r.shape.taper_bound_deg);
      EXPECT_LT(r.shape.taper_bound_deg, 3.0);
      const double care = std::min(1.0, percent / 50);  // what was not done cannot be done well
      const std::map<std::string, double> truth{
          {"removed", 60 * std::clamp((percent - 50) / 50, 0.0, 1.0)},
          {"dice", 30 * dice},
          {"taper", care * 30 * (1 - degrees / 10)},
          {"removed_all", care * 30 * std::clamp(1 - removed / 40, 0.0, 1.0)}};
      double score = 0, bound = 0;
      for (const auto& criterion : r.criteria) {
        score += criterion.points;
        bound += criterion.points_bound;
        const auto known = truth.find(criterion.id);
        if (known == truth.end()) continue;
        EXPECT_NEAR(criterion.points, known->second, criterion.points_bound) << criterion.id;
      }
      EXPECT_NEAR(r.points, score, 1e-9);
      EXPECT_NEAR(r.points_bound, bound, 1e-9);
      const auto j = to_json(r);
      for (const char* name : {"/score/bound", "/criteria/0/points_bound", "/volumes/bounds/dice",
                               "/walls/floor/bounds/mean_mm", "/walls/mesial/bounds/p95_mm",
                               "/shape/taper_bound_deg", "/bounds/path_mm"})
        EXPECT_GT(j.at(nlohmann::ordered_json::json_pointer(name)).get<double>(), -1e-12) << name;
      EXPECT_NE(english_text(to_text(r)).find(" ± "), std::string::npos);
    }
}

TEST(Bounds, AMeanIsBoundedByWhatCountsToEitherOfTwoWalls) {
  // the mesial wall is overcut by 0.6 mm at its foot only; the corner's places count to the floor
  // or to the wall
  Carved c(scenario_text(k_boxed), dentin_block(4, 4, 0.05));
  c.carve(box_hole(-1.5, 1.5, -1, 1, -2), 0);
  c.carve(
      [](Vec3 p) {
        return std::max(
            {std::fabs(p.x - 1.5) - 0.6, std::fabs(p.y) - 0.9, std::fabs(p.z + 2.0) - 0.3});
      },
      1);
  const Result r = c.graded();
  EXPECT_GT(wall_measures(r, scenarios::Wall::mesial).mean_bound_mm,
            0.5 * r.shape.bound_mm + 0.003);
  EXPECT_GE(wall_measures(r, scenarios::Wall::distal).mean_bound_mm, 0.5 * r.shape.bound_mm);
  EXPECT_LT(wall_measures(r, scenarios::Wall::distal).mean_bound_mm,
            0.5 * r.shape.bound_mm + 0.003);
}

TEST(Bounds, HoldBothEndsOfWhatAFigureIsMadeOf) {
  const BoundedVolume in{8, 1}, missed{2, 0.5}, beyond{1, 0.25};
  EXPECT_NEAR(share_bound_percent(in, missed), 80 - 700.0 / 9.5,
              1e-9);  // 7 of 9.5; the other end is 9 of 10.5
  EXPECT_NEAR(dice_bound(in, missed, beyond), 16.0 / 19 - 14.0 / (14 + 2.5 + 1.25), 1e-9);
  EXPECT_DOUBLE_EQ(share_bound_percent({8, 1}, {0, 0}), 0);  // nothing missed, for certain
  EXPECT_NEAR(mean_bound({{1, 1, 1, 1}, {3}, {-4}}), 1.4,
              1e-9);  // with -4 and without 3 the mean falls from 1.4 to 0
  EXPECT_NEAR(taper_bound_deg({{100, 0, 1}, {100, 0, 0.5}}, 0.05),
              std::atan((0.05 + 0.1) / 2) * 180 / std::numbers::pi, 1e-6);
}

}  // namespace
}  // namespace cavum::grading
