// A preparation without its recording: what it does not show is not judged, and makes no pass.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "grading/result/result_json.h"
#include "tests/grading/carved.h"

namespace cavum::grading {
namespace {

using testing::box_hole;
using testing::Carved;
using testing::dentin_block;
using testing::scenario_text;

constexpr char k_target[] =
    "[[zones.target]]\nshape = \"box\"\nat_mm = [0, 0, -0.5]\nsize_mm = [2, 2, 3]\n";

std::string criterion(const std::string& id, const std::string& metric, double full, double zero,
                      double points, const std::string& more = "") {
  return fmt::format(
      "[[rubric.criteria]]\nid = \"{}\"\nmetric = \"{}\"\nfull = {}\nzero = {}\npoints = {}\n{}",
      id, metric, full, zero, points, more);
}

/// The target cut exactly, or half of it, handed in without a recording.
Result marked(const std::string& criteria, double depth_mm) {
  Carved c(scenario_text(k_target, criteria), dentin_block(3, 4, 0.1));
  c.carve(box_hole(-1, 1, -1, 1, -depth_mm), 0, {-2, -2, -3}, {2, 2, 1});
  for (auto& r : c.removed) r.tick = k_untimed_tick;
  const NotShown nothing;
  GradeInput input{c.scenario, c.before, c.zones, c.after, {}, {}, c.removed, {}};
  input.not_shown = &nothing;
  return grade(input, c.scenario.rubric);
}

TEST(NotShown, WhatNeedsTimeWayOrForceHasNoPointsAndTakesNone) {
  const Result r = marked(
      criterion("time", "time_s", 5, 10, 20) + criterion("force", "force_peak_n", 1, 2, 10), 2.0);
  double judged = 0, not_judged = 0;
  for (const auto& c : r.criteria) {
    EXPECT_EQ(c.judged, c.id != "time" && c.id != "force") << c.id;
    if (c.judged) continue;
    EXPECT_FALSE(c.value.has_value());
    EXPECT_EQ(c.points, 0.0);
    EXPECT_FALSE(c.facts.empty());
  }
  for (const auto& c : r.criteria) (c.judged ? judged : not_judged) += c.max;
  EXPECT_EQ(r.max_points, judged);
  EXPECT_EQ(r.unjudged_points, not_judged);
  EXPECT_EQ(not_judged, 30.0);
  const auto json = to_json(r);
  EXPECT_TRUE(json["time_s"].is_null());
  EXPECT_TRUE(json["force"]["peak_n"].is_null());
  EXPECT_EQ(json["score"]["not_judged_points"].get<double>(), 30.0);
  EXPECT_TRUE(json["perforation"]["agree"].get<bool>());
  for (const auto& c : json["criteria"])
    if (c.contains("judged")) {
      EXPECT_FALSE(c["judged"].get<bool>());
    }
  // nobody knows when
  for (const auto& [name, wall] : json["walls"].items())
    EXPECT_TRUE(wall["max_over_tick"].is_null()) << name;
  for (const auto& c : json["criteria"]) EXPECT_TRUE(c["first_tick"].is_null()) << c;
}

TEST(NotShown, APassStandsWhateverTheRestIsWorth) {
  // all else full: the pass mark is 60 %, and the points that are open decide only when they are
  // many
  const double others = marked("", 2.0).max_points;
  EXPECT_EQ(marked(criterion("time", "time_s", 5, 10, 0.1 * others), 2.0).verdict, Verdict::pass);
  EXPECT_EQ(marked(criterion("time", "time_s", 5, 10, 2.0 * others), 2.0).verdict, Verdict::review);
}

TEST(NotShown, ACriticalLimitThatCouldNotBeJudgedIsNoPass) {
  const double others = marked("", 2.0).max_points;
  const Result r =
      marked(criterion("force", "force_peak_n", 1, 2, 0.1 * others, "critical_above = 4\n"), 2.0);
  EXPECT_EQ(r.verdict, Verdict::review);
}

TEST(NotShown, AFailThatNothingCouldMendStaysAFail) {
  const double others = marked("", 2.0).max_points;
  EXPECT_EQ(marked(criterion("time", "time_s", 5, 10, 0.01 * others), 0.2).verdict, Verdict::fail);
}

}  // namespace
}  // namespace cavum::grading
