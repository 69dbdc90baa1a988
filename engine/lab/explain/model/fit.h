// Least squares of the base and any set of mechanisms together, on sums of products kept session by
// session: then a search over hundreds of hypotheses, and leaving a session out, cost only small
// matrices. What differs from session to session is integrated out (session_effects.h), by each of
// a few spreads; the likeliest of them counts, so that a cause may explain it.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "engine/lab/explain/model/mechanism.h"
#include "engine/lab/explain/model/session_effects.h"

namespace cavum::explain {

/// A mechanism with its shape fixed.
struct Term {
  int mechanism = -1;  ///< in mechanisms()
  std::vector<double> shape;
};
[[nodiscard]] inline const Mechanism& mechanism_of(const Term& term) {
  return mechanism_at(term.mechanism);
}

/// A term whose columns are in the products.
struct Hypothesis {
  Term term;
  Eigen::Index first = 0;    ///< its own columns
  Eigen::Index own = 0;      ///< how many
  Eigen::Index repeats = 1;  ///< folds (Products::folds) that have coefficients of their own for
                             ///< these columns; 1 = all share them
  Eigen::Index spring = -1, damper = -1;  ///< changes of the columns of k and c; -1 = none
  /// These changes times this: between nothing (0) and the point of the grid (1) the search
  /// interpolates.
  double scale = 1.0;
  /// Derivatives by its fitted shape parameters: columns [tangents, tangents + tangent_count);
  /// empty for hypotheses of the grid.
  Eigen::Index tangents = 0, tangent_count = 0;
  [[nodiscard]] Eigen::Index coefficients() const { return own * repeats; }
  [[nodiscard]] Eigen::Index parameters()
      const;  ///< linear ones and fitted shapes; a phase for each session beside one amplitude
};

/// A session's products with its effects.
struct SessionProducts {
  Eigen::Index begin = 0, end = 0;       ///< rows
  std::size_t fold = 0;                  ///< that they belong to
  Eigen::MatrixXd with_effects;          ///< [columns, effects]
  Eigen::MatrixXd effects;               ///< [effects, effects]
  std::vector<Eigen::MatrixXd> inverse;  ///< shrunk_inverse under each spread, [effects, effects]
  std::vector<double> log_det;           ///< what each spread costs
};

/// Sums of products of whitened columns with the effects integrated out under one spread.
struct SpreadSums {
  Eigen::MatrixXd all;
  double log_det = 0;  ///< what the spread costs
};

/// What column 0 lacks of the force: k and c times their columns, `spring` and `damper` among them,
/// and the causes' own. A force is far above its noise, and single precision would lose the noise
/// in it.
struct Taken {
  double k_n_per_mm = 0, c_n_s_per_mm = 0;
  std::vector<Eigen::Index> spring, damper;          ///< changes of the columns of k and c
  std::vector<std::pair<Eigen::Index, double>> own;  ///< columns with their coefficients
};

/// Products of whitened columns: 0 the force (less what is taken), 1 the column of k, 2 that of c,
/// then the hypotheses'. Give folds, sessions (rows, fold and products) and `tried`; `integrate`
/// makes the rest.
struct Products {
  std::vector<Eigen::MatrixXd>
      folds;  ///< of the columns with one another, by fold, [columns, columns]
  std::vector<SessionProducts> sessions;
  std::vector<SessionSpread>
      tried;  ///< as narrower_spreads has them: the first as found, the last without any
  std::vector<SpreadSums> spreads;  ///< of all folds, under each
  Taken taken;
  double force_squares = 0;  ///< of the whole whitened force
  double rows = 0;           ///< sum of weights, so that chi² of a good model is about this
  /// Information that rig.toml gives: 1/sd² and the value, of k and c.
  double prior[2] = {0, 0}, prior_at[2] = {0, 0};
};

/// Information that rig.toml gives on k and c.
void set_prior(Products& products, const Rig& rig);
/// Makes the inverses of sessions and the sums under each spread.
void integrate(Products& products);
/// Sums of all folds but `left_out` (-1 = all), under each spread.
[[nodiscard]] std::vector<SpreadSums> sums_without(const Products& products, int left_out);

struct FitResult {
  double chi2 = 0;        ///< with the cost of the spread; the least of all spreads
  Eigen::VectorXd value;  ///< k, c, then own coefficients of each hypothesis in turn, then tangents
                          ///< of each in turn
  Eigen::MatrixXd covariance;  ///< of value, in units in which the noise is 1; only when asked for
  bool solved = false;
};

/// All folds but `left_out` (-1 = all).
[[nodiscard]] FitResult fit(const Products& products, const std::vector<const Hypothesis*>& model,
                            int left_out = -1, bool covariance = false);
/// The same; `sums` are those of all folds but `left_out`.
[[nodiscard]] FitResult fit(const std::vector<SpreadSums>& sums, const Products& products,
                            const std::vector<const Hypothesis*>& model, int left_out = -1,
                            bool covariance = false);

}  // namespace cavum::explain
