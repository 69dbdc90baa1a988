// Progress over attempts: by closed forms, and by simulated candidates who stay the same or learn.
#include "grading/cohort/progress.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "tests/engine/support/basics.h"

namespace cavum::cohort {
namespace {

using Marks = std::vector<double>;

TEST(Progress, TheScatterIsThatOfTheStepsOverTheRootOfTwo) {
  // steps 4, -4, 4, -4, ... : their mean 0, their variance 16 * 10 / 9
  std::vector<Marks> marks;
  for (int i = 0; i < 5; ++i) marks.push_back({70, 74, 70});
  const auto s = attempt_scatter(marks);
  ASSERT_TRUE(s);
  EXPECT_NEAR(s->sd_percent, std::sqrt(16 * 10.0 / 9 / 2), 1e-12);
  EXPECT_EQ(s->steps, 10u);
  EXPECT_EQ(s->candidates, 5u);
  marks.pop_back();
  EXPECT_FALSE(attempt_scatter(marks)) << "four people say too little";
  EXPECT_FALSE(attempt_scatter({{1}, {2}, {3}, {4}, {5}, {6}, {7}, {8}, {9}}))
      << "and people with one attempt nothing";
}

TEST(Progress, TheBoundIsThatOfStudentsTable) {
  AttemptScatter s{2.0, 0.0, 40, 11};
  const Marks two{60, 80}, three{60, 80, 70}, one{60};
  EXPECT_FALSE(progress(one, s));
  const auto after_two = progress(two, s), after_three = progress(three, s);
  EXPECT_NEAR(after_two->change_percent, 20, 1e-12);
  EXPECT_NEAR(after_two->bound_percent, 2.7638 * 2 * std::sqrt(2.0),
              0.001);  // t of 10 degrees of freedom, 1 % on each side
  EXPECT_NEAR(after_three->change_percent, 10, 1e-12) << "the line through 60, 80 and 70";
  EXPECT_NEAR(after_three->bound_percent, 3.3790 * 2 * std::sqrt(2.0),
              0.2);  // 0.333 % on each side; of tables: 3.169 at 0.5 %, 3.581 at 0.25 %
  EXPECT_TRUE(after_two->told());
  EXPECT_TRUE(after_three->told());
  s.largest_percent = 25;  // somebody's mark went up or down by so much: that may happen to anybody
  EXPECT_NEAR(progress(two, s)->bound_percent, 25, 1e-12);
  EXPECT_NEAR(progress(three, s)->bound_percent, 25, 1e-12);
  EXPECT_FALSE(progress(two, s)->told());
}

/// Marks of kinds of people: what varies from attempt to attempt.
struct Kind {
  std::string name;
  double (*mark)(double skill, std::mt19937_64& random);
};
double bounded(double p) { return std::clamp(p, 0.0, 100.0); }
const Kind k_kinds[] = {
    {"normal",
     [](double skill, std::mt19937_64& r) { return std::normal_distribution(skill, 6.0)(r); }},
    {"at the ceiling",
     [](double skill, std::mt19937_64& r) {
       return bounded(std::normal_distribution(skill + 15, 6.0)(r));
     }},
    {"slips",
     [](double skill, std::mt19937_64& r) {
       return bounded(skill - std::exponential_distribution(0.15)(r));
     }},
    {"fails at times",
     [](double skill, std::mt19937_64& r) {
       return bounded(std::normal_distribution(skill, 4.0)(r) -
                      (std::bernoulli_distribution(0.1)(r) ? 25 : 0));
     }},
};
/// A class of 30 that sits two or three times each, and learns a little at different rates.
AttemptScatter scatter_of_class(const Kind& kind, std::mt19937_64& random) {
  std::vector<Marks> marks;
  for (int i = 0; i < 30; ++i) {
    const double skill = std::normal_distribution(75.0, 8.0)(random),
                 learns = std::normal_distribution(3.0, 2.0)(random);
    Marks of_one;
    for (int a = 0; a < 2 + i % 2; ++a) of_one.push_back(kind.mark(skill + learns * a, random));
    marks.push_back(of_one);
  }
  return attempt_scatter(marks).value();
}
/// Share of people told of a change after one of their attempts.
double share_told(const Kind& kind, int people, int attempts, double gain,
                  std::mt19937_64& random) {
  int told = 0;
  for (int i = 0; i < people; ++i) {
    const AttemptScatter scatter = scatter_of_class(kind, random);
    const double skill = std::normal_distribution(gain > 0 ? 55.0 : 75.0, 5.0)(random);
    Marks marks;
    bool once = false;
    for (int a = 0; a < attempts; ++a) {
      marks.push_back(kind.mark(skill + gain * a, random));
      const auto p = progress(marks, scatter);
      once = once || (p && p->told());
    }
    told += once ? 1 : 0;
  }
  return static_cast<double>(told) / people;
}

TEST(Progress, WhoStaysTheSameIsSeldomToldOfAChangeHoweverOftenTheySit) {
  std::mt19937_64 random(testing_basics::drawn_seed("Progress.WhoStaysTheSame"));
  constexpr int k_people = 4000;
  for (const Kind& kind : k_kinds) {
    const double told = share_told(kind, k_people, 8, 0, random);
    std::printf("%-16s told of a change without one: %.1f %%\n", kind.name.c_str(), 100 * told);
    EXPECT_LE(told, 0.05 + 4 * std::sqrt(0.05 * 0.95 / k_people)) << kind.name;
  }
}

TEST(Progress, WhoLearnsAsMuchAsFromNoviceToExpertIsToldWithinThreeAttempts) {
  std::mt19937_64 random(testing_basics::drawn_seed("Progress.WhoLearns"));
  for (const Kind& kind : k_kinds) {
    for (const double gain : {5.0, 10.0, 15.0, 20.0})
      std::printf("%-16s gains %2.0f %% each time: %.1f %% told within three\n", kind.name.c_str(),
                  gain, 100 * share_told(kind, 1000, 3, gain, random));
  }
  EXPECT_GE(share_told(k_kinds[0], 1000, 3, 20, random), 0.9)
      << "6 % from one time to the next, 40 % learned";
}

}  // namespace
}  // namespace cavum::cohort
