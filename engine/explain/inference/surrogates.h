// Recordings in which nothing is hidden, to learn what a search finds by chance: the noise of the recording with its own spectrum and phases drawn
// anew, session by session; what an uncertain position does to the force; and sessions that differ as those of the recording do. The columns stay as
// they are, so that hundreds of surrogates cost little. Source: Theiler et al. 1992, Testing for nonlinearity in time series: the method of surrogate
// data.
#pragma once

#include <cstdint>

#include "engine/explain/model/view.h"

namespace cavum::explain {

/// Whitened noise in place of the recording's, [rows, count]. The view needs its products' columns.
[[nodiscard]] Eigen::MatrixXf surrogate_noise(const View& view, std::size_t count, std::uint64_t seed);

/// What forces [rows] of many recordings have in common with the columns, under each spread.
struct Observed {
  std::vector<Eigen::MatrixXd> with_columns;  ///< [spread] of shape [columns, recordings]
  std::vector<Eigen::VectorXd> squares;       ///< [spread] of shape [recordings]
};
[[nodiscard]] Observed observed_surrogates(const View& view, std::size_t count, std::uint64_t seed);
/// The recording itself.
[[nodiscard]] Observed observed_data(const std::vector<SpreadSums>& sums);

}  // namespace cavum::explain
