// Classes of known components: who was marked by whom, and marks whose errors are known because
// they were drawn.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "engine/base/random.h"
#include "grading/cohort/mark_shares.h"

namespace cavum::cohort::drawn {

using Levels = std::vector<std::uint32_t>;

/// Who marks what: candidate, exam, judge of each mark.
using Allocation = std::function<std::vector<Levels>(Random&)>;

struct Truth {
  double candidate = 36, exam = 4, judge = 16, candidate_exam = 4, candidate_judge = 25,
         exam_judge = 1, rest = 25;  // variances
};

struct DrawnClass {
  std::vector<StudyMark> marks;
  double squared_error = 0;  // of a candidate's mark, mean over the candidates
};

inline double effect(std::map<Levels, double>& drawn, const Levels& at, double variance,
                     Random& random) {
  const auto [place, is_new] = drawn.try_emplace(at, 0.0);
  if (is_new) place->second = std::sqrt(variance) * random.normal();
  return place->second;
}

inline DrawnClass draw(const std::vector<Levels>& places, const Truth& truth, Random& random) {
  std::map<Levels, double> p, t, j, pt, pj, tj;
  std::map<std::uint32_t, std::pair<double, double>> error;
  DrawnClass out;
  for (const Levels& l : places) {
    const double e = effect(t, {l[1]}, truth.exam, random) +
                     effect(j, {l[2]}, truth.judge, random) +
                     effect(pt, {l[0], l[1]}, truth.candidate_exam, random) +
                     effect(pj, {l[0], l[2]}, truth.candidate_judge, random) +
                     effect(tj, {l[1], l[2]}, truth.exam_judge, random) +
                     std::sqrt(truth.rest) * random.normal();
    out.marks.push_back({l, 60 + effect(p, {l[0]}, truth.candidate, random) + e});
    error[l[0]].first += e;
    error[l[0]].second += 1;
  }
  for (const auto& [who, sum] : error)
    out.squared_error += std::pow(sum.first / sum.second, 2) / static_cast<double>(error.size());
  return out;
}

inline std::vector<Levels> crossed(std::uint32_t persons, std::uint32_t exams,
                                   std::uint32_t judges) {
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
inline std::vector<Levels> fixed_pairs(Random& random) {
  std::map<std::uint32_t, std::set<std::uint32_t>> mine;
  for (std::uint32_t p = 0; p < 30; ++p)
    while (mine[p].size() < 2) mine[p].insert(static_cast<std::uint32_t>(random.below(6)));
  return kept(crossed(30, 3, 6), [&](const Levels& l) { return mine[l[0]].contains(l[2]); });
}
/// Each work has a pair of 6 judges, drawn anew.
inline std::vector<Levels> drawn_pairs(Random& random) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::set<std::uint32_t>> mine;
  for (std::uint32_t p = 0; p < 30; ++p)
    for (std::uint32_t t = 0; t < 3; ++t)
      while (mine[{p, t}].size() < 2)
        mine[{p, t}].insert(static_cast<std::uint32_t>(random.below(6)));
  return kept(crossed(30, 3, 6), [&](const Levels& l) {
    return mine[{l[0], l[1]}].contains(l[2]);
  });
}
inline std::vector<Levels> a_quarter_missing(Random& random) {
  return kept(crossed(30, 3, 4), [&](const Levels&) { return random.below(4) > 0; });
}
/// 8 of 40 candidates sat all four exams, the others two.
inline std::vector<Levels> few_sat_all(Random& random) {
  std::map<std::uint32_t, std::set<std::uint32_t>> mine;
  for (std::uint32_t p = 0; p < 40; ++p)
    while (mine[p].size() < (p < 8 ? 4U : 2U))
      mine[p].insert(static_cast<std::uint32_t>(random.below(4)));
  return kept(crossed(40, 4, 2), [&](const Levels& l) { return mine[l[0]].contains(l[1]); });
}

}  // namespace cavum::cohort::drawn
