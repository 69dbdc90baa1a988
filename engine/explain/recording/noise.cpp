#include "engine/explain/recording/noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "engine/statistics/order.h"

namespace cavum::explain {
namespace {

constexpr double k_huber = 2.5;  // in standard deviations: 99 % efficient on Gaussian noise
constexpr double k_max_rho = 0.995;
constexpr int k_lags = 5;

/// Mean square of values, those beyond 6 scatters counted as 6: one blow must not set the noise.
double clipped_mean_square(std::vector<double>& v) {
  if (v.empty()) return 0.0;
  std::vector<double> size(v.size());
  std::transform(v.begin(), v.end(), size.begin(), [](double d) { return std::fabs(d); });
  const double middle = median(std::move(size));
  const double limit = middle > 0.0 ? 6.0 * 1.4826 * middle : 1e300;
  double sum = 0.0;
  for (const double d : v) sum += std::min(d * d, limit * limit);
  return sum / static_cast<double>(v.size());
}

}  // namespace

Noise estimate_noise(const Recording& recording, const Series& residual, const Series& weight) {
  std::array<double, k_lags + 1> half{};                                          // variogram
  const double enough = (weight > 0.5).count() * 20 > weight.size() ? 0.5 : 0.0;  // where the position leaves all rows uncertain, all count
  for (int lag = 1; lag <= k_lags; ++lag) {
    std::vector<double> d;
    for (const auto& s : recording.sessions)
      for (Eigen::Index i = s.begin + lag; i < s.end; ++i)
        if (weight[i] > enough && weight[i - lag] > enough) d.push_back(residual[i] - residual[i - lag]);
    half[static_cast<std::size_t>(lag)] = 0.5 * clipped_mean_square(d);
  }
  // for each ρ the best sd² is linear: take the ρ with the smallest relative error over all lags
  Noise best;
  double best_error = 1e300;
  for (int step = 0; step <= 995; ++step) {
    const double rho = step * 1e-3;
    double ab = 0.0, aa = 0.0;
    for (int lag = 1; lag <= k_lags; ++lag) {
      const double model = 1.0 - std::pow(rho, lag), seen = half[static_cast<std::size_t>(lag)];
      if (seen <= 0.0) continue;
      ab += model / seen;
      aa += model * model / (seen * seen);
    }
    if (aa <= 0.0) break;
    const double var = ab / aa;
    double error = 0.0;
    for (int lag = 1; lag <= k_lags; ++lag) {
      const double seen = half[static_cast<std::size_t>(lag)];
      if (seen > 0.0) error += std::pow(var * (1.0 - std::pow(rho, lag)) / seen - 1.0, 2);
    }
    if (error < best_error) {
      best_error = error;
      best = {std::min(rho, k_max_rho), std::sqrt(var), 0.0};
    }
  }
  best.sd_n = std::max(best.sd_n, 1e-9);
  best.step_sd_n = best.sd_n * std::sqrt(1.0 - best.rho * best.rho);
  return best;
}

Whitening::Whitening(const Recording& recording, const Noise& noise, const Series& weight, const Series& robust)
    : recording_(&recording), noise_(noise), root_weight_(weight.size()) {
  for (const auto& s : recording.sessions)
    for (Eigen::Index i = s.begin; i < s.end; ++i) {
      double w = i > s.begin ? std::min(weight[i], weight[i - 1]) : weight[i];
      if (robust.size() > 0) w *= robust[i];
      root_weight_[i] = std::sqrt(w) / noise.step_sd_n;
    }
}

void Whitening::apply(const double* in, double* out, const SessionRows& rows) const {
  const double rho = noise_.rho;
  double before = in[0];
  out[0] = in[0] * std::sqrt(1.0 - rho * rho) * root_weight_[rows.begin];
  for (Eigen::Index i = 1; i < rows.end - rows.begin; ++i) {
    const double now = in[i];
    out[i] = (now - rho * before) * root_weight_[rows.begin + i];
    before = now;
  }
}

void Whitening::apply(Series& z) const {
  for (const auto& s : recording_->sessions) apply(z.data() + s.begin, z.data() + s.begin, s);
}

Series robust_weights(const Series& z) {
  std::vector<double> size(static_cast<std::size_t>(z.size()));
  for (Eigen::Index i = 0; i < z.size(); ++i) size[static_cast<std::size_t>(i)] = std::fabs(z[i]);
  const double scatter = std::max(1e-300, 1.4826 * median(std::move(size)));
  return (z.abs() / scatter).max(k_huber).inverse() * k_huber;
}

}  // namespace cavum::explain
