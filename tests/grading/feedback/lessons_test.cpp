// Lessons: their points are those that were lost, each mistake that was cut into a block is the
// first to be named, at the place where it was made, and doing what a lesson says wins points.
#include "grading/feedback/lessons.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "grading/result/loss.h"
#include "tests/engine/support/basics.h"
#include "tests/grading/carved.h"

namespace cavum::grading {
namespace {

using namespace testing_basics;
using testing::box_hole;
using testing::Carved;
using testing::dentin_block;
using testing::scenario_text;

Term told_wall(scenarios::Wall wall) {
  return scenarios::wall_text(static_cast<std::size_t>(wall), {});
}

/// The moment that a lesson names; -1 where it names none.
double reported_s(const Message& m) {
  for (const Value& v : m.values()) {
    if (const auto* time = std::get_if<ClockTime>(&v)) return time->seconds;
    if (const auto* inner = std::get_if<Message>(&v))
      if (const double s = reported_s(*inner); s >= 0) return s;
  }
  return -1;
}

/// A box of 3 x 2 mm, 2 mm deep, in a block; marked for what is left, what is cut beside and below
/// it, and what is cut elsewhere.
std::string box_task() {
  return scenario_text(
      "[[zones.target]]\nshape = \"box\"\nat_mm = [0, 0, -0.5]\nsize_mm = [3, 2, 3]\n");
}
scenarios::RubricSpec box_rubric() {
  scenarios::RubricSpec rubric;
  const auto add = [&](const char* metric, double full, double zero, double points) {
    scenarios::CriterionSpec c;
    c.id = c.title = c.metric = metric;
    c.full = full;
    c.zero = zero;
    c.points = points;
    rubric.criteria.push_back(c);
  };
  add("target_removed_percent", 95, 30, 30);
  add("container_sides_mm3", 0.1, 3, 20);
  add("side_walls_max_over_mm", 0.3, 1, 20);
  add("floor_max_over_mm", 0.3, 1, 20);
  add("outside_mm3", 0.1, 2, 10);
  return rubric;
}

class Lessons : public ::testing::Test {
 protected:
  Lessons() : work_(box_task(), dentin_block(4, 5, 0.1)) {}
  std::vector<Lesson> of() {
    result_ = work_.graded();
    mark(result_, box_rubric());
    return lessons(work_.input(), result_);
  }
  Carved work_;
  Result result_;
};

TEST_F(Lessons, PointsAddUpToWhatWasLost) {
  work_.carve(box_hole(-1.5, 1.0, -1, 1.9, -2.6), 500);
  work_.carve(box_hole(3.0, 3.6, -1, 1, -1), 900);
  const auto all = of();
  double sum = 0, lost = 0;
  for (const auto& l : all) sum += l.points;
  for (const auto& c : result_.criteria) lost += c.max - c.points;
  EXPECT_NEAR(sum, lost, 0.01 * static_cast<double>(all.size() + 1));
  EXPECT_GT(all.size(), 2u);
  for (std::size_t i = 1; i < all.size(); ++i) EXPECT_GE(all[i - 1].points, all[i].points);
}

TEST_F(Lessons, NothingLostNothingSaid) {
  work_.carve(box_hole(-1.5, 1.5, -1, 1, -2), 500);
  EXPECT_TRUE(of().empty());
}

TEST_F(Lessons, AnUntouchedToothIsToldToBegin) {
  const auto all = of();
  ASSERT_FALSE(all.empty());
  EXPECT_EQ(all[0].topic, Topic::left_standing);
  EXPECT_TRUE(figures_in(all[0].what).empty()) << "nothing of it was cut";
}

TEST_F(Lessons, WhatWasLeftIsNamedWithItsWall) {
  work_.carve(box_hole(-0.7, 1.5, -1, 1, -2), 500);  // the distal 0.8 mm stay
  const auto all = of();
  ASSERT_FALSE(all.empty());
  EXPECT_EQ(all[0].topic, Topic::left_standing);
  for (const Message& m : {all[0].what, all[0].instead})
    EXPECT_TRUE(tells(m, told_wall(scenarios::Wall::distal))) << m;
  EXPECT_NEAR(figures_in(all[0].what).back(), 0.8, 0.05) << "up to so thick";
}

TEST_F(Lessons, AWallThatWasCutTooFarIsNamedWithItsTime) {
  work_.carve(box_hole(-1.5, 1.5, -1, 1, -2), 500);
  work_.carve(box_hole(-1.5, 1.5, 1, 1.8, -2), 95'000);
  const auto all = of();
  ASSERT_FALSE(all.empty());
  EXPECT_EQ(all[0].topic, Topic::beside);
  EXPECT_TRUE(tells(all[0].what, told_wall(scenarios::Wall::buccal))) << all[0].what;
  EXPECT_NEAR(figures_in(all[0].what).at(0), 0.85, 0.05);
  EXPECT_NEAR(reported_s(all[0].what), 95, 0.5);
  EXPECT_NEAR(all[0].points, 20 * (0.8 - 0.3) / 0.7 + 20, 4);
}

TEST_F(Lessons, WallsThatWereAllCutTooFarAreOneSentence) {
  work_.carve(box_hole(-2.1, 2.1, -1.6, 1.6, -2),
              500);  // 0.6 mm too far all round, at the corners 0.85
  const auto all = of();
  ASSERT_FALSE(all.empty());
  EXPECT_EQ(all[0].topic, Topic::beside);
  EXPECT_NEAR(figures_in(all[0].what).at(0), 0.85, 0.05);
}

TEST_F(Lessons, ADentFarFromTheCavityIsNoWallOfIt) {
  work_.carve(box_hole(-1.5, 1.5, -1, 1, -2), 500);
  work_.carve(box_hole(3.4, 3.7, -0.5, 0.5, -0.3), 900);
  static_cast<void>(of());
  for (const auto& c : result_.criteria) {
    if (c.metric != "side_walls_max_over_mm") continue;
    EXPECT_TRUE(result_.shape.wall[static_cast<std::size_t>(scenarios::Wall::mesial)].over_outside)
        << c.reason();
  }
}

TEST_F(Lessons, AFloorThatIsTooDeepIsNamedWithItsPlace) {
  work_.carve(box_hole(-1.5, 1.5, -1, 1, -2), 500);
  work_.carve(box_hole(-1.4, -0.7, 0.4, 1, -2.9), 61'000);
  const auto all = of();
  ASSERT_FALSE(all.empty());
  EXPECT_EQ(all[0].topic, Topic::too_deep);
  EXPECT_NEAR(figures_in(all[0].what).at(0), 0.95, 0.05);
  EXPECT_NEAR(reported_s(all[0].what), 61, 0.5);
  ASSERT_TRUE(all[0].look_mm);
  EXPECT_TRUE(tells(all[0].what, side_words(*all[0].look_mm, work_.input().zones))) << all[0].what;
  EXPECT_LT(std::fabs(all[0].look_mm->x + 1.05), 0.45);
  EXPECT_NEAR(all[0].look_mm->z, -2.9, 0.15);
}

TEST_F(Lessons, ACutElsewhereIsNamed) {
  work_.carve(box_hole(-1.5, 1.5, -1, 1, -2), 500);
  work_.carve(box_hole(3.0, 3.9, -1, 1, -1), 900);
  const auto all = of();
  ASSERT_FALSE(all.empty());
  EXPECT_EQ(all[0].topic, Topic::elsewhere);
}

TEST(LessonsOfAChamber, WhatWasOpenedThroughTheFloorIsOneMistakeAndNotACutElsewhere) {
  Carved work(box_task(), testing::chambered_block(0.1));
  work.carve(box_hole(-1.5, 1.5, -1, 1, -2), 500);
  work.carve(box_hole(-0.5, 0.5, -0.5, 0.5, -3.5), 61'000);
  scenarios::RubricSpec rubric = box_rubric();
  scenarios::CriterionSpec opened;
  opened.id = opened.title = opened.metric = "perforated";
  opened.full = 0, opened.zero = 1, opened.points = 10;
  opened.critical_above = 0.5;
  rubric.criteria.push_back(opened);
  Result r = work.graded();
  mark(r, rubric);
  const auto all = lessons(work.input(), r);
  ASSERT_FALSE(all.empty());
  EXPECT_EQ(all[0].topic, Topic::too_deep);
  EXPECT_TRUE(all[0].fails_exam);
  EXPECT_TRUE(tells(all[0].what, "pulp"));
  EXPECT_NEAR(figures_in(all[0].what).at(0), 0.95, 0.05) << "the floor's depth";
  EXPECT_NEAR(reported_s(all[0].what), 61, 0.5);
  for (const auto& l : all)
    EXPECT_TRUE(l.topic != Topic::elsewhere && l.topic != Topic::opened) << l.what;
}

/// The chamber's roof is cut away all over, down to the floor of the hole; the chamber lies
/// from 2.8 to 4.5 mm deep.
std::vector<Lesson> of_chamber(double down_to_z, double open_x) {
  Carved work(testing::opening_pulp(testing::k_chamber_target), testing::chambered_block(0.1));
  work.carve(box_hole(-1.5, open_x, -1, 1, down_to_z), 95'000);
  Result r = work.graded();
  scenarios::RubricSpec rubric = box_rubric();
  scenarios::CriterionSpec roof = rubric.criteria[0];
  roof.id = roof.title = roof.metric = "overhang_mm3";
  roof.full = 0.1, roof.zero = 3;
  rubric.criteria.push_back(roof);
  mark(r, rubric);
  return lessons(work.input(), r);
}
std::vector<Lesson> of_a_shallow_box() {
  Carved work(box_task(), dentin_block(4, 5, 0.1));
  work.carve(box_hole(-1.5, 1.5, -1, 1, -1), 500);
  Result r = work.graded();
  mark(r, box_rubric());
  return lessons(work.input(), r);
}
const Lesson* of_topic(const std::vector<Lesson>& all, Topic topic) {
  const auto found =
      std::find_if(all.begin(), all.end(), [topic](const Lesson& l) { return l.topic == topic; });
  return found == all.end() ? nullptr : &*found;
}

TEST(LessonsOfAChamber, WhatASlipCutsBehindTheOpeningIsTheSameMistake) {
  const auto topics = [](std::int64_t slip_tick) {
    Carved work(box_task(), testing::chambered_block(0.1));
    work.carve(box_hole(-1.5, 1.5, -1, 1, -2), 500);
    work.carve(box_hole(-0.5, 0.5, -0.5, 0.5, -3.5), 61'000);
    work.carve(box_hole(2.9, 3.5, -1, 1, -1), slip_tick);
    scenarios::RubricSpec rubric = box_rubric();
    scenarios::CriterionSpec opened;
    opened.id = opened.title = opened.metric = "perforated";
    opened.full = 0, opened.zero = 1, opened.points = 10;
    rubric.criteria.push_back(opened);
    Result r = work.graded();
    mark(r, rubric);
    std::map<Topic, double> points;
    for (const auto& l : lessons(work.input(), r)) points[l.topic] = l.points;
    return points;
  };
  const auto slip = topics(62'000), apart = topics(90'000);
  EXPECT_FALSE(slip.contains(Topic::elsewhere));
  ASSERT_TRUE(apart.contains(Topic::elsewhere));
  EXPECT_NEAR(slip.at(Topic::too_deep), apart.at(Topic::too_deep) + apart.at(Topic::elsewhere),
              0.02);
}

TEST(LessonsOfAChamber, WhoOpenedItIsNotToldToGoDeeper) {
  const auto all = of_chamber(-3.3, 1.5);  // the pulp below stays
  const Lesson* left = of_topic(all, Topic::left_standing);
  ASSERT_NE(left, nullptr);
  EXPECT_TRUE(tells(left->what, "pulp")) << "what was not cleared out";
  const auto shallow = of_a_shallow_box();
  for (const auto& l : all) EXPECT_NE(l.instead, of_topic(shallow, Topic::left_standing)->instead);
}

TEST(LessonsOfAChamber, WhoDidNotOpenItIsToldToGoOnUntilItGivesWay) {
  const auto all = of_chamber(-1.5, 1.5);
  const Lesson* left = of_topic(all, Topic::left_standing);
  ASSERT_NE(left, nullptr);
  const auto shallow = of_a_shallow_box();
  EXPECT_NE(left->instead, of_topic(shallow, Topic::left_standing)->instead)
      << "who is asked for a depth is told to go down to it";
}

TEST(LessonsOfAChamber, ARoofHasItsPlaceAndAMomentToLookAt) {
  const auto all = of_chamber(-4.4, 0.5);  // the mesial millimetre of the roof stays
  const Lesson* roof = of_topic(all, Topic::roof);
  ASSERT_NE(roof, nullptr);
  ASSERT_TRUE(roof->look_mm);
  EXPECT_NEAR(roof->look_mm->x, 1.0, 0.3);
  EXPECT_TRUE(roof->where.timed());
}

TEST(WallsOfPeople, FrontTeethHaveLabialAndIncisal) {
  using scenarios::Facing;
  constexpr auto k_buccal = static_cast<std::size_t>(scenarios::Wall::buccal);
  const Term buccal = scenarios::wall_text(k_buccal, Facing{}),
             labial = scenarios::wall_text(k_buccal, Facing{0, true}),
             incisal = scenarios::wall_text(k_buccal, Facing{1, true});
  EXPECT_TRUE(buccal != labial && labial != incisal && buccal != incisal);
  for (const ToothKind& front : {kind_of(ToothDesign::incisor), ToothKind(from_fdi(13, "x"))})
    EXPECT_TRUE(front.anterior());
  for (const ToothKind& back :
       {kind_of(ToothDesign::molar), ToothKind(from_fdi(14, "x")), ToothKind()})
    EXPECT_FALSE(back.anterior());
}

TEST_F(Lessons, OfTwoMistakesTheDearerComesFirst) {
  work_.carve(box_hole(-1.5, 1.5, -1, 1, -2), 500);
  work_.carve(box_hole(-1.5, 1.5, 1, 1.45, -2), 600);      // a little too wide
  work_.carve(box_hole(-1.4, 1.4, -0.9, 0.9, -2.9), 700);  // far too deep
  const auto all = of();
  ASSERT_GE(all.size(), 2u);
  EXPECT_EQ(all[0].topic, Topic::too_deep);
  EXPECT_EQ(all[1].topic, Topic::beside);
}

/// Work with some of three mistakes, and what its lessons say it cost.
struct Worked {
  std::vector<Lesson> lessons;
  double points = 0;
};
Worked worked(bool leaves_distal, bool wide, bool deep) {
  Carved c(box_task(), dentin_block(4, 5, 0.1));
  c.carve(box_hole(leaves_distal ? -0.6 : -1.5, 1.5, -1, 1, -2), 500);
  if (wide) c.carve(box_hole(-0.5, 1.5, 1, 1.7, -2), 600);
  if (deep) c.carve(box_hole(0, 1.4, -0.9, 0.9, -2.7), 700);
  Result r = c.graded();
  mark(r, box_rubric());
  return {lessons(c.input(), r), r.points};
}

TEST(LessonsObeyed, EachWinsThePointsItSpeaksOf) {
  const Worked all = worked(true, true, true);
  ASSERT_EQ(all.lessons.size(), 3u);
  for (const auto& l : all.lessons) {
    const Worked obeyed = worked(l.topic != Topic::left_standing, l.topic != Topic::beside,
                                 l.topic != Topic::too_deep);
    EXPECT_NEAR(obeyed.points - all.points, l.points, 0.15 * l.points + 0.3) << topic_name(l.topic);
    for (const auto& still : obeyed.lessons) EXPECT_NE(still.topic, l.topic) << still.what;
  }
}

TEST_F(Lessons, PlacesAreSaidByTheCavity) {
  const scenarios::ZoneMap& zones = work_.input().zones;
  const Vec3 middle = (zones.target_low_mm() + zones.target_high_mm()) * 0.5;
  const auto towards = [&](double deg) {
    const double a = deg * 3.14159265358979 / 180;
    return side_words(middle + Vec3{std::cos(a), std::sin(a), 0}, zones);
  };
  for (const auto& [deg, wall] : {std::pair(0., "mesial"),
                                  {90., "buccal"},
                                  {180., "distal"},
                                  {270., "lingual"},
                                  {20., "mesial"},
                                  {70., "buccal"}})
    EXPECT_TRUE(tells(towards(deg), wall)) << deg << ": " << towards(deg);
  EXPECT_EQ(towards(25), towards(45));
  EXPECT_EQ(towards(65), towards(45));
  std::set<std::string> different{english_text(side_words(middle, zones))};
  for (int deg = 0; deg < 360; deg += 45) different.insert(english_text(towards(deg)));
  EXPECT_EQ(different.size(), 9u) << "eight sides and the middle";
}

}  // namespace
}  // namespace cavum::grading
