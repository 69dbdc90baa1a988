// The search for causes: what each mechanism would gain beside the causes known so far, judged
// against what the same search finds in surrogates, in which nothing is hidden.
#pragma once

#include <cstdint>

#include "engine/lab/explain/inference/structure.h"
#include "engine/lab/explain/inference/surrogates.h"
#include "engine/lab/explain/model/term_fits.h"

namespace cavum::explain {

/// Chance of a false cause in a clean recording, for each step of the search.
inline constexpr double k_alpha = 0.01;

/// Best of one mechanism: fall of chi² beside base and causes, less the penalty for parameters
/// beyond the first.
struct Candidate {
  Hypothesis hypothesis;
  double gain = -1e300;
  double raw_gain = 0;  ///< without the penalty
  bool testable =
      true;  ///< keeps at least 5 % of its norm beside k and c at some point of its grid
  [[nodiscard]] bool fits() const {
    return gain > -1e299;
  }  ///< somewhere, with coefficients that make sense
};

/// What one look finds: a candidate for each of mechanisms(), and the structures.
struct Scores {
  std::vector<Candidate> candidates;
  std::vector<Structure> structures;
};

[[nodiscard]] std::vector<Candidate> candidates_of(const View& view, int left_out = -1);
[[nodiscard]] Scores scores_of(const View& view);
/// Gain of the best two mechanisms together, grid only.
[[nodiscard]] double best_pair_gain(const View& view, const std::vector<Candidate>& candidates);

/// What is judged: mechanisms() in order, then the variables of View::curves.
struct Entries {
  std::vector<std::string> variables;
  [[nodiscard]] std::size_t count() const;
  [[nodiscard]] std::size_t of_variable(
      const std::string& name) const;  ///< count() when there is none of that name
};
[[nodiscard]] Entries entries_of(const View& view);

/// To first order, fall of -2 log likelihood by each entry beside base and causes, in each of the
/// observed recordings; shape [entries, recordings]. `sums`: those that `observed` belongs to.
[[nodiscard]] Eigen::MatrixXd score_gains(const View& view, const std::vector<SpreadSums>& sums,
                                          const Observed& observed);

/// What surrogates of one view gain.
struct Null {
  Eigen::VectorXd mean, scatter;  ///< of the gains, by entry
  std::vector<double> largest_z;  ///< of each surrogate, ascending
  Eigen::MatrixXd moved;  ///< of k, c and the causes' parameters (as FitResult has them), by the
                          ///< surrogates' noise; [parameters, surrogates]
};
[[nodiscard]] Null null_of(const View& view, const Surrogates& surrogates, std::size_t count);

/// The data against their surrogates.
struct Judgement {
  std::vector<double> z;        ///< (gain − mean of surrogates) / scatter, by entry
  std::vector<double> p_value;  ///< share of surrogates, the recording among them, whose largest z
                                ///< is as large: never below 1/(surrogates + 1)
  double inflation = 1.0;  ///< what surrogates gain on average, over what independent noise would
};
/// `left_out`: a fold that is not looked at; -1 = none. Without any surrogates: the chance that
/// independent noise gains as much in one of all trials.
[[nodiscard]] Judgement judge(const View& view, const Null& null, int left_out = -1);

/// Shapes of `causes` that fit best, starting where they are; coordinate search on each fitted
/// shape within its range.
[[nodiscard]] std::vector<Term> refine(TermFits& fits, std::vector<Term> causes, int cycles,
                                       std::size_t first = 0);
/// A candidate of the grid, beside `others`, as a term to start refining from (its scale turned
/// into a shape).
[[nodiscard]] Term start_of(TermFits& fits, const std::vector<Term>& others,
                            const Candidate& candidate);
/// chi² with `causes`, plus the penalty of all their parameters.
[[nodiscard]] double penalised_chi2(TermFits& fits, const std::vector<Term>& causes);
[[nodiscard]] Eigen::Index parameters_of(const Term& term, const Scene& scene);

}  // namespace cavum::explain
