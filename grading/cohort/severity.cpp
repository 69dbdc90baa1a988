#include "grading/cohort/severity.h"

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "engine/statistics/statistics.h"
#include "grading/cohort/square_matrix.h"

namespace cavum::cohort {
namespace {

/// The deviate that `n` normal ones all stay within, in 95 of 100 cases, by Bonferroni.
double critical_of(std::size_t n) {
  const double tail = 0.05 / (2 * static_cast<double>(std::max<std::size_t>(1, n)));
  double low = 0, high = 10;
  for (int i = 0; i < 60; ++i) {
    const double z = 0.5 * (low + high);
    (1 - normal_cdf(z) > tail ? low : high) = z;
  }
  return high;
}

/// Columns of the model: one for each condition of each facet beside the persons.
struct Columns {
  std::vector<std::size_t> first;  // of facet 1, 2, ...; then how many there are
  explicit Columns(std::span<const StudyMark> marks) {
    const std::size_t facets = marks[0].level.size();
    std::size_t at = 0;
    for (std::size_t f = 1; f < facets; ++f) {
      first.push_back(at);
      std::uint32_t most = 0;
      for (const StudyMark& m : marks) most = std::max(most, m.level[f]);
      at += most + 1;
    }
    first.push_back(at);
  }
  [[nodiscard]] std::size_t count() const { return first.back(); }
  [[nodiscard]] std::size_t of(const StudyMark& m, std::size_t facet) const { return first[facet - 1] + m.level[facet]; }
};

}  // namespace

SeverityStudy study_severity(std::span<const StudyMark> marks) {
  if (marks.empty()) throw Error("no marks", "to compare stations and raters by", "");
  const Columns columns(marks);
  const std::size_t facets = marks[0].level.size(), n = columns.count();
  std::size_t persons = 0;
  for (const StudyMark& m : marks) persons = std::max<std::size_t>(persons, m.level[0] + 1);

  // Each candidate's mean is taken off: what is left tells of conditions alone.
  std::vector<std::vector<double>> shares(persons, std::vector<double>(n));
  std::vector<double> sum(persons), count(persons);
  for (const StudyMark& m : marks) {
    sum[m.level[0]] += m.value;
    count[m.level[0]] += 1;
    for (std::size_t f = 1; f < facets; ++f) shares[m.level[0]][columns.of(m, f)] += 1;
  }
  SquareMatrix normal(n, std::vector<double>(n));
  std::vector<double> right(n), marks_of(n);
  for (const StudyMark& m : marks)
    for (std::size_t f = 1; f < facets; ++f) {
      const std::size_t i = columns.of(m, f);
      marks_of[i] += 1;
      right[i] += m.value;
      for (std::size_t g = 1; g < facets; ++g) normal[i][columns.of(m, g)] += 1;
    }
  for (std::size_t p = 0; p < persons; ++p) {
    if (!(count[p] > 0)) continue;
    for (std::size_t i = 0; i < n; ++i) {
      right[i] -= shares[p][i] * sum[p] / count[p];
      for (std::size_t k = 0; k < n; ++k) normal[i][k] -= shares[p][i] * shares[p][k] / count[p];
    }
  }
  // The conditions of a facet add up to nothing.
  for (std::size_t f = 0; f + 1 < columns.first.size(); ++f)
    for (std::size_t i = columns.first[f]; i < columns.first[f + 1]; ++i)
      for (std::size_t k = columns.first[f]; k < columns.first[f + 1]; ++k) normal[i][k] += 1;
  const auto inverse = inverted(std::move(normal));
  if (!inverse)
    throw Error("these marks", "do not compare all stations and raters: some share no candidates with the others, or stand for one exam alone",
                "let candidates of one exam sit at several stations, and be marked by several people");
  std::vector<double> effect(n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < n; ++k) effect[i] += (*inverse)[i][k] * right[k];

  SeverityStudy study;
  study.persons.resize(persons);
  for (const StudyMark& m : marks) {
    double own = m.value;
    for (std::size_t f = 1; f < facets; ++f) own -= effect[columns.of(m, f)];
    study.persons[m.level[0]].raw += m.value / count[m.level[0]];
    study.persons[m.level[0]].adjusted += own / count[m.level[0]];
  }
  double squares = 0, largest = 0;
  for (const StudyMark& m : marks) {
    largest = std::max(largest, std::fabs(m.value));
    double rest = m.value - study.persons[m.level[0]].adjusted;
    for (std::size_t f = 1; f < facets; ++f) rest -= effect[columns.of(m, f)];
    squares += rest * rest;
  }
  const double free = static_cast<double>(marks.size()) - static_cast<double>(persons) - static_cast<double>(n - (facets - 1));
  if (!(free >= 1))
    throw Error("these marks", "are too few to tell severity from chance", "let candidates go to more stations, or be marked by more raters");
  study.residual_sd = std::sqrt(squares / free);
  for (std::size_t f = 0; f + 1 < columns.first.size(); ++f) {
    const std::size_t levels = columns.first[f + 1] - columns.first[f];
    const double critical = critical_of(levels), rounding = 1e-9 * largest;
    std::vector<Severity> of_facet;
    for (std::size_t i = columns.first[f]; i < columns.first[f + 1]; ++i) {
      // The constraint added 1 to each pair of the facet, which the inverse gives back as 1/levels² in each place: no part of the error.
      const double own = std::max(0.0, (*inverse)[i][i] - 1.0 / static_cast<double>(levels * levels));
      const double error = study.residual_sd * std::sqrt(own);
      of_facet.push_back(
          {static_cast<std::size_t>(marks_of[i]), -effect[i], error, levels > 1 && std::fabs(effect[i]) > std::max(critical * error, rounding)});
    }
    study.facets.push_back(std::move(of_facet));
  }
  return study;
}

}  // namespace cavum::cohort
