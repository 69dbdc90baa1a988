// Severity of stations and raters: balanced, it is the difference of means; in part shared, known
// severities are found within their errors.
#include "grading/cohort/severity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "engine/base/error.h"
#include "engine/base/random.h"
#include "tests/engine/support/basics.h"
#include "tests/grading/cohort/drawn_class.h"

namespace cavum::cohort {
namespace {

TEST(SeverityOfConditions, BalancedItIsTheDifferenceOfMeans) {
  // Two candidates at both of two stations: station 1 takes 4 off, the rest is by hand.
  const std::vector<StudyMark> marks{{{0, 0}, 80}, {{0, 1}, 77}, {{1, 0}, 60}, {{1, 1}, 55}};
  const SeverityStudy s = study_severity(marks);
  EXPECT_NEAR(s.facets[0].conditions[0].severity, -2, 1e-12);
  EXPECT_NEAR(s.facets[0].conditions[1].severity, 2, 1e-12);
  EXPECT_NEAR(s.persons[0].raw, 78.5, 1e-12);
  EXPECT_NEAR(s.persons[0].adjusted, 78.5, 1e-12) << "both sat at both";
  EXPECT_NEAR(s.residual_sd, 1 / std::sqrt(2.0) * std::sqrt(2.0), 1e-12)
      << "four residuals of 0.5 on one degree of freedom: 1";
  // A station's effect is half the difference of two means of two marks: its variance is s²/4·(1/2
  // + 1/2) = s²/4.
  EXPECT_NEAR(s.facets[0].conditions[0].error, 0.5, 1e-12);
}

TEST(SeverityOfConditions, WhoSatAtTheSevereStationAloneIsHelped) {
  // Candidate 2 was only at station 1, which took 10 off the others.
  const std::vector<StudyMark> marks{{{0, 0}, 80}, {{0, 1}, 70}, {{1, 0}, 61},
                                     {{1, 1}, 49}, {{2, 1}, 65}, {{3, 0}, 75}};
  const SeverityStudy s = study_severity(marks);
  EXPECT_NEAR(s.facets[0].conditions[1].severity, 5.5, 1e-12);
  EXPECT_NEAR(s.persons[2].adjusted, 70.5, 1e-12);
  EXPECT_NEAR(s.persons[3].adjusted, 69.5, 1e-12);
}

TEST(SeverityOfConditions, WhatRoundingLeavesIsNoSeverity) {
  std::vector<StudyMark> marks;
  for (std::uint32_t p = 0; p < 7; ++p)
    for (std::uint32_t station = 0; station < 3; ++station)
      marks.push_back({{p, station}, 100.0 / 3 + 0.1 * p});
  const SeverityStudy study = study_severity(marks);
  for (const Severity& s : study.facets[0].conditions)
    EXPECT_FALSE(s.beyond_chance) << s.severity << " ± " << s.error;
}

TEST(SeverityOfConditions, StationsThatShareNobodyAreNotCompared) {
  EXPECT_THROW((void)study_severity(
                   std::vector<StudyMark>{{{0, 0}, 80}, {{1, 0}, 70}, {{2, 1}, 60}, {{3, 1}, 65}}),
               Error);
  EXPECT_THROW((void)study_severity(std::vector<StudyMark>{{{0, 0}, 80}, {{0, 1}, 70}}), Error)
      << "nothing is left for chance";
  EXPECT_THROW((void)study_severity({}), Error);
}

/// 80 candidates; each is seen at 3 of 6 stations by one of 5 raters.
struct ClassOfKnownSeverity {
  std::vector<double> station, rater;
  double residual = 6;
  std::vector<double> truth;
  std::vector<StudyMark> draw(Random& random) {
    std::vector<StudyMark> marks;
    truth.clear();
    for (std::uint32_t p = 0; p < 80; ++p) {
      truth.push_back(70 + 9 * random.normal());
      const auto first = static_cast<std::uint32_t>(random.below(station.size()));
      for (std::uint32_t i = 0; i < 3; ++i) {
        const std::uint32_t s = (first + i) % static_cast<std::uint32_t>(station.size());
        const auto r = static_cast<std::uint32_t>(random.below(rater.size()));
        marks.push_back(
            {{p, s, r}, truth.back() - station[s] - rater[r] + residual * random.normal()});
      }
    }
    return marks;
  }
};

TEST(SeverityOfConditions, KnownSeveritiesAreFoundWithinTheirErrors) {
  ClassOfKnownSeverity known{{0, 0, 0, 0, 0, 0}, {-6, -1, 0, 1, 6}, 6, {}};
  Random random(3);
  int held = 0, asked = 0, alarms = 0, found = 0;
  double raw = 0, adjusted = 0;
  constexpr int k_draws_of_severity = 200;
  for (int i = 0; i < k_draws_of_severity; ++i) {
    const SeverityStudy s = study_severity(known.draw(random));
    for (std::size_t r = 0; r < known.rater.size(); ++r) {
      held += std::fabs(s.facets[1].conditions[r].severity - known.rater[r]) <=
              1.96 * s.facets[1].conditions[r].error;
      ++asked;
    }
    bool any = false;
    for (const auto& station : s.facets[0].conditions) any = any || station.beyond_chance;
    alarms += any;
    found += s.facets[1].conditions[0].beyond_chance && s.facets[1].conditions[4].beyond_chance;
    for (std::size_t p = 0; p < known.truth.size(); ++p) {
      raw += std::pow(s.persons[p].raw - known.truth[p], 2);
      adjusted += std::pow(s.persons[p].adjusted - known.truth[p], 2);
    }
  }
  std::printf(
      "held by 1.96 errors %.1f %%; an equal station called severe in %.1f %% of classes; both severe raters found in %.1f %%; error of a mark %.2f "
      "raw, %.2f adjusted\n",
      100.0 * held / asked, 100.0 * alarms / k_draws_of_severity,
      100.0 * found / k_draws_of_severity, std::sqrt(raw / (80 * k_draws_of_severity)),
      std::sqrt(adjusted / (80 * k_draws_of_severity)));
  EXPECT_NEAR(double(held) / asked, 0.95, 0.025);
  EXPECT_LE(alarms, 0.09 * k_draws_of_severity);
  EXPECT_GE(found, 0.95 * k_draws_of_severity);
  EXPECT_LT(adjusted, raw);
}

/// No judge is severe; what judges do together with candidates and exams is no severity.
struct EqualJudges {
  const char* words;
  drawn::Allocation places;
  drawn::Truth truth;
  double least_found;  // share of classes in which one who takes 6 off is named
};
std::vector<drawn::Levels> by_three(Random&) { return drawn::crossed(30, 3, 3); }

TEST(SeverityOfConditions, InteractionsAreNotCalledSeverity) {
  const drawn::Truth none{.exam = 9,
                          .judge = 0,
                          .candidate_exam = 16,
                          .candidate_judge = 0,
                          .exam_judge = 0,
                          .rest = 16};
  const auto with = [&](double candidate_judge, double exam_judge) {
    drawn::Truth t = none;
    t.candidate_judge = candidate_judge, t.exam_judge = exam_judge;
    return t;
  };
  const EqualJudges designs[] = {
      {"3 judges, no interaction", by_three, none, 0.9},
      {"3 judges, candidate x judge 36", by_three, with(36, 0), 0.5},
      {"pairs of 6 judges, candidate x judge 36", drawn::fixed_pairs, with(36, 0), 0.05},
      {"pairs of 6 judges, candidate x judge 9", drawn::fixed_pairs, with(9, 0), 0.35},
      {"pairs of 6 judges for each work, 9", drawn::drawn_pairs, with(9, 0), 0.15},
      {"3 judges, exam x judge of SD 2", by_three, with(0, 4), 0.3},
      {"3 judges, exam x judge of SD 5", by_three, with(0, 25), 0.0},
      {"3 judges, both 9", by_three, with(9, 9), 0.1},
      {"a quarter missing, 4 judges, both 4", drawn::a_quarter_missing, with(4, 4), 0.4}};
  Random random(testing_basics::drawn_seed("InteractionsAreNotCalledSeverity"));
  const int classes = std::getenv("CAVUM_DEEP") != nullptr ? 1000 : 60;
  for (const EqualJudges& d : designs) {
    int named = 0, found = 0, wrongly = 0;
    for (int i = 0; i < classes; ++i) {
      auto marks = drawn::draw(d.places(random), d.truth, random).marks;
      for (const Severity& s : study_severity(marks).facets[1].conditions)
        if (s.beyond_chance) {
          ++named;
          break;
        }
      for (StudyMark& m : marks) m.value -= m.level[2] == 0 ? 6 : 0;
      const auto judges = study_severity(marks).facets[1].conditions;
      found += judges[0].beyond_chance && judges[0].severity > 0;
      for (std::size_t j = 1; j < judges.size(); ++j)
        wrongly += judges[j].beyond_chance && judges[j].severity > 0;
    }
    std::printf(
        "%-42s equal judges named in %.1f %% of classes; one who takes 6 off found in %.1f %%\n",
        d.words, 100.0 * named / classes, 100.0 * found / classes);
    EXPECT_LE(named, 0.05 * classes + 4 * std::sqrt(0.05 * 0.95 * classes)) << d.words;
    EXPECT_GE(found, d.least_found * classes) << d.words;
    EXPECT_LE(wrongly, 0.05 * classes + 4 * std::sqrt(0.05 * 0.95 * classes))
        << d.words << ": somebody else";
  }
}

TEST(SeverityOfConditions, WhereAnInteractionMayBeItNobodyIsNamed) {
  Random random(9);
  auto marks =
      drawn::draw(drawn::crossed(30, 1, 3), {.judge = 0, .candidate_judge = 0, .rest = 4}, random)
          .marks;
  for (StudyMark& m : marks) m.value -= m.level[2] == 0 ? 20 : 0;
  const SeverityOfFacet judges = study_severity(marks).facets[1];
  EXPECT_EQ(judges.indistinguishable_from, (std::vector<std::uint32_t>{2}))
      << "one exam: it and a judge may do this together";
  EXPECT_NEAR(judges.conditions[0].severity, 40.0 / 3, 2) << "is told, and judged by nobody";
  EXPECT_FALSE(judges.conditions[0].beyond_chance);
  for (StudyMark& m : marks) m.level[1] = m.level[0] % 3, m.level[2] = 0;
  std::erase_if(marks, [&, seen = std::set<std::uint32_t>()](const StudyMark& m) mutable {
    return !seen.insert(m.level[0] * 3 + m.level[1]).second;
  });
  for (std::uint32_t p = 0; p < 30; ++p) marks.push_back({{p, (p + 1) % 3, 0}, 50.0 + p % 4});
  EXPECT_TRUE(study_severity(marks).facets[1].indistinguishable_from.empty())
      << "one judge is compared with nobody";
}

}  // namespace
}  // namespace cavum::cohort
