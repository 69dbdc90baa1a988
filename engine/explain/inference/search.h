// The search for causes: what each mechanism would gain beside the causes known so far, judged against what the same
// search finds in twins without it.
#pragma once

#include <cstdint>
#include <functional>

#include "engine/explain/inference/structure.h"
#include "engine/explain/model/view.h"

namespace cavum::explain {

/// Chance of a false cause in a clean recording, for each step of the search.
inline constexpr double k_alpha = 0.01;

/// Best of one mechanism: fall of chi² beside base and causes, less the penalty for parameters beyond the first.
struct Candidate {
  Hypothesis hypothesis;
  double gain = -1e300;
  double raw_gain = 0;   ///< without the penalty
  bool testable = true;  ///< keeps at least 5 % of its norm beside k and c at some point of its grid
};

/// What one look finds: a candidate for each of mechanisms(), and the structures.
struct Scores {
  std::vector<Candidate> candidates;
  std::vector<Structure> structures;
  double blur = 0;  ///< 0..1: share of the rows' weight that a coarse position costs
};

[[nodiscard]] std::vector<Candidate> candidates_of(const View& view, int left_out = -1);
[[nodiscard]] Scores scores_of(const View& view);
/// Gain of the best two mechanisms together, grid only.
[[nodiscard]] double best_pair_gain(const View& view, const std::vector<Candidate>& candidates);

/// Twins of one view, each scored as the data were.
struct Null {
  std::vector<Scores> twins;
  std::vector<Eigen::VectorXd> values;  ///< of the causes with tangents, one for each twin
};

/// Adds twins up to `count`. `done(i)` is called as they finish, from any thread.
void add_twins(Null& null, const View& view, std::size_t count, std::uint64_t seed, const Series* fixed_n, const std::function<void()>& done);

/// The data against their twins. An entry is a mechanism (0 … mechanisms) or a structure (after them).
struct Judgement {
  std::vector<double> z;        ///< (gain − mean of twins) / scatter, by entry
  std::vector<double> p_value;  ///< chance that the largest z of a twin exceeds it (Gumbel fit to the twins' largest)
  double inflation = 1.0;       ///< what twins gain on average, over what noise alone would
};
/// Without any twins: the chance that independent noise gains as much in one of all trials.
[[nodiscard]] Judgement judge(const Scores& data, const Null& null);

/// Shapes of `causes` that fit best, starting where they are; coordinate search on each fitted shape within its range.
[[nodiscard]] std::vector<Term> refine(const View& view, std::vector<Term> causes, int cycles, std::size_t first = 0);
/// A candidate of the grid as a term to start refining from (its scale turned into a shape).
[[nodiscard]] Term start_of(const View& view, const Candidate& candidate);
/// chi² with `causes`, plus the penalty of all their parameters.
[[nodiscard]] double penalised_chi2(const View& view, const std::vector<Term>& causes);
[[nodiscard]] Eigen::Index parameters_of(const Term& term, const Scene& scene);

}  // namespace cavum::explain
