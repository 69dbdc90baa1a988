// Where the differences between marks come from: generalisability theory. How much is of the
// candidates, how much of tasks and raters and of what they do together; how dependable a circuit
// of so many tasks and raters would be, and how surely it tells pass from fail. Cronbach, Gleser,
// Nanda and Rajaratnam, The Dependability of Behavioral Measurements, 1972; Brennan,
// Generalizability Theory, Springer 2001. It explains; it changes no mark.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/named_enum.h"
#include "grading/cohort/mark_shares.h"

namespace cavum::cohort {

// Why marks tell nothing of how dependable they are.
#define CAVUM_STUDY_ERRORS(ERROR) ERROR(all_alike) ERROR(conditions_alone) ERROR(effects_not_apart)
CAVUM_NAMED_ENUM(StudyError, CAVUM_STUDY_ERRORS)

/// Everybody under every condition: each set of facets is an effect. One to four facets beside the
/// persons, else Error.
[[nodiscard]] StudyDesign crossed_design(std::vector<std::string> facets);
/// persons x (inner : outer): each inner condition (a rater) belongs to one outer one (a task).
[[nodiscard]] StudyDesign nested_design(const std::string& persons, const std::string& outer,
                                        const std::string& inner);

/// Estimated variances, in the square of the marks' unit, by effect; below 0 where chance has it so
/// (0 is meant).
struct VarianceComponents {
  std::vector<double> variance;
  double mean = 0.0;
};

/// The part of a study that does not depend on the marks' values: computed once.
class VarianceStudy {
 public:
  /// Where two effects of error part the marks in the same way (each rater saw each candidate once:
  /// candidate x rater and the residual), the smaller one leaves the design and stands in the
  /// larger. Throws Error when two marks share all levels, a mark has another number of levels than
  /// the design has facets, or the marks cannot tell effects apart otherwise (a single task, each
  /// rater with a candidate of his own), and names them.
  VarianceStudy(StudyDesign design, std::span<const StudyMark> marks);
  [[nodiscard]] const StudyDesign& design() const noexcept { return design_; }
  [[nodiscard]] const Marking& marking() const noexcept { return marking_; }
  /// Effects that left the design, and in which one each stands.
  [[nodiscard]] const std::vector<std::pair<std::string, std::string>>& merged() const noexcept {
    return merged_;
  }
  [[nodiscard]] std::size_t marks() const noexcept { return marks_; }
  /// Henderson's first method (Biometrics 9 (1953) 226; Brennan's analogous ANOVA): sums of squares
  /// are set equal to what they are expected to be. Balanced: the components of the analysis of
  /// variance. `values`: one for each mark, in their order. What rounding leaves is 0.
  [[nodiscard]] VarianceComponents estimate(std::span<const double> values) const;
  /// What is left of each effect's sum of squares when those of the effects within it are taken
  /// off: balanced, that of the analysis of variance.
  [[nodiscard]] std::vector<double> squares(std::span<const double> values) const;
  /// What they are expected to be under these variances, and the variances that give such squares.
  [[nodiscard]] std::vector<double> expected_squares(std::span<const double> variance) const;
  [[nodiscard]] std::vector<double> variances_of(std::span<const double> squares) const;
  /// Values drawn from normal distributions of these variances, on this study's conditions.
  [[nodiscard]] std::vector<double> draw(const VarianceComponents& from, std::uint64_t seed) const;

 private:
  void merge(std::span<const StudyMark> marks);
  [[nodiscard]] std::vector<double> own_squares(std::vector<double> sums) const;

  StudyDesign design_;
  std::size_t marks_;
  std::vector<std::pair<std::string, std::string>> merged_;
  std::vector<std::vector<std::uint32_t>> group_;  // by effect, of each mark
  std::vector<std::vector<double>> size_;          // by effect, of each group: how many marks
  Eigen::MatrixXd expected_;                       // of `squares`, by effect and variance
  Eigen::MatrixXd of_squares_;                     // its inverse
  Marking marking_;
};

/// How many conditions of each facet beside the persons a circuit would have, the same for all
/// candidates; a fixed facet is the same in every circuit, no sample of many.
struct CircuitPlan {
  std::vector<double>
      conditions;  ///< of facet 1, 2, ...; an inner facet's: in each outer condition. At least 1
  std::vector<bool> fixed = {};  ///< empty: none
};

/// Of a candidate's mean over such a circuit.
struct Dependability {
  double universe = 0.0;  ///< variance of what candidates would have over all circuits
  double relative = 0.0;  ///< error variance of their order
  double absolute = 0.0;  ///< error variance of their mark
  double of_the_mean =
      0.0;           ///< error variance of the class's mean, for as many persons as were studied
  double g = 0.0;    ///< generalisability coefficient: universe / (universe + relative)
  double phi = 0.0;  ///< dependability: universe / (universe + absolute)
  double relative_sem = 0.0,
         absolute_sem = 0.0;  ///< standard errors of measurement, in the marks' unit
};
/// Components below 0 count as 0. Throws Error when the plan has another number of facets, or fewer
/// than one condition.
[[nodiscard]] Dependability dependability(const StudyDesign& design,
                                          const VarianceComponents& components,
                                          const CircuitPlan& plan, double persons);
/// The same of candidates whose marks are so made; no facet is fixed.
[[nodiscard]] Dependability dependability(const StudyDesign& design,
                                          const VarianceComponents& components,
                                          const MarkShares& shares, double persons);

/// Throws Error where no component with the persons in it is above 0: g is then 0 by 0, and there
/// is nothing to study.
void require_differences(const StudyDesign& design, const VarianceComponents& components);

/// How surely one circuit tells who is above `cut` (unit of the marks), for normal marks.
struct CutDecision {
  /// Dependability of a distance from the cut: Brennan and Kane, J. Educational Measurement 14
  /// (1977) 277. Never below phi: the square of the distance between mean and cut, estimated less
  /// the mean's error variance, counts as 0 where that is below 0.
  double phi_at_cut = 0.0;
  double consistency = 0.0;  ///< share of candidates whom two such circuits would pass or fail
                             ///< alike: Peng and Subkoviak, same journal 17 (1980) 359
  double accuracy = 0.0;     ///< share whom it passes or fails as endless circuits would
};
[[nodiscard]] CutDecision cut_decision(const Dependability& d, double mean, double cut);

/// Generalised confidence bounds of 95 % (Weerahandi, J. American Statistical Association 88 (1993)
/// 899): each sum of squares is divided by how it scatters over studies drawn from the estimate,
/// beside what is expected of it; g and phi of the variances that such sums stand for. Balanced,
/// that is a chi square for each; of candidates by tasks g's bounds are Feldt's (Psychometrika 30
/// (1965) 357). The estimate lies within; as phi never exceeds g, neither do its bounds.
struct DependabilityRange {
  double g_low = 0.0, g_high = 0.0, phi_low = 0.0, phi_high = 0.0;
};
struct StudyRanges {
  std::vector<DependabilityRange> circuits;  ///< in their order
  std::vector<double> error;                 ///< standard error of each variance component
};
/// `circuits`: how a candidate's mark is made in each of the circuits that are asked about.
[[nodiscard]] StudyRanges study_ranges(const VarianceStudy& study,
                                       const VarianceComponents& estimate,
                                       std::span<const MarkShares> circuits, int draws,
                                       std::uint64_t seed);

}  // namespace cavum::cohort
