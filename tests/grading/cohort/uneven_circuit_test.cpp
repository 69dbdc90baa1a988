// Circuits whose candidates have unequal numbers of exams and judges, or judges of their own: classes of known components, whose marks' errors are known
// because they were drawn. What is stated must be what is there.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <set>

#include "engine/base/random.h"
#include "engine/statistics/statistics.h"
#include "grading/cohort/circuit_study.h"
#include "tests/engine/support/basics.h"

namespace cavum::cohort {
namespace {

using Levels = std::vector<std::uint32_t>;

/// Who marks what: candidate, exam, judge of each mark.
using Allocation = std::function<std::vector<Levels>(Random&)>;

struct Truth {
  double candidate = 36, exam = 4, judge = 16, candidate_exam = 4, candidate_judge = 25, exam_judge = 1, rest = 25;  // variances
};

/// The whole mark less the candidate's own true mark, of each allocation's place.
struct DrawnClass {
  std::vector<StudyMark> marks;
  double squared_error = 0;  // of a candidate's mark, mean over the candidates
};

double effect(std::map<Levels, double>& drawn, const Levels& at, double variance, Random& random) {
  const auto [place, is_new] = drawn.try_emplace(at, 0.0);
  if (is_new) place->second = std::sqrt(variance) * random.normal();
  return place->second;
}

DrawnClass draw(const std::vector<Levels>& places, const Truth& truth, Random& random) {
  std::map<Levels, double> p, t, j, pt, pj, tj;
  std::map<std::uint32_t, std::pair<double, double>> error;
  DrawnClass out;
  for (const Levels& l : places) {
    const double e = effect(t, {l[1]}, truth.exam, random) + effect(j, {l[2]}, truth.judge, random) +
                     effect(pt, {l[0], l[1]}, truth.candidate_exam, random) + effect(pj, {l[0], l[2]}, truth.candidate_judge, random) +
                     effect(tj, {l[1], l[2]}, truth.exam_judge, random) + std::sqrt(truth.rest) * random.normal();
    out.marks.push_back({l, 60 + effect(p, {l[0]}, truth.candidate, random) + e});
    error[l[0]].first += e;
    error[l[0]].second += 1;
  }
  for (const auto& [who, sum] : error) out.squared_error += std::pow(sum.first / sum.second, 2) / static_cast<double>(error.size());
  return out;
}

std::vector<Levels> crossed(std::uint32_t persons, std::uint32_t exams, std::uint32_t judges) {
  std::vector<Levels> places;
  for (std::uint32_t p = 0; p < persons; ++p)
    for (std::uint32_t t = 0; t < exams; ++t)
      for (std::uint32_t j = 0; j < judges; ++j) places.push_back({p, t, j});
  return places;
}

template <class Keep>
std::vector<Levels> kept(std::vector<Levels> places, const Keep& keep) {
  std::erase_if(places, [&](const Levels& l) { return !keep(l); });
  return places;
}

/// Each candidate has a pair of 6 judges, in all exams the same.
std::vector<Levels> fixed_pairs(Random& random) {
  std::map<std::uint32_t, std::set<std::uint32_t>> mine;
  for (std::uint32_t p = 0; p < 30; ++p)
    while (mine[p].size() < 2) mine[p].insert(static_cast<std::uint32_t>(random.below(6)));
  return kept(crossed(30, 3, 6), [&](const Levels& l) { return mine[l[0]].contains(l[2]); });
}
/// Each work has a pair of 6 judges, drawn anew.
std::vector<Levels> drawn_pairs(Random& random) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::set<std::uint32_t>> mine;
  for (std::uint32_t p = 0; p < 30; ++p)
    for (std::uint32_t t = 0; t < 3; ++t)
      while (mine[{p, t}].size() < 2) mine[{p, t}].insert(static_cast<std::uint32_t>(random.below(6)));
  return kept(crossed(30, 3, 6), [&](const Levels& l) { return mine[{l[0], l[1]}].contains(l[2]); });
}
std::vector<Levels> a_quarter_missing(Random& random) {
  return kept(crossed(30, 3, 4), [&](const Levels&) { return random.below(4) > 0; });
}
/// 8 of 40 candidates sat all four exams, the others two.
std::vector<Levels> few_sat_all(Random& random) {
  std::map<std::uint32_t, std::set<std::uint32_t>> mine;
  for (std::uint32_t p = 0; p < 40; ++p)
    while (mine[p].size() < (p < 8 ? 4U : 2U)) mine[p].insert(static_cast<std::uint32_t>(random.below(4)));
  return kept(crossed(40, 4, 2), [&](const Levels& l) { return mine[l[0]].contains(l[1]); });
}

struct Design {
  const char* words;
  Allocation places;
  Truth truth;
};
const Design k_designs[] = {{"2 of 6 judges for each candidate", fixed_pairs, {}},
                            {"2 of 6 judges for each work", drawn_pairs, {}},
                            {"a quarter of the marks missing", a_quarter_missing, {}},
                            {"8 of 40 candidates sat all exams", few_sat_all, {.exam = 25, .judge = 4, .candidate_exam = 36}},
                            {"everybody by the same 2 judges", [](Random&) { return crossed(30, 3, 2); }, {}}};

TEST(UnevenCircuit, StatedErrorAndRangeAreThoseOfTheMarksThatCandidatesHave) {
  Random random(testing_basics::drawn_seed("UnevenCircuit"));
  const int classes = std::getenv("CAVUM_DEEP") != nullptr ? 400 : 60, draws = 200;
  for (const Design& d : k_designs) {
    std::vector<double> truth;
    for (int i = 0; i < 4000; ++i) truth.push_back(draw(d.places(random), d.truth, random).squared_error);
    const double true_variance = mean(truth), phi = d.truth.candidate / (d.truth.candidate + true_variance);
    std::vector<double> stated;
    int held = 0, crossed_bounds = 0;
    for (int i = 0; i < classes; ++i) {
      const DrawnClass c = draw(d.places(random), d.truth, random);
      const VarianceStudy study(crossed_design({"candidate", "exam", "judge"}), c.marks);
      std::vector<double> values;
      for (const auto& m : c.marks) values.push_back(m.value);
      const auto found = study.estimate(values);
      const std::vector<MarkShares> circuit{study.marking().as_given()};
      stated.push_back(dependability(study.design(), found, circuit[0], study.marking().persons()).absolute);
      const auto range = study_ranges(study, found, circuit, draws, random.next()).circuits[0];
      held += range.phi_low <= phi && phi <= range.phi_high;
      crossed_bounds += range.phi_low > range.g_low || range.phi_high > range.g_high;
    }
    const double error = std::sqrt(variance(stated) / classes + variance(truth) / 4000);
    std::printf("%-34s true error ± %.2f, stated ± %.2f (its square %.1f ± %.1f for %.1f); range of phi holds %.2f in %d of %d\n", d.words,
                std::sqrt(true_variance), std::sqrt(mean(stated)), mean(stated), error, true_variance, phi, held, classes);
    EXPECT_NEAR(mean(stated), true_variance, 4 * error + 0.05 * true_variance) << d.words;
    EXPECT_GE(held, 0.86 * classes) << d.words;
    EXPECT_EQ(crossed_bounds, 0) << d.words << ": phi never exceeds g";
  }
}

}  // namespace
}  // namespace cavum::cohort
