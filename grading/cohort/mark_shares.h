// What a candidate's mark is made of: how much of each effect's variance stands in the mean of the
// marks that he has, and how much of it another candidate's mark has, too. Candidates may have
// unequal numbers of tasks and raters, and raters of their own.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace cavum::cohort {

/// Facets of a study, persons first, and the effects that it tells apart: sets of facets, bit i for
/// facet i. The last one holds all facets: the residual.
struct StudyDesign {
  std::vector<std::string> facets;
  std::vector<std::uint32_t> effects;
  std::vector<std::string> names;  ///< of the effects: "candidate x task", "rater:task"
};

/// One mark: a level of each facet, counted from 0, and its value.
struct StudyMark {
  std::vector<std::uint32_t> level;
  double value = 0.0;
};

/// The group of each mark under an effect (a set of facets, bit i for facet i), numbered from 0 as
/// they come.
[[nodiscard]] std::vector<std::uint32_t> groups_under(std::uint32_t effect,
                                                      std::span<const StudyMark> marks);

/// Shares of variance, by effect, 0 to 1, on average over the candidates.
struct MarkShares {
  std::vector<double> own;  ///< in the variance of a candidate's mark: sum over the effect's groups
                            ///< of (his marks in it / his marks)²
  std::vector<double>
      common;  ///< in the covariance of two candidates' marks; 0 for effects of candidates
};

/// Whose marks a study has.
class Marking {
 public:
  Marking() = default;
  /// Facet 1 is the task. At least one mark.
  Marking(const StudyDesign& design, std::span<const StudyMark> marks);
  /// As they were given.
  [[nodiscard]] const MarkShares& as_given() const noexcept { return as_given_; }
  /// Everybody at the same `n` tasks (1 at least), each of which counts alike; raters by number and
  /// by how often they come back as they were.
  [[nodiscard]] MarkShares with_tasks(double n) const;
  [[nodiscard]] double persons() const noexcept { return persons_; }  ///< who have a mark
  /// Of facet 1, 2, ...: how many different conditions a candidate has, on average; those of a
  /// nested facet in each of his tasks.
  [[nodiscard]] const std::vector<double>& conditions() const noexcept { return conditions_; }
  [[nodiscard]] bool nested(std::size_t facet) const {
    return nested_[facet - 1];
  }  ///< in the task
  [[nodiscard]] double marks_each() const noexcept {
    return marks_each_;
  }  ///< marks of a candidate, on average
  [[nodiscard]] bool even() const noexcept {
    return even_;
  }  ///< all candidates have equally many marks and conditions

 private:
  void count(const StudyDesign& design, std::span<const StudyMark> marks);

  MarkShares as_given_, same_task_, other_task_;  // of two marks from one task, or from two
  std::vector<double> conditions_;
  std::vector<bool> nested_;
  double persons_ = 0, marks_each_ = 0;
  bool even_ = true;
};

}  // namespace cavum::cohort
