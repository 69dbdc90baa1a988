// The report's pictures of a tooth that has something beside it.
#include "ui/report/figures/from_above.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "engine/tooth/make/add_adjacent.h"
#include "tests/grading/carved_adjacent.h"
#include "tests/ui/report/kinds.h"
#include "ui/report/figures/section_pictures.h"

namespace cavum::report {
namespace {

using testing::CarvedAdjacent;

Tooth two_balls() {
  const auto field = [](Vec3 p) { return length(p) - 3; };
  const Tooth ball = testing::make_tooth(
      {-3.3, -3.3, -3.3}, {3.3, 3.3, 3.3}, 0.1,
      [&](Vec3 p) { return field(p) < 0 ? k_enamel : k_air; }, field);
  AdjacentSpec spec;
  spec.mesial.tooth = &ball;
  return add_adjacent(ball, spec, "here").tooth;
}
const std::string k_task = testing::scenario_text(
    "[[zones.target]]\nshape = \"box\"\nat_mm = [2.7, 0, 2.2]\nsize_mm = [2, 1.6, 6]\n");

std::string from_above(const CarvedAdjacent& c) {
  return c.with_input(
      [](const grading::GradeInput& input) { return picture_from_above(input).svg; });
}

/// Sections that are cut through a place of this kind.
std::vector<SectionPicture> sections_of(SectionOf kind, const grading::Result& r,
                                        const grading::GradeInput& input) {
  std::vector<SectionPicture> list = section_pictures(r, input);
  std::erase_if(list, [&](const SectionPicture& p) { return p.of != kind; });
  return list;
}

TEST(AdjacentInPictures, FromAboveShowsTheNeighbourAndWhatWasCutOfIt) {
  using testing_report::times;
  CarvedAdjacent c(k_task, two_balls());
  const std::string untouched = from_above(c);
  c.carve([](Vec3 p) { return length(p - Vec3{3, 0, 0}) - 0.6; }, 5, {2, -2, -2}, {5, 2, 2});
  EXPECT_NE(from_above(c), untouched) << "a nick below the bulge of both is shown";

  testing::Carved alone(k_task, testing::make_tooth(
                                    {-3.3, -3.3, -3.3}, {3.3, 3.3, 3.3}, 0.1,
                                    [](Vec3 p) { return length(p) < 3 ? k_enamel : k_air; },
                                    [](Vec3 p) { return length(p) - 3; }));
  const grading::GradeInput input{alone.scenario, alone.before,  alone.zones,   alone.after,
                                  alone.inputs,   alone.records, alone.removed, alone.events};
  EXPECT_EQ(times(untouched, "</text>"), times(picture_from_above(input).svg, "</text>") + 2)
      << "the key names the neighbour and what was cut of it, and no gum, for there is none";
}

TEST(AdjacentInPictures, SectionsLeadThroughTheDeepestPlaceOfANick) {
  CarvedAdjacent c(k_task, two_balls());
  const auto sections = [&](SectionOf kind) {
    const grading::Result r = c.graded();
    return c.with_input(
        [&](const grading::GradeInput& input) { return sections_of(kind, r, input); });
  };
  EXPECT_TRUE(sections(SectionOf::nick).empty());
  ASSERT_EQ(sections(SectionOf::contact).size(), 1u) << "the contact still stands";
  EXPECT_NE(sections(SectionOf::contact)[0].title.find("0.00 mm"), std::string::npos);
  c.carve([](Vec3 p) { return length(p - Vec3{3, 0.5, 0.4}) - 0.6; }, 5, {2, -2, -2}, {5, 2, 2});
  // its middle lies 0.07 mm outside the neighbour, a ball around (6, 0, 0)
  ASSERT_FALSE(sections(SectionOf::nick).empty());
  EXPECT_NE(sections(SectionOf::nick)[0].title.find("0.53 mm"), std::string::npos);
}

/// A box of 3 x 2 x 2 mm in a block.
class MistakePictures : public ::testing::Test {
 protected:
  MistakePictures()
      : work_(testing::scenario_text(
                  "[[zones.target]]\nshape = \"box\"\nat_mm = [0, 0, -0.5]\nsize_mm = [3, 2, 3]\n"),
              testing::dentin_block(4, 5, 0.1)) {}
  [[nodiscard]] std::string image(Picture (*draw)(const grading::GradeInput&)) const {
    const std::string svg = draw(work_.input()).svg;
    const auto from = svg.find("base64,");
    return svg.substr(from, svg.find('\'', from) - from);
  }
  testing::Carved work_;
};

TEST_F(MistakePictures, WhoCutsTheTargetAndNothingElseSeesThePlan) {
  EXPECT_NE(image(picture_from_above), image(picture_as_planned));
  work_.carve(testing::box_hole(-1.5, 1.5, -1, 1, -2), 500);
  EXPECT_EQ(image(picture_from_above), image(picture_as_planned));
  work_.carve(testing::box_hole(-1.5, 1.5, 1, 1.4, -2), 600);
  EXPECT_NE(image(picture_from_above), image(picture_as_planned));
}

TEST_F(MistakePictures, ASectionThroughAMistakeShowsCavityAndWallWithItAndRingsIt) {
  work_.carve(testing::box_hole(-1.5, 1.5, -1, 1, -2), 500);
  EXPECT_FALSE(section_of_mistake(work_.input(), {0, 0, -2}).has_value()) << "nothing is wrong";
  work_.carve(testing::box_hole(-1.5, 1.5, 1, 1.5, -2),
              600);  // the buccal wall, 3 mm wide, 2 mm high, 0.5 mm deep
  for (const double y :
       {1.1, 1.45,
        1.95}) {  // 3 x 2 mm of it lie in a plane along the wall, but nothing of the cavity does
    const auto across = section_of_mistake(work_.input(), {0, y, -1});
    ASSERT_TRUE(across.has_value());
    EXPECT_NE(across->view, scenarios::View::mesio_distal) << y;
    EXPECT_EQ(testing_report::times(across->svg, "class='ring'"), 2u);
  }
  EXPECT_EQ(section_of_mistake(work_.input(), {-3, -3, -1}).has_value(), false) << "far from it";
}

TEST_F(MistakePictures, AFloorCutTooDeepShowsUprightWithTheCavityAboveIt) {
  work_.carve(testing::box_hole(-1.5, 1.5, -1, 1, -2.6), 500);
  const auto floor = section_of_mistake(work_.input(), {0, 0, -2.55});
  ASSERT_TRUE(floor.has_value());
  EXPECT_NE(floor->view, scenarios::View::horizontal);
}

TEST_F(MistakePictures, WhatCannotBeSeenHasNoSectionOfItsOwn) {
  const auto overcuts = [&] {
    return sections_of(SectionOf::overcut, work_.graded(), work_.input()).size();
  };
  work_.carve(testing::box_hole(-1.5, 1.5, -1, 1.02, -2), 500);
  EXPECT_EQ(overcuts(), 0u);
  work_.carve(testing::box_hole(-1.5, 1.5, -1, 1.4, -2), 600);
  EXPECT_GT(overcuts(), 0u);
}

}  // namespace
}  // namespace cavum::report
