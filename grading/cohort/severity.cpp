#include "grading/cohort/severity.h"

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "grading/cohort/interactions.h"
#include "grading/cohort/square_matrix.h"

namespace cavum::cohort {
namespace {

/// What `n` normal deviates, divided by a standard error of so much freedom, all stay within in 95
/// of 100 cases: Student's t and Bonferroni.
double critical_of(std::size_t n, double freedom) {
  // t = √freedom·tan(angle), and the density of the angle is cos^(freedom − 1).
  constexpr int k_steps = 2000;
  constexpr double k_quarter_turn = 1.57079632679489662;
  const double tail = 0.05 / (2 * static_cast<double>(std::max<std::size_t>(1, n))),
               f = std::clamp(freedom, 1.0, 1000.0);
  std::vector<double> below{0.0};
  for (int i = 0; i < k_steps; ++i)
    below.push_back(below.back() + std::pow(std::cos(k_quarter_turn * (i + 0.5) / k_steps), f - 1));
  const double wanted = (1 - 2 * tail) * below.back();
  const auto next = std::lower_bound(below.begin() + 1, below.end() - 1, wanted);
  const double at =
      static_cast<double>(next - below.begin()) - (*next - wanted) / (*next - *(next - 1));
  return std::sqrt(f) * std::tan(k_quarter_turn * at / k_steps);
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
  [[nodiscard]] std::size_t of(const StudyMark& m, std::size_t facet) const {
    return first[facet - 1] + m.level[facet];
  }
};

/// Mark = candidate + a condition of each facet, by least squares; the conditions of a facet add up
/// to nothing.
class Model {
 public:
  explicit Model(std::span<const StudyMark> marks) : marks_(marks), columns_(marks) {
    const std::size_t n = columns_.count();
    for (const StudyMark& m : marks) {
      if (m.level[0] >= count_.size()) count_.resize(m.level[0] + 1);
      count_[m.level[0]] += 1;
    }
    shares_ = Eigen::MatrixXd::Zero(count_.size(), n);
    marks_of_.resize(n);
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n, n);
    for (const StudyMark& m : marks)
      for (std::size_t f = 1; f < m.level.size(); ++f) {
        const std::size_t i = columns_.of(m, f);
        shares_(m.level[0], i) += 1 / count_[m.level[0]];
        marks_of_[i] += 1;
        for (std::size_t g = 1; g < m.level.size(); ++g) normal(i, columns_.of(m, g)) += 1;
      }
    // Each candidate's mean is taken off: what is left tells of conditions alone.
    normal -= shares_.transpose() *
              Eigen::Map<const Eigen::VectorXd>(count_.data(), shares_.rows()).asDiagonal() *
              shares_;
    for (std::size_t f = 0; f + 1 < columns_.first.size(); ++f) {
      const auto from = columns_.first[f], size = columns_.first[f + 1] - from;
      normal.block(from, from, size, size).array() += 1;
    }
    auto inverse = ScaledRows(normal).inverse();
    if (!inverse)
      throw Error(
          msg("these marks"),
          msg("do not compare all stations and raters: some share no candidates with the others, or stand for one exam alone"),
          msg("let candidates of one exam sit at several stations, and be marked by several people"));
    inverse_ = std::move(*inverse);
  }
  [[nodiscard]] const Columns& columns() const noexcept { return columns_; }
  [[nodiscard]] std::size_t persons() const noexcept { return count_.size(); }
  [[nodiscard]] double marks_of_person(std::size_t p) const { return count_[p]; }
  [[nodiscard]] double marks_of(std::size_t column) const { return marks_of_[column]; }
  [[nodiscard]] Eigen::VectorXd effects(std::span<const double> values) const {
    const std::vector<double> means = means_of(values);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(inverse_.cols());
    for (std::size_t m = 0; m < marks_.size(); ++m)
      for (std::size_t f = 1; f < marks_[m].level.size(); ++f)
        right[columns_.of(marks_[m], f)] += values[m] - means[marks_[m].level[0]];
    return inverse_ * right;
  }
  [[nodiscard]] std::vector<double> residuals(std::span<const double> values) const {
    const Eigen::VectorXd effect = effects(values);
    std::vector<double> left(values.begin(), values.end());
    for (std::size_t m = 0; m < left.size(); ++m)
      for (std::size_t f = 1; f < marks_[m].level.size(); ++f)
        left[m] -= effect[columns_.of(marks_[m], f)];
    const std::vector<double> means = means_of(left);
    for (std::size_t m = 0; m < left.size(); ++m) left[m] -= means[marks_[m].level[0]];
    return left;
  }
  /// What each mark adds to the effect of a column.
  [[nodiscard]] std::vector<double> weights(std::size_t column) const {
    const Eigen::VectorXd row = inverse_.row(column), of_person = shares_ * row;
    std::vector<double> weights(marks_.size());
    for (std::size_t m = 0; m < marks_.size(); ++m) {
      weights[m] = -of_person[marks_[m].level[0]];
      for (std::size_t f = 1; f < marks_[m].level.size(); ++f)
        weights[m] += row[columns_.of(marks_[m], f)];
    }
    return weights;
  }

 private:
  [[nodiscard]] std::vector<double> means_of(std::span<const double> values) const {
    std::vector<double> mean(count_.size());
    for (std::size_t m = 0; m < marks_.size(); ++m)
      mean[marks_[m].level[0]] += values[m] / count_[marks_[m].level[0]];
    return mean;
  }

  std::span<const StudyMark> marks_;
  Columns columns_;
  std::vector<double> count_, marks_of_;  // marks of a person, of a column
  Eigen::MatrixXd shares_, inverse_;      // shares: of a person's marks in each column
};

}  // namespace

SeverityStudy study_severity(std::span<const StudyMark> marks) {
  if (marks.empty()) throw Error(msg("no marks"), msg("to compare stations and raters by"), {});
  const Model model(marks);
  const Columns& columns = model.columns();
  const std::size_t facets = marks[0].level.size();
  std::vector<double> values;
  for (const StudyMark& m : marks) values.push_back(m.value);
  const Eigen::VectorXd effect = model.effects(values);
  const std::vector<double> left = model.residuals(values);

  SeverityStudy study;
  study.persons.resize(model.persons());
  double squares = 0, largest = 0;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const StudyMark& m = marks[i];
    double own = m.value;
    for (std::size_t f = 1; f < facets; ++f) own -= effect[columns.of(m, f)];
    study.persons[m.level[0]].raw += m.value / model.marks_of_person(m.level[0]);
    study.persons[m.level[0]].adjusted += own / model.marks_of_person(m.level[0]);
    squares += left[i] * left[i];
    largest = std::max(largest, std::fabs(m.value));
  }
  const double free = static_cast<double>(marks.size()) - static_cast<double>(model.persons()) -
                      static_cast<double>(columns.count() - (facets - 1));
  if (!(free >= 1))
    throw Error(msg("these marks"), msg("are too few to tell severity from chance"),
                msg("let candidates go to more stations, or be marked by more raters"));
  study.residual_sd = std::sqrt(squares / free);
  const Interactions interactions = estimate_interactions(
      marks, free, [&](std::span<const double> v) { return model.residuals(v); });
  for (std::size_t f = 1; f < facets; ++f) {
    const std::size_t first = columns.first[f - 1], levels = columns.first[f] - first;
    const double rounding = 1e-9 * largest;
    SeverityOfFacet facet;
    for (const std::uint32_t pair : interactions.untold)
      if ((pair >> f & 1U) != 0 && levels > 1)
        facet.indistinguishable_from.push_back(pair & ~(1U << f));
    for (std::size_t i = first; i < columns.first[f]; ++i) {
      const ErrorOfSum of = error_of_sum(interactions, model.weights(i));
      const double error = std::sqrt(of.variance);
      const bool beyond =
          levels > 1 &&
          std::fabs(effect[i]) > std::max(critical_of(levels, of.freedom) * error, rounding);
      facet.conditions.push_back({static_cast<std::size_t>(model.marks_of(i)), -effect[i], error,
                                  beyond && facet.indistinguishable_from.empty()});
    }
    study.facets.push_back(std::move(facet));
  }
  return study;
}

}  // namespace cavum::cohort
