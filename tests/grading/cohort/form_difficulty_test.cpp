// Forms of known difficulty, sat by drawn candidates: how often intervals hold, alarms are false,
// and real differences are found.
#include "grading/cohort/form_difficulty.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "engine/base/error.h"
#include "engine/base/random.h"

namespace cavum::cohort {
namespace {

struct DrawnClass {
  Matrix marks;
  std::vector<double> skill;
};

/// How marks come about in the tests: the more able scatter less, everybody has good and bad days,
/// and nobody has more than 100.
struct KnownForms {
  std::vector<double> harder;  // points that each form takes away
  double scatter = 12.0;   // of a beginner's mark from form to form; an expert's is a tenth of it
  bool weak_only = false;  // an expert does not feel that a form is harder

  [[nodiscard]] DrawnClass draw(std::size_t n, Random& random) const {
    DrawnClass drawn;
    for (std::size_t c = 0; c < n; ++c) {
      const double skill = (2.0 * static_cast<double>(c) + 1) / (2.0 * static_cast<double>(n));
      const double day = 6 * (1 - skill) * random.normal();
      drawn.skill.push_back(skill);
      auto& row = drawn.marks.emplace_back();
      for (const double points : harder) {
        const double takes = weak_only ? points * 2 * (1 - skill) : points;
        row.push_back(std::clamp(
            55 + 42 * skill + day - takes + scatter * (1 - 0.9 * skill) * random.normal(), 0.0,
            100.0));
      }
    }
    return drawn;
  }
  /// Mean of each form less that of all, from many candidates of the same skills.
  [[nodiscard]] std::vector<double> truth(std::size_t n) const {
    constexpr int k_times = 3000;
    Random random(7);
    std::vector<double> sum(harder.size());
    for (int t = 0; t < k_times; ++t)
      for (const auto& row : draw(n, random).marks)
        for (std::size_t f = 0; f < row.size(); ++f)
          sum[f] += row[f] / (k_times * static_cast<double>(n));
    const double all = mean(sum);
    for (double& v : sum) v -= all;
    return sum;
  }
};

/// Shares of classes, 0..1.
struct Rates {
  double holds = 0, significant = 0, false_alarm = 0, found = 0, depends = 0, spread = 0;
};
Rates rates_of(const KnownForms& forms, std::size_t n, double limit, int classes) {
  const auto truth = forms.truth(n);
  Rates r;
  for (int i = 0; i < classes; ++i) {
    Random random(1000 + static_cast<std::uint64_t>(i));
    const auto drawn = forms.draw(n, random);
    const FormsJudged judged =
        judge_forms(drawn.marks, drawn.skill, limit, static_cast<std::uint64_t>(i));
    bool holds = true, wrong = false, found = true, depends = false;
    for (std::size_t f = 0; f < truth.size(); ++f) {
      const FormDifficulty& d = judged.forms[f];
      holds = holds && truth[f] >= d.low && truth[f] <= d.high;
      const bool alarm = d.verdict == FormVerdict::too_easy || d.verdict == FormVerdict::too_hard;
      wrong = wrong || (alarm && std::fabs(truth[f]) <= limit) ||
              (d.verdict == FormVerdict::alike && std::fabs(truth[f]) > limit);
      found = found && (std::fabs(truth[f]) <= limit || alarm);
      depends = depends || d.depends_on_skill;
    }
    r.holds += holds, r.false_alarm += wrong, r.found += found, r.depends += depends;
    r.significant += judged.chance < 0.05;
    r.spread += judged.spread;
  }
  for (double* v : {&r.holds, &r.significant, &r.false_alarm, &r.found, &r.depends, &r.spread})
    *v /= classes;
  return r;
}

const int k_classes = std::getenv("CAVUM_DEEP") != nullptr ? 1000 : 150;
// three standard errors of a share of 5 % in so many classes
const double k_chance_of_rates = 3 * std::sqrt(0.05 * 0.95 / k_classes);

void say(const char* what, const Rates& r) {
  std::printf(
      "%s: intervals hold %.3f, significant %.3f, wrong verdicts %.3f, all found %.3f, depends on skill %.3f, spread %.2f\n",
      what, r.holds, r.significant, r.false_alarm, r.found, r.depends, r.spread);
}

TEST(FormDifficulty, EqualFormsAreSeldomCalledUnequal) {
  for (const std::size_t n : {12u, 40u}) {
    const Rates r = rates_of({std::vector<double>(8, 0.0)}, n, 3.0, k_classes);
    say("equal forms", r);
    EXPECT_GE(r.holds, 0.95 - k_chance_of_rates) << n;
    EXPECT_LE(r.significant, 0.05 + k_chance_of_rates) << n;
    EXPECT_LE(r.false_alarm, 0.05 + k_chance_of_rates) << n;
    EXPECT_LE(r.depends, 0.05 + k_chance_of_rates) << n;
  }
}

TEST(FormDifficulty, IntervalsHoldAndHardFormsAreFound) {
  const KnownForms forms{{0, 0, 0, 0, 0, 0, 9, -1}};
  const Rates r = rates_of(forms, 60, 3.0, k_classes);
  say("one hard form", r);
  EXPECT_GE(r.holds, 0.95 - k_chance_of_rates);
  EXPECT_LE(r.false_alarm, 0.05 + k_chance_of_rates);
  EXPECT_GE(r.found, 0.9);
  EXPECT_GE(r.significant, 0.99);
  const auto truth = forms.truth(60);
  EXPECT_NEAR(r.spread, std::sqrt(variance(truth)), 0.3) << "what chance adds is taken off";
}

TEST(FormDifficulty, AtTheLimitNoVerdictIsWrongTooOften) {
  KnownForms forms{{0, 0, 0, 3.9}};
  Rates r = rates_of(forms, 40, std::fabs(forms.truth(40)[3]) + 1e-6, k_classes);
  say("at the limit", r);
  EXPECT_LE(r.false_alarm, 0.05 + k_chance_of_rates);
  r = rates_of(forms, 40, std::fabs(forms.truth(40)[3]) - 1e-6, k_classes);
  EXPECT_LE(r.false_alarm, 0.05 + k_chance_of_rates) << "called alike although it is just beyond";
}

TEST(FormDifficulty, AFormThatIsHardForTheWeakAloneIsSaidToDependOnSkill) {
  const Rates r = rates_of({{0, 0, 0, 0, 0, 12}, 8.0, true}, 80, 3.0, 100);
  say("hard for the weak", r);
  EXPECT_GE(r.depends, 0.9);
}

TEST(FormDifficulty, FiguresAreThoseOfAWorkedTable) {
  // ten candidates, two forms; the second gives each of them 4 more but the last, who has 14 more
  Matrix marks;
  std::vector<double> skill;
  for (int c = 0; c < 10; ++c) {
    marks.push_back({50.0 + c, 54.0 + c + (c == 9 ? 10 : 0)});
    skill.push_back(c);
  }
  const FormsJudged j = judge_forms(marks, skill, 2.0, 1);
  EXPECT_NEAR(j.forms[0].mean, 54.5, 1e-9);
  EXPECT_NEAR(j.forms[1].mean, 59.5, 1e-9);
  EXPECT_NEAR(j.forms[1].easier, 2.5, 1e-9);
  EXPECT_NEAR(j.forms[0].constant, 2.5, 1e-9);
  EXPECT_NEAR(j.forms[1].easier_error, 0.5, 1e-9)
      << "halves of differences 4, nine times, and 14: sd 5/sqrt(10), over sqrt(10)";
  EXPECT_NEAR(j.forms[1].easier_for_weak, 2.0, 1e-9);
  EXPECT_NEAR(j.forms[1].easier_for_able, 3.0, 1e-9);
  EXPECT_NEAR(j.spread, std::sqrt(2 * 2.5 * 2.5 - 2 * 0.25), 1e-9);
  EXPECT_LT(j.chance, 0.02) << "the same form is the better one ten times of ten";
}

TEST(FormDifficulty, RefusesWhatCannotBeJudged) {
  const Matrix few(9, std::vector<double>{1, 2});
  EXPECT_THROW((void)judge_forms(few, std::vector<double>(9), 3, 1), Error);
  EXPECT_THROW((void)judge_forms(Matrix(10, std::vector<double>{1}), std::vector<double>(10), 3, 1),
               Error);
  EXPECT_THROW(
      (void)judge_forms(Matrix(10, std::vector<double>{1, 2}), std::vector<double>(9), 3, 1),
      Error);
  EXPECT_THROW(
      (void)judge_forms(Matrix(10, std::vector<double>{1, 2}), std::vector<double>(10), 0, 1),
      Error);
  Matrix ragged(10, std::vector<double>{1, 2});
  ragged[3].pop_back();
  EXPECT_THROW((void)judge_forms(ragged, std::vector<double>(10), 3, 1), Error);
}

}  // namespace
}  // namespace cavum::cohort
