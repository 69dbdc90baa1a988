// `grade --why`: for every measure the points of the moments add up to what was lost, whichever way
// is better, and what they say is what was done.
#include "grading/feedback/why.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/base/random.h"
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
using testing::k_chamber_target;
using testing::opening_pulp;
using testing::scenario_text;

/// A moment in which something was removed: it tells at which wall, or at the opening, the most of
/// it.
bool is_removal(const WhyItem& i) {
  for (std::size_t wall = 0; wall <= scenarios::k_walls; ++wall)
    if (i.unit == "mm3" && i.tick >= 0 && tells(i.what(), scenarios::wall_text(wall, {})))
      return true;
  return false;
}

/// The one criterion `metric`, half of whose points are lost; `sign` 1 where more is to be better.
scenarios::RubricSpec half_lost(const Result& r, const std::string& metric, double sign) {
  scenarios::RubricSpec rubric;
  const double value = metric_value(r, metric).value.value_or(0);
  scenarios::CriterionSpec c;
  c.id = c.title = "c";
  c.metric = metric;
  c.full = value + sign;
  c.zero = value - sign;
  c.points = 10;
  rubric.criteria = {c};
  return rubric;
}

double points_of(const Why& w) {
  double sum = w.left_out_points;
  for (const auto& i : w.items) sum += i.points_lost.value_or(0);
  return sum;
}

TEST(Why, PointsAddUpToWhatWasLostForEveryMeasureAndBothDirections) {
  Carved c(opening_pulp(k_chamber_target), chambered_block(0.1));
  c.carve(box_hole(-1.5, 0.4, -1, 1.6, -4.7), 100);
  c.carve(box_hole(0.2, 0.9, -1.9, 1, -2), 1000);
  c.carve(box_hole(0.2, 0.9, -3.4, -2, -1), 2000);
  const Result measured = c.graded();
  for (const auto& m : scenarios::measures())
    for (const double sign : {1.0, -1.0}) {
      const scenarios::RubricSpec rubric = half_lost(measured, m.name, sign);
      Result r = measured;
      mark(r, rubric);
      const Why w = why(c.input(), r, rubric, "c");
      EXPECT_NEAR(points_of(w), 10 - r.criteria[0].points, 1e-6) << m.name << " " << sign;
      EXPECT_FALSE(w.items.empty()) << m.name;
      for (const auto& i : w.items)
        EXPECT_GE(i.points_lost.value_or(0), 0) << m.name << ": " << i.what();
    }
}

TEST(Why, AMomentThatReachesSeveralZonesNamesEachWithItsVolume) {
  Carved c(
      scenario_text(
          "[[zones.target]]\nshape = \"column\"\noutline = { kind = \"circle\", radius_mm = 1 }\nbottom = { kind = \"level\", z_mm = -2 }\n"),
      dentin_block(4, 4, 0.05));
  c.carve(box_hole(-0.6, 2.4, -0.6, 0.6, -1.63),
          100);  // through leeway and container, 0.6 mm beyond
  const Result measured = c.graded();
  scenarios::RubricSpec rubric = half_lost(measured, "overcut_mm3", 1);
  rubric.criteria[0].full = 0;
  rubric.criteria[0].zero = 10;
  Result r = measured;
  mark(r, rubric);
  const Why w = why(c.input(), r, rubric, "c");
  ASSERT_EQ(w.items.size(), 2u);
  EXPECT_TRUE(tells(w.items[1].what(), 50.0))
      << "percent of the work from which on care counts in full: " << w.items[1].what();
  const WhyItem& cut = w.items[0];
  EXPECT_NEAR(*cut.amount, *r.criteria[0].value, 1e-9);
  EXPECT_TRUE(
      tells(cut.what(), std::string(scenarios::zone_name(scenarios::Zone::container_sides))))
      << cut.what();
  EXPECT_GE(figures_in(cut.what()).size(), 3u) << "a volume for each zone, and one outside all";
  EXPECT_TRUE(tells(cut.what(),
                    scenarios::wall_text(static_cast<std::size_t>(scenarios::Wall::mesial), {})))
      << cut.what();
}

TEST(Why, MomentsBeginWhereTheReasonSaysAndAddUpToValueAndBound) {
  Random random(
      testing_basics::drawn_seed("Why.MomentsBeginWhereTheReasonSaysAndAddUpToValueAndBound"));
  for (int round = 0; round < 4; ++round) {
    const std::string guard = "[[zones.protected]]\nshape = \"tissue\"\ntissue = \"pulp\"\n";
    Carved c(scenario_text(k_chamber_target + guard), chambered_block(0.1));
    std::int64_t tick = 0;
    for (int i = 0; i < 8; ++i) {
      const Vec3 at{random.uniform(-2.5, 2.5), random.uniform(-2, 2), random.uniform(-5, 0)};
      const double radius = random.uniform(0.3, 1.1);
      c.carve([=](Vec3 p) { return length(p - at) - radius; }, tick);
      tick += 1 + static_cast<std::int64_t>(random.uniform(0, 1500));
    }
    const Result measured = c.graded();
    for (const char* metric :
         {"leeway_sides_mm3", "leeway_bottom_mm3", "container_sides_mm3", "container_bottom_mm3",
          "container_mm3", "outside_mm3", "protected_mm3", "overcut_mm3", "removed_mm3",
          "touched_dentin_mm3", "touched_pulp_mm3"}) {
      scenarios::RubricSpec rubric = half_lost(measured, metric, -1);
      Result r = measured;
      mark(r, rubric);
      if (!(*r.criteria[0].value > 0)) continue;
      const Why w = why(c.input(), r, rubric, "c");
      double sum = w.left_out_amount, bound = 0;
      std::int64_t first = -1;
      for (const auto& i : w.items) {
        if (!is_removal(i)) continue;  // the value as a whole
        sum += *i.amount;
        bound += i.bound.value_or(0);
        if (first < 0 || i.tick < first) first = i.tick;
      }
      EXPECT_NEAR(sum, *r.criteria[0].value, 1e-9) << metric;
      if (w.left_out == 0 &&
          metric ==
              std::string(
                  "removed_mm3")) {  // between zones that both went nothing is uncertain of the sum
        EXPECT_GE(bound, r.criteria[0].bound) << metric;
      } else if (w.left_out == 0) {
        EXPECT_NEAR(bound, r.criteria[0].bound, 1e-9) << metric;
      }
      if (w.left_out == 0) {
        EXPECT_EQ(r.criteria[0].first.tick, first) << metric << ": " << r.criteria[0].reason();
      }
    }
  }
}

TEST(Why, SaysWhichMomentUsedUpWhatCostsNothing) {
  Carved c(
      scenario_text(
          "[[zones.target]]\nshape = \"column\"\noutline = { kind = \"circle\", radius_mm = 1 }\nbottom = { kind = \"level\", z_mm = -2 }\n"),
      dentin_block(4, 4, 0.05));
  c.carve(box_hole(-0.6, 0.6, -0.6, 0.6, -2), 10);
  c.carve(box_hole(2.2, 2.7, -0.5, 0.5, -0.4),
          1000);  // 0.2 mm3 outside, then four times as much, then again
  c.carve(box_hole(2.2, 3.2, -0.5, 0.5, -1), 2000);
  c.carve(box_hole(2.2, 3.2, -0.5, 0.5, -2), 3000);
  scenarios::RubricSpec rubric = half_lost(c.graded(), "outside_mm3", -1);
  rubric.criteria[0].full = 0.5;
  rubric.criteria[0].zero = 0.9;
  Result r = c.graded();
  mark(r, rubric);
  const Why w = why(c.input(), r, rubric, "c");
  std::vector<double> limits;
  for (const auto& i : w.items)
    if (i.tick >= 1000 && is_removal(i)) limits.push_back(figures_in(i.what()).back());
  EXPECT_EQ(limits, (std::vector<double>{0.5, 0.5, 0.9}))
      << "within what costs nothing, beyond it, and beyond what leaves no points";
  const auto cells = cells_of(to_text(w));
  EXPECT_TRUE(std::any_of(cells.begin(), cells.end(), [](const Message& m) {
    return figures_in(m) == std::vector<double>{0.5, 0.9};
  }));
}

TEST(Why, EveryLineThatCostsPointsHasItsTick) {
  Carved c(opening_pulp(k_chamber_target), chambered_block(0.1));
  c.carve(box_hole(-1.5, 0.4, -1, 1.6, -4.7), 100);
  c.carve(box_hole(0.2, 0.9, -1.9, 1, -2), 1000);
  const Result measured = c.graded();
  for (const auto& m : scenarios::measures())
    for (const double sign : {1.0, -1.0}) {
      const scenarios::RubricSpec rubric = half_lost(measured, m.name, sign);
      Result r = measured;
      mark(r, rubric);
      EXPECT_GE(r.criteria[0].first.tick, 0) << m.name << ": " << r.criteria[0].reason();
      for (const auto& i : why(c.input(), r, rubric, "c").items)
        if (i.points_lost.value_or(0) > 1e-9) {
          EXPECT_GE(i.tick, 0) << m.name << ": " << i.what();
        }
    }
}

TEST(Why, AnAimThatTheForceDidNotSeeIsSaid) {
  Carved c(opening_pulp(k_chamber_target), chambered_block(0.1));
  c.carve(box_hole(-1.5, 1.5, -1, 1, -4.5), 100);
  const scenarios::RubricSpec rubric = half_lost(c.graded(), "perforated", -1);
  Result r = c.graded();
  mark(r, rubric);
  ASSERT_TRUE(r.perforation.aim_unseen());
  Result seen = r;
  seen.perforation.events.emplace_back().confirmed = true;
  ASSERT_FALSE(seen.perforation.aim_unseen());
  EXPECT_EQ(why(c.input(), r, rubric, "c").items.size(),
            why(c.input(), seen, rubric, "c").items.size() + 1)
      << "no event, and that it was not seen";
}

TEST(Why, RoofAndCanalsHaveTheirPlacesAndWhenTheyWereLastNearlyReached) {
  Carved c(opening_pulp(k_chamber_target), chambered_block(0.05));
  c.carve(box_hole(-1.5, 0.5, -1, 1, -4.5),
          77);  // a millimetre of roof stays, over one canal of two
  const Result measured = c.graded();
  for (const char* metric : {"overhang_mm3", "canals_covered_percent"}) {
    scenarios::RubricSpec rubric = half_lost(measured, metric, -1);
    Result r = measured;
    mark(r, rubric);
    const Why w = why(c.input(), r, rubric, "c");
    ASSERT_EQ(w.items.size(), 1u) << metric;
    EXPECT_EQ(w.items[0].tick, 77) << metric;
    const auto* middle = std::get_if<Vec3>(&w.items[0].facts[0].what().values().at(0));
    ASSERT_NE(middle, nullptr) << w.items[0].what();
    EXPECT_NEAR(middle->x, 1.0, 0.1)
        << "of the roof 0.996, less a horn of 0.15 mm3 at 1.15; of the mouth 1.0";
  }
  const scenarios::RubricSpec rubric = half_lost(measured, "overhang_mm3", -1);
  Result r = measured;
  mark(r, rubric);
  EXPECT_NEAR(*why(c.input(), r, rubric, "c").items[0].amount, r.access.overhang->mm3, 1e-9);
}

TEST(Why, IdleTimeIsListedInSpansThatAddUpToIt) {
  Carved c(scenario_text(k_chamber_target), dentin_block(4, 5, 0.1));
  for (int i = 0; i < 3000; ++i) {
    TickInput in;
    in.tip_nm = {i >= 1000 && i < 1600 ? (i - 1000) * 2000 : 1200000, 0,
                 4000000};  // it moves for 0.6 s; 1.0 s and 1.4 s rest
    if (i < 1000) in.tip_nm[0] = 0;
    c.inputs.push_back(in);
    c.records.emplace_back();
  }
  const Result measured = c.graded();
  EXPECT_NEAR(measured.motion.idle_s, 2.4, 1e-9);
  for (const char* metric : {"idle_s", "time_s"}) {
    const scenarios::RubricSpec rubric = half_lost(measured, metric, -1);
    Result r = measured;
    mark(r, rubric);
    const Why w = why(c.input(), r, rubric, "c");
    std::vector<double> rests;
    for (const auto& i : w.items)
      if (i.end_tick > i.tick) rests.push_back(*i.amount);
    ASSERT_EQ(rests.size(), 2u) << metric;
    EXPECT_NEAR(rests[0], 1.0, 1e-9);
    EXPECT_NEAR(rests[1], 1.4, 1e-9);
  }
  EXPECT_NEAR(measured.motion.idle_bound_s, 0.4, 1e-9);
}

TEST(Why, TicksThatFollowEachOtherAreOneStretch) {
  Carved c(scenario_text(k_chamber_target), dentin_block(2, 2, 0.2));
  for (int i = 0; i < 50; ++i) {
    c.inputs.emplace_back();
    c.records.emplace_back().rpm = i < 10 || i > 30 ? 2000 : 0;
  }
  const scenarios::RubricSpec rubric = half_lost(c.graded(), "handpiece_time_s", -1);
  Result r = c.graded();
  mark(r, rubric);
  std::size_t stretches = 0;
  for (const auto& i : why(c.input(), r, rubric, "c").items)
    stretches += i.end_tick > i.tick ? 1 : 0;
  EXPECT_EQ(stretches, 2u);
}

}  // namespace
}  // namespace cavum::grading
