#include "grading/marking/grade.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>
#include <tuple>

#include "engine/tooth/octree_edit.h"
#include "grading/measures/cut_surface.h"
#include "grading/result/loss.h"
#include "grading/result/result_json.h"
#include "scenarios/file/measures.h"
#include "tests/engine/support/basics.h"
#include "tests/grading/carved.h"

namespace cavum::grading {
namespace {

using namespace testing_basics;
using testing::box_hole;
using testing::Carved;
using testing::chambered_block;
using testing::dentin_block;
using testing::round_hole;
using testing::scenario_text;

std::string round_target(double radius, double depth) {
  return "[[zones.target]]\nshape = \"column\"\noutline = { kind = \"circle\", radius_mm = " +
         std::to_string(radius) + " }\nbottom = { kind = \"level\", z_mm = -" +
         std::to_string(depth) + " }\n";
}
const char k_box_target[] =
    "[[zones.target]]\nshape = \"column\"\noutline = { kind = \"polygon\", points_mm = [[-1.5, -1], [1.5, -1], [1.5, 1], [-1.5, 1]] }\nbottom = { "
    "kind = \"level\", z_mm = -2 }\n";

const BoundedVolume& zone_volume(const Result& r, scenarios::Zone z) {
  return r.volumes.zone[static_cast<std::size_t>(z)].removed;
}
Term side_text(scenarios::Wall w) { return scenarios::wall_text(static_cast<std::size_t>(w), {}); }
const WallMeasures& wall(const Result& r, scenarios::Wall w) {
  return r.shape.wall[static_cast<std::size_t>(w)];
}

TEST(Grade, KnownCylinderGivesKnownVolumesWithinTheirBounds) {
  Carved c(scenario_text(round_target(1.5, 2)), dentin_block(4, 4, 0.05));
  c.carve(round_hole(0, 0, 2.0, -2.5), 0);
  const Result r = c.graded();
  const double target = std::numbers::pi * 2.25 * 2, removed = std::numbers::pi * 4 * 2.5;
  EXPECT_NEAR(r.volumes.target.mm3, target, 0.005 * target);
  EXPECT_NEAR(r.volumes.removed.mm3, removed, 0.005 * removed);
  EXPECT_NEAR(r.volumes.target.mm3, target, r.volumes.target.bound_mm3);
  EXPECT_NEAR(r.volumes.removed.mm3, removed, r.volumes.removed.bound_mm3);
  EXPECT_DOUBLE_EQ(r.volumes.target_removed_percent, 100);
  EXPECT_NEAR(r.volumes.dice, 2 * target / (target + removed), 0.005);
  double sum = 0;
  for (const auto& z : r.volumes.zone) sum += z.removed.mm3;
  EXPECT_NEAR(sum, r.volumes.removed.mm3, 1e-9);  // every removed leaf lies in exactly one zone
  // the ring of the leeway beside the target: 1.5 to 1.7 mm, down to the floor and the corner of
  // its bottom
  const double ring = std::numbers::pi * (1.7 * 1.7 - 1.5 * 1.5) * 2;
  EXPECT_NEAR(zone_volume(r, scenarios::Zone::leeway_sides).mm3, ring, 0.12 * ring);
  const double under = std::numbers::pi * 2.25 * 0.3;
  EXPECT_NEAR(zone_volume(r, scenarios::Zone::leeway_bottom).mm3, under, 0.2 * under);
}

TEST(Grade, WhatIsLeftInTheMiddleIsAsThickAsItLiesDeepInTheTarget) {
  // a ring cut out of a round target: the column left in it is seen from a surface 0.9 mm from the
  // wall, its middle lies 1.5 mm from it
  Carved c(scenario_text(round_target(1.5, 2)), dentin_block(4, 4, 0.05));
  c.carve([](Vec3 p) { return std::max(round_hole(0, 0, 1.5, -2)(p), 0.6 - std::hypot(p.x, p.y)); },
          0);
  const Result r = c.graded();
  double most = 0;
  for (const auto& w : r.shape.wall)
    if (w.samples > 0) most = std::max(most, w.max_under_mm);
  EXPECT_NEAR(most, 1.5, r.shape.bound_mm);
  const auto seen = to_json(r);
  for (const char* side : {"mesial", "distal", "buccal", "lingual"}) {
    const auto& w = seen["walls"][side];
    EXPECT_TRUE(w["max_under_tick"].is_null()) << "the middle was never cut";
    EXPECT_LT(std::hypot(w["max_under_site_mm"][0].get<double>(),
                         w["max_under_site_mm"][1].get<double>()),
              0.15);
  }
}

TEST(Grade, WallDistancesAreThoseOfTheShapesWithinTheBound) {
  Carved c(scenario_text(k_box_target), dentin_block(4, 4, 0.05));
  // mesial 0.30 over, distal 0.12 under, buccal 0.07 over, lingual exact, floor 0.22 over
  c.carve(box_hole(-1.38, 1.80, -1.0, 1.07, -2.22), 0);
  const Result r = c.graded();
  EXPECT_NEAR(wall(r, scenarios::Wall::mesial).p95_mm, 0.30, r.shape.bound_mm);
  EXPECT_NEAR(wall(r, scenarios::Wall::distal).max_under_mm, 0.12, r.shape.bound_mm);
  EXPECT_NEAR(wall(r, scenarios::Wall::buccal).mean_mm, 0.07, r.shape.bound_mm);
  EXPECT_NEAR(wall(r, scenarios::Wall::lingual).mean_mm, 0.0, r.shape.bound_mm);
  EXPECT_NEAR(wall(r, scenarios::Wall::floor).mean_mm, 0.22, r.shape.bound_mm);
  EXPECT_NEAR(*r.shape.length_mm, 3.18, r.shape.bound_mm);
  EXPECT_NEAR(*r.shape.width_mm, 2.07, r.shape.bound_mm);
  EXPECT_NEAR(*r.shape.depth_mm, 2.22, r.shape.bound_mm);
  EXPECT_NEAR(r.shape.target_length_mm, 3.0, r.shape.bound_mm);
  EXPECT_NEAR(*r.shape.taper_deg, 0, 1);
}

TEST(Grade, SurfaceIsFoundBetweenLeaves) {
  // a tenth of a leaf must show: the surface comes from the octree's distance, not from the raster
  double before = -1;
  for (const double radius : {1.500, 1.510, 1.520, 1.530, 1.540}) {
    Carved c(scenario_text(round_target(1.5, 2)), dentin_block(3, 3, 0.05));
    c.carve(round_hole(0, 0, radius, -2), 0);
    const double mean = wall(c.graded(), scenarios::Wall::mesial).mean_mm;
    EXPECT_NEAR(mean, radius - 1.5, 0.02) << radius;
    EXPECT_GT(mean, before) << radius;
    before = mean;
  }
}

TEST(Grade, TaperIsMeasuredToADegree) {
  for (const double degrees : {-6.0, 3.0, 8.0, 15.0}) {
    Carved c(scenario_text(round_target(1.5, 2)), dentin_block(4, 3, 0.05));
    const double t = std::tan(degrees * std::numbers::pi / 180),
                 cosine = std::cos(degrees * std::numbers::pi / 180);
    c.carve(
        [&](Vec3 p) {
          return std::max((std::sqrt(p.x * p.x + p.y * p.y) - 1.5 - t * (p.z + 2)) * cosine,
                          -2 - p.z);
        },
        0);
    EXPECT_NEAR(*c.graded().shape.taper_deg, degrees, 1.0);
  }
}

TEST(Grade, NamesTheWallAndTheTickWhereTheLossBegan) {
  Carved c(scenario_text(k_box_target), dentin_block(4, 4, 0.05));
  c.carve(box_hole(-1.5, 1.5, -1, 1, -2), 100);
  c.carve(box_hole(1.0, 2.2, -0.8, 0.8, -1.5), 2345);  // 0.7 mm into the mesial wall
  const Result r = c.graded();
  const auto& sides = r.criteria.at(1);
  EXPECT_LT(sides.points, sides.max);
  EXPECT_EQ(sides.first.tick, 2345);
  const auto facts = to_json(r)["criteria"][1]["facts"];
  EXPECT_EQ(facts[0]["values"]["wall"], "mesial") << facts;
  EXPECT_EQ(facts[1]["values"]["tick"], 2345) << facts;
  EXPECT_EQ(wall(r, scenarios::Wall::mesial).worst_over.tick, 2345);
  EXPECT_EQ(r.criteria.at(0).points, r.criteria[0].max);
  EXPECT_EQ(r.criteria[0].facts, Findings{finding<FindingKind::full_marks>()});
}

TEST(Grade, MissedTargetNamesItsWall) {
  Carved c(scenario_text(k_box_target), dentin_block(4, 4, 0.05));
  c.carve(box_hole(-1.0, 1.5, -1, 1, -2), 0);
  const Result r = c.graded();
  EXPECT_NEAR(r.volumes.missed.mm3, 0.5 * 2 * 2, 0.03);
  EXPECT_TRUE(tells(r.criteria.at(0).reason(), side_text(scenarios::Wall::distal)))
      << r.criteria[0].reason();
}

TEST(Grade, ResultIsTheSameTwice) {
  Carved c(scenario_text(k_box_target), chambered_block(0.1));
  c.carve(round_hole(0.4, 0.2, 1.3, -3.4), 7);
  EXPECT_EQ(to_json(c.graded()).dump(), to_json(c.graded()).dump());
}

TEST(Grade, PointsRunLinearlyFromFullToZero) {
  Result r;
  scenarios::RubricSpec rubric;
  rubric.criteria = {{"t", "t", "time_s", 100, 300, 10, {}, {}}};
  for (const auto& [time, points] : {std::pair{50.0, 10.0},
                                     {100.0, 10.0},
                                     {150.0, 7.5},
                                     {200.0, 5.0},
                                     {300.0, 0.0},
                                     {400.0, 0.0}}) {
    r.motion.time_s = time;
    mark(r, rubric);
    EXPECT_NEAR(r.points, points, 1e-12) << time;
  }
}

TEST(Grade, TimeIsMarkedOnLimitsStretchedByWhatWasGranted) {
  scenarios::RubricSpec rubric;
  rubric.criteria = {{"t", "t", "time_s", 300, 540, 5, 600.0, {}},
                     {"h", "h", "handpiece_time_s", 300, 540, 5, {}, {}}};
  const auto marked = [&](double time_s, double extra_percent, double extra_s) {
    constexpr double k_own_s = 480;
    Result r;
    r.motion.time_s = r.motion.handpiece_time_s = time_s;
    r.accommodations.extra_time_percent = extra_percent;
    r.accommodations.extra_time_s = extra_s;
    r.limit_ticks = std::llround(1000 * (k_own_s * (1 + extra_percent / 100) + extra_s));
    mark(r, rubric);
    return r;
  };
  for (const double share :
       {0.5, 0.7, 0.9, 1.0}) {  // of the limit: the same points, whatever was granted
    const double points = marked(480 * share, 0, 0).criteria[0].points;
    EXPECT_NEAR(points, 5 * std::clamp((540 - 480 * share) / 240, 0.0, 1.0), 1e-9);
    EXPECT_NEAR(marked(960 * share, 100, 0).criteria[0].points, points, 1e-9) << share;
    EXPECT_NEAR(marked(600 * share, 25, 0).criteria[0].points, points, 1e-9) << share;
    EXPECT_NEAR(marked(720 * share, 0, 240).criteria[0].points, points, 1e-9) << share;
    EXPECT_NEAR(marked(840 * share, 25, 240).criteria[0].points, points, 1e-9) << share;
  }
  const Result twice = marked(900, 100, 0);
  for (const double figure : {900.0, 600.0, 2.0})
    EXPECT_TRUE(tells(twice.criteria[0].reason(), figure)) << figure;
  EXPECT_FALSE(twice.criteria[0].critical_failed) << "1200 s would fail";
  EXPECT_TRUE(marked(1201, 100, 0).criteria[0].critical_failed);
  EXPECT_TRUE(marked(601, 0, 0).criteria[0].critical_failed);
  EXPECT_EQ(twice.criteria[1].points, 0) << "of the exam's time alone";
  EXPECT_FALSE(tells(twice.criteria[1].reason(), 2.0));
  EXPECT_FALSE(tells(marked(400, 0, 0).criteria[0].reason(), 2.0));
  EXPECT_EQ(figures_in(msg("{}", marked(400, 100, 0).criteria[0].reason())),
            (std::vector<double>{2}))
      << "full marks, by stretched limits";
}

TEST(Grade, VerdictFollowsRuleBandAndCriticalCriteria) {
  Result r;
  r.motion.time_s = 200;
  scenarios::RubricSpec rubric;
  rubric.criteria = {{"t", "t", "time_s", 100, 300, 10, {}, {}},
                     {"f", "f", "force_peak_n", 0, 1, 10, {}, {}}};
  const auto verdict = [&](double pass, double band, bool compensatory) {
    rubric.pass_percent = pass;
    rubric.borderline_percent = band;
    rubric.compensatory = compensatory;
    mark(r, rubric);
    return r.verdict;
  };
  EXPECT_EQ(verdict(60, 0, true), Verdict::pass);  // 15 of 20
  EXPECT_EQ(verdict(80, 0, true), Verdict::fail);
  EXPECT_EQ(verdict(76, 3, true), Verdict::review);
  EXPECT_EQ(verdict(60, 0, false), Verdict::fail);  // the time alone reaches 50 %
  EXPECT_EQ(verdict(45, 0, false), Verdict::pass);
  rubric.criteria[0].critical_above = 150;
  EXPECT_EQ(verdict(0, 0, true), Verdict::fail);
}

bool has(const Result& r, FindingKind kind) {
  return std::any_of(r.verdict_reasons.begin(), r.verdict_reasons.end(),
                     [&](const Finding& f) { return f.kind == kind; });
}

TEST(Verdict, SaysWhatItsOwnBoundsLeaveOpen) {
  scenarios::RubricSpec rubric;
  rubric.pass_percent = 60;
  rubric.criteria = {{"t", "t", "time_s", 100, 300, 10, {}, {}}};
  const auto marked = [&](double time_s, double bound_s) {
    Result r;
    r.motion.time_s = time_s;
    r.motion.time_bound_s = bound_s;
    mark(r, rubric);
    return r;
  };
  EXPECT_FALSE(has(marked(160, 10), FindingKind::bound_crosses));  // 70 +- 5 %
  EXPECT_TRUE(has(marked(160, 30), FindingKind::bound_crosses));
  EXPECT_TRUE(has(marked(200, 30), FindingKind::bound_crosses));  // a fail, too
  rubric.criteria[0].critical_above = 170;
  for (const auto& [time_s, bound_s, failed, open] :
       {std::tuple(160., 30., false, true), {180., 30., true, true}, {160., 5., false, false}}) {
    const CriterionResult c = marked(time_s, bound_s).criteria.at(0);
    EXPECT_EQ(c.critical_failed, failed) << time_s;
    EXPECT_EQ(c.limit_in_bound, open) << time_s;
    EXPECT_EQ(tells(c.reason(), 170.0), open) << c.reason();
  }
}

TEST(Verdict, AFailByACriticalCriterionSaysThatThePointsWouldBeEnough) {
  scenarios::RubricSpec rubric;
  rubric.pass_percent = 40;
  rubric.criteria = {{"t", "t", "time_s", 100, 300, 10, 150.0, {}}};
  Result r;
  r.motion.time_s = 200;
  mark(r, rubric);
  EXPECT_EQ(r.verdict, Verdict::fail);
  EXPECT_EQ(r.verdict_reasons,
            (Findings{finding<FindingKind::critical_limit>("t"),
                      finding<FindingKind::sum_reaches>(as_percent(50, 1), as_percent(40, 1)),
                      finding<FindingKind::enough_alone>()}));
}

/// A result whose time gets half its points, and force and tissue that tell what is asked for.
Result with_perforation(bool force, bool tissue) {
  Result r;
  r.motion.time_s = 200;
  r.perforation.fault.perforated = tissue;
  if (force) r.perforation.events.emplace_back().fault = true;
  return r;
}
const scenarios::CriterionSpec k_half_time{"t", "t", "time_s", 100, 300, 10, {}, {}};
const scenarios::CriterionSpec k_critical_time{"t", "t", "time_s", 100, 300, 10, 150.0, {}};
const scenarios::CriterionSpec k_critical_perforation{"p", "p", "perforated", 0, 1, 10, 0.5, {}};

TEST(Verdict, TheTissueDecidesAboutAPerforationWhateverTheForceSays) {
  scenarios::RubricSpec rubric;
  rubric.criteria = {k_half_time, k_critical_perforation};
  rubric.pass_percent = 10;
  for (const bool force : {false, true}) {
    Result opened = with_perforation(force, true);
    mark(opened, rubric);
    EXPECT_EQ(opened.verdict, Verdict::fail) << force;
    EXPECT_TRUE(opened.criteria[1].critical_failed);
    Result whole = with_perforation(force, false);
    mark(whole, rubric);
    EXPECT_EQ(whole.verdict, Verdict::pass) << force;
    // what the force says is told all the same
    EXPECT_EQ(has(opened, FindingKind::tissue_without_force), !force);
    EXPECT_EQ(has(whole, FindingKind::force_without_tissue), force);
  }
  rubric.criteria[1].metric = "perforation_events";  // of those that the tissue confirms
  Result r = with_perforation(true, false);
  mark(r, rubric);
  EXPECT_EQ(r.verdict, Verdict::pass);
}

TEST(Verdict, AnOpenLastStepIsNoPassUnlessTheRubricSaysSo) {
  scenarios::RubricSpec rubric;
  rubric.criteria = {k_half_time};
  rubric.pass_percent = 40;
  Result r = with_perforation(false, false);
  mark(r, rubric);
  EXPECT_EQ(r.verdict, Verdict::pass);
  r.progress.open_last_step = "floor";
  mark(r, rubric);
  EXPECT_EQ(r.verdict, Verdict::review);
  EXPECT_EQ(r.verdict_reasons.back(), finding<FindingKind::last_step_open>("floor"));
  rubric.open_step_passes = true;
  mark(r, rubric);
  EXPECT_EQ(r.verdict, Verdict::pass);
  rubric.open_step_passes = false;
  rubric.pass_percent = 60;  // what fails by its points is not lifted to a review
  mark(r, rubric);
  EXPECT_EQ(r.verdict, Verdict::fail);
}

TEST(Verdict, WhatBoundsLeaveOpenIsReviewedWhereTheRubricSaysSo) {
  scenarios::RubricSpec rubric;
  rubric.criteria = {k_half_time};  // half its points, its bound that of the clock
  Result r = with_perforation(false, false);
  r.motion.time_bound_s = 10;
  mark(r, rubric);
  const double percent = 100 * r.points / r.max_points, bound = 100 * r.points_bound / r.max_points;
  ASSERT_GT(bound, 2);
  for (const bool asked : {false, true})
    for (const auto& [mark_at, otherwise] :
         {std::pair{percent - bound / 2, Verdict::pass}, {percent + bound / 2, Verdict::fail}}) {
      rubric.review_within_bound = asked;
      rubric.pass_percent = mark_at;
      mark(r, rubric);
      EXPECT_EQ(r.verdict, asked ? Verdict::review : otherwise);
    }
  rubric.pass_percent = percent + 2 * bound;  // certain
  mark(r, rubric);
  EXPECT_EQ(r.verdict, Verdict::fail);
  rubric.pass_percent = percent - 2 * bound;
  mark(r, rubric);
  EXPECT_EQ(r.verdict, Verdict::pass);
  const double time_s = *r.criteria[0].value;
  for (const double limit :
       {time_s - 5, time_s + 5}) {  // a limit within the figure's bound, on either side
    rubric.criteria[0].critical_above = limit;
    mark(r, rubric);
    EXPECT_EQ(r.verdict, Verdict::review) << limit;
  }
  rubric.criteria[0].critical_above = time_s - 15;
  mark(r, rubric);
  EXPECT_EQ(r.verdict, Verdict::fail) << "failed for certain";
  rubric.criteria[0].critical_above = time_s - 5;
  rubric.pass_percent = percent + 2 * bound;
  mark(r, rubric);
  EXPECT_EQ(r.verdict, Verdict::fail) << "by its points, whatever the limit says";
}

TEST(Grade, TheLastStepIsOpenWhereItsEventIsMissing) {
  Carved c(scenario_text(k_box_target), dentin_block(4, 4, 0.1));
  c.carve(box_hole(-1.5, 1.5, -1, 1, -2), 0);
  EXPECT_EQ(c.graded().progress.open_last_step, "") << "no exam, no step";
  c.events.push_back({0, Finished{Finish::ended}});
  EXPECT_EQ(c.graded().progress.open_last_step, "only");
  EXPECT_EQ(c.graded().verdict, Verdict::review);
  c.events.insert(c.events.begin(), {0, StepCompleted{}});
  EXPECT_EQ(c.graded().progress.open_last_step, "");
  EXPECT_EQ(c.graded().verdict, Verdict::pass);
}

TEST(Verdict, AnotherCriticalFailureFailsWhateverForceAndTissueSay) {
  scenarios::RubricSpec rubric;
  rubric.criteria = {k_critical_time, k_critical_perforation};
  rubric.pass_percent = 10;
  for (const bool force : {false, true})
    for (const bool tissue : {false, true}) {
      Result r = with_perforation(force, tissue);
      mark(r, rubric);
      EXPECT_EQ(r.verdict, Verdict::fail) << force << tissue;
      EXPECT_EQ(r.verdict_reasons.at(0).kind, FindingKind::critical_limit);
    }
}

TEST(Grade, AnUntouchedToothCollectsNoPointsForPerfectWalls) {
  const std::string care = R"([[rubric.criteria]]
id = "gouge"
metric = "walls_max_over_mm"
full = 0.1
zero = 1
points = 20
[[rubric.criteria]]
id = "hole"
metric = "perforated"
full = 0
zero = 1
points = 20
)";
  Carved c(scenario_text(k_box_target, care), dentin_block(4, 4, 0.1));
  const Result untouched = c.graded();
  EXPECT_DOUBLE_EQ(untouched.points, 0);
  EXPECT_EQ(untouched.verdict, Verdict::fail);
  c.carve(box_hole(-1.5, 1.5, -1, 1, -0.4), 1);  // a fifth of it: two fifths of the points for care
  const Result part = c.graded();
  EXPECT_NEAR(part.criteria.at(3).points, 8, 0.1);
  EXPECT_TRUE(tells(part.criteria[3].reason(), 50.0))
      << "percent from which on care counts in full";
  c.carve(box_hole(-1.5, 1.5, -1, 1, -1.1), 2);
  const Result most = c.graded();
  for (std::size_t i = 1; i < most.criteria.size(); ++i)
    EXPECT_EQ(most.criteria[i].facts, Findings{finding<FindingKind::full_marks>()})
        << most.criteria[i].id;
}

TEST(Grade, WhatWasCutBelowTheFloorCountsByAllOfTheWorkADistanceByThatTowardsTheWall) {
  const std::string care =
      "[[rubric.criteria]]\nid = \"cut\"\nmetric = \"floor_cut_mm3\"\nfull = 0\nzero = 5\npoints = 20\n"
      "[[rubric.criteria]]\nid = \"deep\"\nmetric = \"floor_max_over_mm\"\nfull = 0\nzero = 5\npoints = 20\n";
  Carved c(scenario_text(k_box_target, care), dentin_block(4, 4, 0.1));
  c.carve(box_hole(-1.5, 1.5, -1, 1, -1.2),
          1);  // three fifths of the target, and little of what lies near its floor
  const Result r = c.graded();
  const auto& cut = r.criteria.at(r.criteria.size() - 2);
  EXPECT_DOUBLE_EQ(cut.points, 20) << cut.reason();
  EXPECT_LT(r.criteria.back().points, 10) << r.criteria.back().reason();
}

TEST(Grade, AFigureOfSeveralWallsIsSaidOfTheWallThatHasIt) {
  const std::string walls =
      "[[rubric.criteria]]\nid = \"walls\"\nmetric = \"side_walls_p95_mm\"\nfull = 0.1\nzero = 0.9\npoints = 20\n";
  Carved c(scenario_text(k_box_target, walls), dentin_block(4, 4, 0.05));
  c.carve(box_hole(-1.5, 2.0, -1, 1, -2), 100);         // the whole mesial wall by 0.5 mm
  c.carve(box_hole(0, 0.2, 0, 1.8, -0.3), 200);         // a notch of 0.8 mm in the buccal one
  c.carve(box_hole(-1.7, -1.5, -0.1, 0.1, -0.2), 300);  // the distal one is hardly cut
  const Result r = c.graded();
  const auto& walls_result = r.criteria.back();
  EXPECT_GT(wall(r, scenarios::Wall::buccal).max_over_mm, 0.75);
  EXPECT_NEAR(*walls_result.value, 0.5, 0.05);
  EXPECT_TRUE(tells(walls_result.reason(), side_text(scenarios::Wall::mesial)))
      << walls_result.reason();
  EXPECT_EQ(walls_result.first.tick, 100);
  // and its bound is what the walls together leave open, not the widest of them
  double low = -1e9, high = -1e9;
  for (const scenarios::Wall w : {scenarios::Wall::mesial, scenarios::Wall::distal,
                                  scenarios::Wall::buccal, scenarios::Wall::lingual}) {
    low = std::max(low, wall(r, w).p95_mm - wall(r, w).p95_bound_mm);
    high = std::max(high, wall(r, w).p95_mm + wall(r, w).p95_bound_mm);
  }
  EXPECT_NEAR(walls_result.bound, std::max(high - *walls_result.value, *walls_result.value - low),
              1e-12);
}

TEST(Grade, AnErrorOfTheOutlineIsSaidEndByEnd) {
  const std::string length =
      "[[rubric.criteria]]\nid = \"l\"\nmetric = \"outline_length_error_mm\"\nfull = 0.1\nzero = 2\npoints = 20\n";
  Carved c(scenario_text(k_box_target, length), dentin_block(4, 4, 0.05));
  c.carve(box_hole(-1.1, 1.8, -1, 1, -2), 100);  // 0.3 mm too far mesially, 0.4 mm short distally
  const Result r = c.graded();
  EXPECT_NEAR(*r.shape.length_error_mm, 0.7, 0.1);
  EXPECT_NEAR(r.shape.end_error[0].part_mm, 0.3, 0.05);
  EXPECT_NEAR(r.shape.end_error[0].beyond_mm, 0.3, 0.05);
  EXPECT_NEAR(r.shape.end_error[1].part_mm, 0.4, 0.05);
  EXPECT_NEAR(r.shape.end_error[1].beyond_mm, -0.4, 0.05);
  EXPECT_TRUE(tells(r.criteria.back().reason(), r.shape.end_error[1].part_mm))
      << r.criteria.back().reason();
}

TEST(Grade, SmallFiguresHaveTheDigitsThatTellThemFromFullMarks) {
  Result r;
  scenarios::RubricSpec rubric;
  rubric.criteria = {{"t", "t", "time_s", 0.001, 0.003, 10, {}, {}}};
  r.motion.time_s = 0.0012;
  mark(r, rubric);
  const std::string told = english_text(r.criteria[0].reason());
  for (const char* figure : {"0.0012 s", "0.0010 s"})
    EXPECT_NE(told.find(figure), std::string::npos) << told;
}

TEST(Grade, WhoRestsInContactWithTheHandpieceOffIsIdle) {
  Carved c(scenario_text(k_box_target), dentin_block(2, 2, 0.2));
  for (int i = 0; i < 3000; ++i) {
    c.inputs.emplace_back();
    TickRecord& r = c.records.emplace_back();
    r.penetration_nm = 1000;
    r.rpm = i < 1000 ? 100000 : 0;
  }
  EXPECT_NEAR(c.graded().motion.idle_s, 2.0, 1e-9);
}

TEST(Grade, AStepThatRanOutOfItsTimeIsNamedWithItsLimit) {
  Carved c(scenario_text(k_box_target), dentin_block(2, 2, 0.2));
  c.scenario.steps.at(0).time_limit_s = 5.0;
  c.scenario.accommodations.extra_time_percent = 20;
  c.events.push_back({5999, StepTimeUp{}});
  c.events.push_back({5999, Finished{Finish::time}});
  const Findings notes = c.graded().notes;
  const Finding wanted = finding<FindingKind::step_timed_out>(
      c.scenario.steps[0].id, as_s(5999 * k_tick_s), as_s(6000 * k_tick_s, 3), 5999);
  EXPECT_EQ(std::count(notes.begin(), notes.end(), wanted), 1);
}

TEST(Grade, AWallThatIsGoneAltogetherIsOvercutNotKept) {
  Carved c(
      scenario_text(
          k_box_target,
          "[[rubric.criteria]]\nid = \"gouge\"\nmetric = \"mesial_max_over_mm\"\nfull = 0\nzero = 5\npoints = 20\n"),
      dentin_block(4, 4, 0.1));
  c.carve(box_hole(-1.5, 3.5, -1, 1, -2), 0);
  const double before = *c.graded().criteria.back().value;
  EXPECT_NEAR(before, 2.0, 0.1);
  c.carve(box_hole(-1.5, 5, -4.5, 4.5, -5), 1);  // out through the side of the block
  EXPECT_GE(*c.graded().criteria.back().value, before);
}

TEST(Grade, WhatIsDoneAfterTheEndDoesNotCount) {
  Carved c(scenario_text(k_box_target), dentin_block(4, 4, 0.1));
  c.carve(box_hole(-1.5, 1.5, -1, 1, -1), 10);
  const double before = static_cast<double>(c.removed.size()) *
                        c.zones.leaf_volume_mm3();  // whole leaves: see measure_volumes
  c.carve(box_hole(-1.5, 1.5, -1, 1, -3), 20);
  c.events.push_back({15, Finished{Finish::time}});
  const Result r = c.graded();
  EXPECT_NEAR(r.volumes.removed.mm3, before, 1e-9);
  EXPECT_EQ(r.motion.late_ticks, 5);
  EXPECT_DOUBLE_EQ(r.motion.time_s, 0.016);
  EXPECT_EQ(r.progress.finish, Finish::time);
  EXPECT_FALSE(r.notes.empty());
}

TEST(Grade, PausesAreTakenOffTheTimeToTheTickAndListed) {
  Carved c(scenario_text(k_box_target), dentin_block(4, 4, 0.1));
  c.carve(box_hole(-1.5, 1.5, -1, 1, -1), 400);  // 401 ticks
  const Result whole = c.graded();
  c.events.push_back({100, PauseStarted{}});
  c.events.push_back({250, PauseEnded{}});
  c.events.push_back({300, PauseRefused{1}});
  const Result r = c.graded();
  EXPECT_NEAR(whole.motion.time_s - r.motion.time_s, 0.150, 1e-12);
  EXPECT_DOUBLE_EQ(whole.motion.idle_s - r.motion.idle_s,
                   0.2);  // two tenths of a second lie in the pause, at least in part
  ASSERT_EQ(r.pauses.size(), 1u);
  EXPECT_EQ(r.pauses[0].begin, 100);
  EXPECT_EQ(r.pauses[0].end, 250);
  EXPECT_EQ(r.pauses_refused, 1);
  EXPECT_EQ(r.notes.size(), whole.notes.size() + 2);
  EXPECT_DOUBLE_EQ(r.volumes.removed.mm3, whole.volumes.removed.mm3);
}

TEST(Grade, WorkAfterTimeWasUpIsShownAndDoesNotCount) {
  Carved c(scenario_text(k_box_target), dentin_block(4, 4, 0.1));
  c.carve(box_hole(-1.5, 1.5, -1, 1, -1), 10);
  c.events.push_back({10, Finished{Finish::time}});
  const Result before = c.graded();
  c.events.push_back({10, WorkAfterEnd{2500, 1200}});
  const Result r = c.graded();
  EXPECT_EQ(r.late_work.ticks, 2500);
  EXPECT_EQ(to_json(r)["late_ticks"], 2500);
  EXPECT_EQ(r.points, before.points);
  ASSERT_EQ(r.notes.size(), before.notes.size() + 1);
  EXPECT_EQ(r.notes.back(), finding<FindingKind::work_after_time>(as_s(2.5, 3), as_s(1.2, 3)));
}

TEST(Grade, DisagreementOfListAndFinalToothGoesToReview) {
  Carved c(scenario_text(k_box_target), dentin_block(4, 4, 0.1));
  c.carve(box_hole(-1.5, 1.5, -1, 1, -2), 0);
  EXPECT_TRUE(c.graded().notes.empty());
  c.removed.pop_back();
  const Result r = c.graded();
  EXPECT_EQ(r.verdict, Verdict::review);
  EXPECT_EQ(r.notes, Findings{finding<FindingKind::record_differs>()});
  EXPECT_EQ(r.verdict_reasons.back(), r.notes[0]);
}

TEST(Grade, TruthOfAPerforationBeginsWithTheFirstFaceOfAFaultTissue) {
  Carved c(scenario_text(k_box_target), chambered_block(0.1));
  c.carve(box_hole(-0.5, 0.5, -0.5, 0.5, -2.9), 1);
  EXPECT_FALSE(c.graded().perforation.fault.perforated);
  c.carve(box_hole(-0.5, 0.5, -0.5, 0.5, -3.2), 9);
  const Result r = c.graded();
  EXPECT_TRUE(r.perforation.fault.perforated);
  EXPECT_EQ(r.perforation.fault.first.tick, 9);
  EXPECT_EQ(r.perforation.fault.tissue, "pulp");
  EXPECT_NEAR(r.perforation.fault.volume_mm3, 1 * 1 * 0.2, 1e-9);
  EXPECT_NEAR(r.volumes.tissue[k_pulp].mm3, 0.2, 1e-9);
}

TEST(Grade, ProtectedTissueCountsAsProtectedBeyondTheContainer) {
  const std::string guard = "[[zones.protected]]\nshape = \"tissue\"\ntissue = \"pulp\"\n";
  Carved c(
      scenario_text(guard +
                    "[[zones.target]]\nshape = \"box\"\nat_mm = [0, 0, 0]\nsize_mm = [1, 1, 1]\n"),
      chambered_block(0.1));
  c.carve(box_hole(-0.5, 0.5, -0.5, 0.5, -4),
          1);  // the container ends at -1.2; the pulp's roof lies at -3
  const Result r = c.graded();
  EXPECT_NEAR(zone_volume(r, scenarios::Zone::protected_).mm3, 1, 0.05);
  EXPECT_NEAR(*metric_value(r, "protected_mm3").value, 1, 0.05);
  EXPECT_NEAR(r.volumes.tissue[k_pulp].mm3, 1, 0.05);
  double sum = 0;
  for (const auto& z : r.volumes.zone) sum += z.removed.mm3;
  EXPECT_NEAR(sum, r.volumes.removed.mm3, 1e-9);
  // outside is R without T, L and C, and what is protected is none of these: a hole of 1 mm2 from
  // the container's end to its floor
  EXPECT_NEAR(*metric_value(r, "outside_mm3").value, 4 - 1.2, 0.05);
  EXPECT_NEAR(to_json(r)["volumes"]["outside_mm3"].get<double>(), 4 - 1.2, 0.05);
  double others = 0;
  for (const scenarios::Zone z :
       {scenarios::Zone::target, scenarios::Zone::leeway_sides, scenarios::Zone::leeway_bottom,
        scenarios::Zone::container_sides, scenarios::Zone::container_bottom})
    others += zone_volume(r, z).mm3;
  EXPECT_NEAR(*metric_value(r, "outside_mm3").value, r.volumes.removed.mm3 - others, 1e-9);
  EXPECT_EQ(r.volumes.zone[static_cast<std::size_t>(scenarios::Zone::protected_)].first.tick, 1);
}

TEST(Grade, JsonHoldsEveryPromisedNameEvenForAnUntouchedTooth) {
  const Carved c(scenario_text(k_box_target), dentin_block(3, 3, 0.1));
  const auto j = with_words(to_json(c.graded()));
  for (const char* name : {"/verdict",
                           "/score/points",
                           "/score/max",
                           "/criteria/0/id",
                           "/criteria/0/metric",
                           "/criteria/0/value",
                           "/criteria/0/unit",
                           "/criteria/0/points",
                           "/criteria/0/max",
                           "/criteria/0/kind",
                           "/criteria/0/values",
                           "/criteria/0/reason",
                           "/volumes/target_mm3",
                           "/volumes/target_removed_percent",
                           "/volumes/missed_mm3",
                           "/volumes/removed_mm3",
                           "/volumes/outside_mm3",
                           "/volumes/dice",
                           "/volumes/overcut/leeway_sides_mm3",
                           "/volumes/overcut/leeway_bottom_mm3",
                           "/volumes/overcut/container_sides_mm3",
                           "/volumes/overcut/container_bottom_mm3",
                           "/walls/mesial/mean_mm",
                           "/walls/distal/p95_mm",
                           "/walls/buccal/max_over_mm",
                           "/walls/lingual/max_under_mm",
                           "/walls/floor/mean_mm",
                           "/perforation/detected",
                           "/perforation/events",
                           "/perforation/truth/perforated",
                           "/perforation/truth/first_t_s",
                           "/perforation/truth/volume_mm3",
                           "/time_s",
                           "/force/mean_n",
                           "/force/peak_n",
                           "/path_mm"})
    EXPECT_TRUE(j.contains(nlohmann::ordered_json::json_pointer(name))) << name;
  EXPECT_TRUE(j["walls"]["floor"]["mean_mm"].is_null());
  EXPECT_TRUE(j["perforation"]["truth"]["first_t_s"].is_null());
  EXPECT_DOUBLE_EQ(j["volumes"]["removed_mm3"].get<double>(), 0);
  EXPECT_FALSE(to_text(c.graded()).empty());
}

TEST(Grade, EveryNamedMetricCanBeComputed) {
  Carved c(scenario_text(k_box_target), chambered_block(0.1));
  c.carve(box_hole(-0.5, 0.5, -0.5, 0.5, -3.2), 1);
  const Result r = c.graded();
  for (const auto& m : scenarios::measures())
    EXPECT_NO_THROW(static_cast<void>(metric_value(r, m.name))) << m.name;
  EXPECT_THROW(static_cast<void>(metric_value(r, "nonsense")), Error);
}

}  // namespace
}  // namespace cavum::grading
