// The noise of a load cell: each sample remembers the last one, e' = ρ e + u, and now and then u is large. Whitening
// turns rows into independent ones, so that least squares and its standard errors hold; robust weights bound what a
// single sample can say. Source: Cochrane and Orcutt 1949; weights after Huber 1964.
#pragma once

#include "engine/explain/recording/recording.h"

namespace cavum::explain {

struct Noise {
  double rho = 0.0;      ///< correlation with the row before, in [0, 0.995]
  double sd_n = 0.0;     ///< of e, N
  double step_sd_n = 0;  ///< of u = e' − ρ e, N
};

/// From the differences of the residual over 1 to 5 rows, which a slow effect that is still in it hardly touches:
/// E[(e_{i+h} − e_i)²]/2 = sd²(1 − ρ^h). Rows with weight under 0.5 and those next to gaps are left out.
[[nodiscard]] Noise estimate_noise(const Recording& recording, const Series& residual_n, const Series& weight);

/// Rows z → sqrt(w)·(z_i − ρ z_{i−1})/step_sd; the first of a session z·sqrt(1 − ρ²)/step_sd. In place; shape [rows].
class Whitening {
 public:
  /// `robust`: extra weights, shape [rows], or empty.
  Whitening(const Recording& recording, const Noise& noise, const Series& weight, const Series& robust);
  void apply(const double* in, double* out, const SessionRows& rows) const;
  void apply(Series& z) const;
  [[nodiscard]] const Series& root_weight() const { return root_weight_; }

 private:
  const Recording* recording_;
  Noise noise_;
  Series root_weight_;  ///< sqrt of weight over step_sd; pairs take the smaller
};

/// Huber weights of innovations z in units of their scatter: 1 up to 2.5, then 2.5/|z|.
[[nodiscard]] Series robust_weights(const Series& whitened);

}  // namespace cavum::explain
