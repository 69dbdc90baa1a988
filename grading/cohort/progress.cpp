#include "grading/cohort/progress.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "engine/base/statistics.h"

namespace cavum::cohort {
namespace {
// A little of the 5 % that are promised is left for marks that are not normal.
constexpr double k_told_by_chance = 0.04;
}  // namespace

std::optional<AttemptScatter> attempt_scatter(const std::vector<std::vector<double>>& marks) {
  AttemptScatter s;
  std::vector<double> steps;
  for (const auto& of_one : marks) {
    if (of_one.size() > 1) ++s.candidates;
    for (std::size_t i = 1; i < of_one.size(); ++i) steps.push_back(of_one[i] - of_one[i - 1]);
  }
  s.steps = steps.size();
  if (s.steps < k_min_steps || s.candidates < k_min_repeaters) return std::nullopt;
  s.sd_percent = std::sqrt(variance(steps) / 2);
  const double middle = mean(steps);
  for (const double step : steps)
    s.largest_percent = std::max(s.largest_percent, std::fabs(step - middle));
  return s;
}

std::optional<Progress> progress(std::span<const double> marks, const AttemptScatter& scatter) {
  const auto n = static_cast<double>(marks.size());
  if (marks.size() < 2) return std::nullopt;
  double slope = 0, spread = 0;  // of the line through all attempts; sum of squares of their
                                 // numbers around the middle
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const double t = static_cast<double>(i) - (n - 1) / 2;
    slope += t * marks[i];
    spread += t * t;
  }
  slope /= spread;
  const boost::math::students_t_distribution<double> t(static_cast<double>(scatter.candidates - 1));
  const double chance = k_told_by_chance / (n * (n - 1));
  const double students = boost::math::quantile(boost::math::complement(t, chance / 2));
  // deviation of the line's change, in deviations of one mark; of a step it is the root of two
  const double wide = (n - 1) / std::sqrt(spread);
  return Progress{
      marks.size(), slope * (n - 1),
      wide * std::max(students * scatter.sd_percent, scatter.largest_percent / std::sqrt(2.0))};
}

}  // namespace cavum::cohort
