// Recordings in which nothing is hidden, to learn what a search finds by chance: the noise of the
// recording with its own spectrum and phases drawn anew, session by session; what an uncertain
// position does to the force; and sessions that differ as those of the recording do. The columns
// stay as they are, so that hundreds of surrogates cost little. Source: Theiler et al. 1992,
// Testing for nonlinearity in time series: the method of surrogate data.
#pragma once

#include <cstdint>

#include "engine/base/random.h"
#include "engine/lab/explain/model/view.h"

namespace cavum::explain {

/// A session's noise: the same spectrum, other phases; the few rows beyond a smooth length are
/// drawn from the session's own.
class Phases {
 public:
  /// `z`: all rows, whitened.
  Phases(const Series& z, const SessionRows& rows);
  [[nodiscard]] Eigen::Index rows() const { return own_.size(); }
  /// Writes rows() values.
  void draw(Random& random, float* out) const;

 private:
  Eigen::ArrayXf own_;
  std::size_t smooth_;
  std::vector<float> size_;  ///< of the spectrum's lines
};

/// Surrogates of one recording, to be made a few at a time.
class Surrogates {
 public:
  /// The view needs its lines, not its products.
  Surrogates(const View& view, std::uint64_t seed);
  /// Whitened noise in place of the recording's: surrogates [first, first + count), shape [rows,
  /// count].
  [[nodiscard]] Eigen::MatrixXf noise(std::size_t first, std::size_t count) const;
  [[nodiscard]] std::uint64_t seed() const { return seed_; }

 private:
  std::uint64_t seed_;
  Eigen::MatrixXf errors_;  ///< of the force by motions that are possible, whitened, [rows,
                            ///< motions]; empty where the position leaves nothing open
  std::vector<Phases> sessions_;
  std::vector<Eigen::Index> begin_;
};

/// What forces [rows] of many recordings have in common with the columns, under each spread.
struct Observed {
  std::vector<Eigen::MatrixXd> with_columns;  ///< [spread] of shape [columns, recordings]
  std::vector<Eigen::VectorXd> squares;       ///< [spread] of shape [recordings]
};
/// The first `count`. The view needs its products' columns.
[[nodiscard]] Observed observed_surrogates(const View& view, const Surrogates& surrogates,
                                           std::size_t count);
/// The recording itself.
[[nodiscard]] Observed observed_data(const std::vector<SpreadSums>& sums);

}  // namespace cavum::explain
