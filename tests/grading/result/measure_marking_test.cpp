// What the measures say to marking, held against the JSON that they say they are in.
#include "grading/result/measure_marking.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "grading/result/result_json.h"
#include "tests/grading/carved.h"

namespace cavum::grading {
namespace {

using testing::box_hole;
using testing::Carved;
using testing::chambered_block;
using testing::k_chamber_target;
using testing::opening_pulp;

TEST(MeasureMarking, EveryPlaceInTheJsonHoldsTheValueAndItsBound) {
  const std::string asked =
      "[[rubric.criteria]]\nid = \"left\"\nmetric = \"dentin_over_pulp_mm\"\nfull = 1\nzero = 0\npoints = 1\n";
  Carved c(opening_pulp(k_chamber_target) + asked, chambered_block(0.1));
  c.carve(box_hole(-1.5, 0.4, -1, 1.6, -4.7), 100);
  c.carve(box_hole(0.2, 0.9, -1.9, 1, -2), 1000);
  Result r = c.graded();
  r.beside.neighbours = r.beside.gum = true;
  r.beside.nick_depth_mm = 0.3;
  r.beside.nick_depth_bound_mm = 0.1;
  r.beside.clearance_mm = 0.2;
  r.beside.gum_touched_s = 1.5;
  const auto json = to_json(r);
  std::size_t places = 0, bounds = 0;
  const auto at = [&](const std::string& pointer) {
    const nlohmann::ordered_json::json_pointer place(pointer);
    EXPECT_TRUE(json.contains(place)) << pointer;
    return json.contains(place) ? json[place] : nlohmann::ordered_json();
  };
  const auto number = [](const nlohmann::ordered_json& j) {
    return j.is_boolean() ? (j.get<bool>() ? 1.0 : 0.0) : j.get<double>();
  };
  for (const auto& m : scenarios::measures()) {
    if (!m.tissue.empty() && std::none_of(r.tissues.begin(), r.tissues.end(),
                                          [&](const Tissue& t) { return t.name == m.tissue; }))
      continue;
    const MetricValue v = metric_value(r, m.name);
    if (const std::string pointer = json_location(m); !pointer.empty()) {
      ++places;
      if (const auto found = at(pointer); !found.is_null()) {
        ASSERT_TRUE(v.value) << m.name;
        EXPECT_EQ(number(found), rounded(*v.value)) << m.name;
      }
    }
    if (const std::string pointer = bound_json_location(m); !pointer.empty()) {
      ++bounds;
      if (const auto found = at(pointer); !found.is_null()) {
        EXPECT_EQ(number(found), rounded(v.bound)) << m.name;
      }
    }
  }
  EXPECT_GT(places, 45u);
  EXPECT_GT(bounds, 35u);
}

}  // namespace
}  // namespace cavum::grading
