#include "grading/cohort/circuit_study.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "engine/base/error.h"
#include "engine/base/text.h"

namespace cavum::cohort {
namespace {

/// Effects as people read them: the catalogue takes them from here.
[[maybe_unused]] constexpr std::array k_effect_words{noop("candidate"),
                                                     noop("exam"),
                                                     noop("judge"),
                                                     noop("judge:exam"),
                                                     noop("candidate x exam"),
                                                     noop("candidate x judge"),
                                                     noop("candidate x judge:exam"),
                                                     noop("exam x judge"),
                                                     noop("candidate x exam x judge")};

constexpr int k_range_draws = 1000;
constexpr std::uint64_t k_range_seed = 1;  // the same marks give the same ranges

std::vector<double> values_of(const std::vector<StudyMark>& marks) {
  std::vector<double> values;
  for (const auto& m : marks) values.push_back(m.value);
  return values;
}

/// Each candidate counts once.
double mean_of_candidates(const std::vector<StudyMark>& marks) {
  std::map<std::uint32_t, std::pair<double, double>> of_candidate;
  for (const auto& m : marks)
    of_candidate[m.level[0]].first += m.value, of_candidate[m.level[0]].second += 1;
  double sum = 0;
  for (const auto& [p, of] : of_candidate) sum += of.first / of.second;
  return sum / static_cast<double>(of_candidate.size());
}

/// How many different second things stand with a first one, at most.
std::size_t most_partners(const std::vector<StudyMark>& marks, std::size_t first,
                          std::size_t second) {
  std::map<std::uint32_t, std::set<std::uint32_t>> partners;
  std::size_t most = 0;
  for (const auto& m : marks) {
    auto& mine = partners[m.level[first]];
    mine.insert(m.level[second]);
    most = std::max(most, mine.size());
  }
  return most;
}

/// The fewest exams from which on `phi` (of 1, 2, ... exams) is enough.
template <class Phi>
std::optional<int> fewest(const Phi& phi) {
  for (int n = 1; n <= k_max_tasks; ++n)
    if (phi(static_cast<std::size_t>(n - 1)) >= k_enough_phi) return n;
  return {};
}

}  // namespace

CircuitStudy study_circuit(StudyDesign design, const std::vector<StudyMark>& marks,
                           std::optional<double> cut) {
  const VarianceStudy study(std::move(design), marks);
  CircuitStudy s;
  s.design = study.design();
  s.merged = study.merged();
  s.marking = study.marking();
  s.components = study.estimate(values_of(marks));
  require_differences(s.design, s.components);
  std::vector<MarkShares> circuits{s.marking.as_given()};
  for (int n = 1; n <= k_max_tasks; ++n) circuits.push_back(s.marking.with_tasks(n));
  StudyRanges ranges = study_ranges(study, s.components, circuits, k_range_draws, k_range_seed);
  s.range = ranges.circuits[0];
  s.error = std::move(ranges.error);
  for (const auto& shares : circuits)
    s.by_tasks.push_back(dependability(s.design, s.components, shares, s.marking.persons()));
  s.as_sat = s.by_tasks.front();
  s.by_tasks.erase(s.by_tasks.begin());
  s.mean = mean_of_candidates(marks);
  if (cut) s.at_cut = cut_decision(s.as_sat, s.mean, *cut);
  s.for_enough = {fewest([&](std::size_t i) { return s.by_tasks[i].phi; }),
                  fewest([&](std::size_t i) { return ranges.circuits[i + 1].phi_high; }),
                  fewest([&](std::size_t i) { return ranges.circuits[i + 1].phi_low; })};
  return s;
}

CircuitStudy study_of_judges(const std::vector<StudyMark>& marks, std::optional<double> cut) {
  if (most_partners(marks, 1, 2) <= 1)
    throw Error(msg("people's marks"),
                msg("are one judge's in each exam: judge and exam cannot be told apart"),
                msg("have each exam marked by two judges at least"));
  const bool nested = most_partners(marks, 2, 1) <= 1;
  return study_circuit(nested ? nested_design("candidate", "exam", "judge")
                              : crossed_design({"candidate", "exam", "judge"}),
                       marks, cut);
}

}  // namespace cavum::cohort
