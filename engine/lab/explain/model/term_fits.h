// Fits of the base and any causes on all rows, for refining shapes. The whitened columns of the
// terms seen last are kept, so that a search that moves one shape pays for that term alone.
#pragma once

#include <list>
#include <map>

#include "engine/lab/explain/model/view.h"

namespace cavum::explain {

/// Not for several threads. `view` must outlive it.
class TermFits {
 public:
  explicit TermFits(const View& view);
  /// Least squares with the weights, the noise and the contact of the view. Value: k, c, then own
  /// coefficients of each cause in turn.
  [[nodiscard]] FitResult fit(const std::vector<Term>& causes, bool covariance = false);
  [[nodiscard]] const View& view() const { return view_; }

 private:
  /// Whitened columns that go together, and their products with one another and with the effects.
  struct Block {
    Term term;  ///< of mechanism -1: force, k and c
    Eigen::Index own = 0, repeats = 1;
    Eigen::Index spring = -1, damper = -1;      ///< among its columns
    Eigen::MatrixXd white;                      ///< [rows, columns]
    std::vector<Eigen::MatrixXd> with_effects;  ///< by session, [columns, effects]
    std::map<const Block*, std::vector<Eigen::MatrixXd>>
        with_block;  ///< by session, [columns, the other's columns]
  };

  void add(Block& block, Series column);
  Block made(const Term& term);
  Block* block_of(const Term& term);
  const std::vector<Eigen::MatrixXd>& products(Block& a, Block& b);

  const View& view_;
  Whitening white_;
  std::list<Block> blocks_;  ///< the first: force, k, c; then those of terms, used last first
  Products sums_;            ///< what every fit has in common: sessions, spreads, prior
};

}  // namespace cavum::explain
