// The noise of a load cell: each sample remembers those before it, e_i = sum of phi_j e_(i-j) + u,
// and now and then u is large. Pink noise, a wandering zero, mains hum and a resonance all look
// like this with enough phi. Whitening turns rows into independent ones, so that least squares and
// its standard errors hold; robust weights bound what a single sample can say. Sources: Cochrane
// and Orcutt 1949; Levinson and Durbin's recursion (Brockwell and Davis 1991, section 5.2); order
// by Schwarz 1978; weights after Huber 1964.
#pragma once

#include "engine/lab/explain/recording/recording.h"

namespace cavum::explain {

struct Noise {
  double rho = 0.0;        ///< correlation with the row before
  double sd_n = 0.0;       ///< of e, N
  double step_sd_n = 0;    ///< of u, N
  std::vector<double> ar;  ///< phi_1 … phi_p; empty: rho alone
};

/// From the residual's correlations over up to k_noise_orders rows, each session about its own
/// mean. Values beyond 6 scatters count as 6, and rows with weight under 0.5 are left out. No less
/// than rounding to the force quantum makes. An effect that is still in the residual is taken for
/// noise: it makes the noise larger, never smaller.
[[nodiscard]] Noise estimate_noise(const Recording& recording, const Series& residual_n,
                                   const Series& weight);

inline constexpr int k_noise_orders = 24;

/// Rows z → sqrt(w)·(z_i − sum of phi_j z_{i−j})/step_sd; the first p of a session by the
/// predictors of lower order. In place; shape [rows].
class Whitening {
 public:
  /// `robust`: extra weights, shape [rows], or empty.
  Whitening(const Recording& recording, const Noise& noise, const Series& weight,
            const Series& robust);
  void apply(const double* in, double* out, const SessionRows& rows) const;
  void apply(Series& z) const;
  [[nodiscard]] const Series& root_weight() const { return root_weight_; }

 private:
  const Recording* recording_;
  std::vector<std::vector<double>> predictors_;  ///< of order 0 to p
  Series root_weight_;  ///< over the standard deviation of the row's innovation; what is uncertain
                        ///< before adds to it
};

/// Huber weights of innovations z in units of their scatter: 1 up to 2.5, then 2.5/|z|.
[[nodiscard]] Series robust_weights(const Series& whitened);

}  // namespace cavum::explain
