// Bands of a rubric, on cavities whose walls are known.
#include "grading/result/bands.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "grading/result/result_json.h"
#include "tests/engine/support/basics.h"
#include "tests/grading/carved.h"

namespace cavum::grading {
namespace {

using testing::box_hole;
using testing::Carved;
using testing::dentin_block;
using testing::scenario_text;

constexpr char k_bands_target[] =
    "[[zones.target]]\nshape = \"column\"\noutline = { kind = \"polygon\", points_mm = [[-1.5, -1], [1.5, -1], [1.5, 1], [-1.5, 1]] }\nbottom = { "
    "kind = \"level\", z_mm = -2 }\n";

/// Bands with `most` marginal criteria; limits of the mesial and of the distal wall, and of the
/// target's share.
scenarios::RubricSpec rubric(int most_marginal, const std::string& bands_of_walls = "[0.2, 0.5]") {
  const auto wall = [&](const std::string& side) {
    return "[[criteria]]\nid = \"" + side + "\"\nmetric = \"" + side +
           "_max_over_mm\"\nfull = 0.1\nzero = 2\npoints = 10\nbands = " + bands_of_walls + "\n";
  };
  return scenarios::parse_rubric(
      "rule = \"compensatory\"\npass_percent = 50\n[[bands]]\nname = \"acceptable\"\n[[bands]]\nname = \"marginal\"\nmost = " +
          std::to_string(most_marginal) + "\n[[bands]]\nname = \"critical\"\nmost = 0\n" +
          wall("mesial") + wall("distal") +
          "[[criteria]]\nid = \"removed\"\nmetric = \"target_removed_percent\"\nfull = 97\nzero = 10\npoints = 10\nbands = [95, 60]\n",
      "r.toml");
}

/// Cut to the floor, `mesial` and `distal` beyond the target's walls.
Result cut_beyond(double mesial, double distal, const scenarios::RubricSpec& by, double depth = 2) {
  Carved c(scenario_text(k_bands_target), dentin_block(4, 4, 0.05));
  c.carve(box_hole(-1.5 - distal, 1.5 + mesial, -1, 1, -depth), 0);
  return grade(c.input(), by);
}
std::string band(const Result& r, std::size_t criterion) {
  return r.bands.at(r.criteria.at(criterion).band.value()).name;
}

TEST(Bands, AValueLiesInTheFirstBandWhoseLimitItDoesNotPass) {
  const Result r = cut_beyond(0.35, 0.0, rubric(1));
  EXPECT_EQ(band(r, 0), "marginal");
  EXPECT_EQ(band(r, 1), "acceptable");
  EXPECT_EQ(band(r, 2), "acceptable") << "more is better: 100 % does not pass 95 %";
  EXPECT_EQ(r.verdict, Verdict::pass);
  const auto j = to_json(r);
  EXPECT_EQ(j["criteria"][0]["band"], "marginal");
  EXPECT_EQ(j["score"]["bands"][0]["criteria"], 2);
  EXPECT_EQ(j["score"]["bands"][1]["most"], 1);
  EXPECT_TRUE(testing_basics::tells(r.criteria[0].reason(), "marginal") &&
              testing_basics::tells(r.criteria[0].reason(), 0.2));
}

TEST(Bands, OneMoreThanABandMayHoldFailsWhateverThePoints) {
  EXPECT_EQ(cut_beyond(0.35, 0.0, rubric(1)).verdict, Verdict::pass);
  const Result two = cut_beyond(0.35, 0.35, rubric(1));
  EXPECT_EQ(two.verdict, Verdict::fail);
  EXPECT_GT(two.points, 0.5 * two.max_points) << "by points alone it would pass";
  EXPECT_EQ(two.verdict_reasons.at(0).kind, FindingKind::bands_too_full);
  EXPECT_EQ(std::get<std::int64_t>(two.verdict_reasons[0].values[0]), 2);
  EXPECT_EQ(cut_beyond(0.35, 0.35, rubric(2)).verdict, Verdict::pass);
  const Result deficient = cut_beyond(0.7, 0.0, rubric(2));
  EXPECT_EQ(deficient.verdict, Verdict::fail);
  EXPECT_EQ(deficient.verdict_reasons.at(0).kind, FindingKind::band_too_full);
}

TEST(Bands, CareForLessThanHalfOfTheWorkLiesInTheWorst) {
  const Result r = cut_beyond(0.0, 0.0, rubric(3), 0.6);
  EXPECT_LT(r.criteria.at(0).work_share, 1);
  EXPECT_EQ(band(r, 0), "critical") << "a wall of 0.6 mm without a fault is no good wall";
  EXPECT_EQ(band(r, 2), "critical") << "30 % removed";
}

TEST(Bands, ALimitWithinTheFiguresBoundIsSaid) {
  const Result r = cut_beyond(0.21, 0.0, rubric(1));
  const auto facts = [](const Result& of) { return of.criteria[0].facts.size(); };
  EXPECT_EQ(facts(r), facts(cut_beyond(0.35, 0.0, rubric(1))) + 1) << r.criteria[0].reason();
}

TEST(Bands, ARubricWithoutThemSaysNothingOfThem) {
  Carved c(scenario_text(k_bands_target), dentin_block(4, 4, 0.05));
  c.carve(box_hole(-1.5, 1.5, -1, 1, -2), 0);
  const auto j = to_json(c.graded());
  EXPECT_FALSE(j["score"].contains("bands"));
  EXPECT_FALSE(j["criteria"][0].contains("band"));
}

TEST(Bands, WrongLimitsAreRefused) {
  EXPECT_THROW(rubric(1, "[0.5, 0.2]"), Error) << "out of order";
  EXPECT_THROW(rubric(1, "[0.2]"), Error) << "too few";
  EXPECT_THROW(rubric(1, "[0.05, 0.5]"), Error) << "better than full marks";
  EXPECT_NO_THROW(rubric(1, "[0.1, 0.5]"));
}

}  // namespace
}  // namespace cavum::grading
