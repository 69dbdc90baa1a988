#include "engine/lab/explain/recording/noise.h"

#include <algorithm>
#include <cmath>

#include "engine/base/order.h"

namespace cavum::explain {
namespace {

constexpr double k_huber = 2.5;  // in standard deviations: 99 % efficient on Gaussian noise
constexpr double k_blow = 6.0;   // scatters: one blow must not set the noise
constexpr double k_max_reflected = 0.9995;
// What wanders beside the model is a fault of the model as likely as noise: a share of it counts as
// white, or a fit would believe in nothing but the fastest changes. Of 82 real holds
// (docs/explain.md) 0, 0.02, 0.1, 0.5 left 58, 65, 66, 66 % gain on sessions not seen.
constexpr double k_white_share = 0.1;
constexpr double k_min_left =
    1e-6;  // of the variance: less comes of covariances that are no process's

/// The residual about each session's mean, 0 where it does not count.
Series centred(const Recording& recording, const Series& residual, const Series& counts) {
  Series e = Series::Zero(residual.size());
  for (const auto& s : recording.sessions) {
    double sum = 0.0, n = 0.0;
    for (Eigen::Index i = s.begin; i < s.end; ++i)
      if (counts[i] > 0.0) sum += residual[i], n += 1.0;
    for (Eigen::Index i = s.begin; i < s.end; ++i)
      if (counts[i] > 0.0) e[i] = residual[i] - sum / n;
  }
  std::vector<double> size;
  for (Eigen::Index i = 0; i < e.size(); ++i)
    if (counts[i] > 0.0) size.push_back(std::fabs(e[i]));
  if (size.empty()) return e;
  const double limit = k_blow * 1.4826 * median(std::move(size));
  return limit > 0.0 ? Series(e.max(-limit).min(limit)) : e;
}

/// Covariances over 0 to k_noise_orders rows, tapered so that they are those of some process.
std::vector<double> covariances(const Recording& recording, const Series& e, const Series& counts) {
  std::vector<double> out(k_noise_orders + 1, 0.0);
  double length = 0.0;
  for (const auto& s : recording.sessions)
    length = std::max(length, static_cast<double>(s.end - s.begin));
  for (int lag = 0; lag <= k_noise_orders; ++lag) {
    double sum = 0.0, n = 0.0;
    for (const auto& s : recording.sessions)
      for (Eigen::Index i = s.begin + lag; i < s.end; ++i)
        if (counts[i] > 0.0 && counts[i - lag] > 0.0) sum += e[i] * e[i - lag], n += 1.0;
    out[static_cast<std::size_t>(lag)] =
        n > 0.0 ? sum / n * std::max(0.0, 1.0 - lag / length) : 0.0;
  }
  return out;
}

/// The predictor one order higher.
std::vector<double> raised(const std::vector<double>& phi, double reflected) {
  std::vector<double> out(phi.size() + 1);
  for (std::size_t j = 0; j < phi.size(); ++j)
    out[j] = phi[j] - reflected * phi[phi.size() - 1 - j];
  out.back() = reflected;
  return out;
}

/// Variance that a predictor leaves.
double left_by(const std::vector<double>& phi, const std::vector<double>& c) {
  double sum = c[0];
  for (std::size_t i = 0; i < phi.size(); ++i) {
    sum -= 2.0 * phi[i] * c[i + 1];
    for (std::size_t j = 0; j < phi.size(); ++j) sum += phi[i] * phi[j] * c[i > j ? i - j : j - i];
  }
  return std::max(1e-18, sum);
}

std::vector<double> coefficients(const Noise& noise) {
  return noise.ar.empty() ? std::vector<double>{noise.rho} : noise.ar;
}

}  // namespace

Noise estimate_noise(const Recording& recording, const Series& residual, const Series& weight) {
  const double enough = (weight > 0.5).count() * 20 > weight.size()
                            ? 0.5
                            : 0.0;  // where the position leaves all rows uncertain, all count
  const Series counts = (weight > enough).cast<double>();
  const Series e = centred(recording, residual, counts);
  const std::vector<double> c = covariances(recording, e, counts);
  const double rounding_n = recording.rig.force_quantum_n / std::sqrt(12.0);
  Noise best{0.0, std::max({1e-9, std::sqrt(c[0]), c[0] > 1e-18 ? 0.0 : rounding_n}), 0.0, {0.0}};
  best.step_sd_n = best.sd_n;
  if (!(c[0] > 1e-18)) return best;
  const double rows = std::max(2.0, counts.sum());
  std::vector<double> phi;
  double variance = c[0] * (1.0 + k_white_share), least = rows * std::log(variance);
  for (int order = 1; order <= k_noise_orders; ++order) {
    double sum = c[static_cast<std::size_t>(order)];
    for (std::size_t j = 0; j < phi.size(); ++j)
      sum -= phi[j] * c[static_cast<std::size_t>(order) - 1 - j];
    if (order > 1 && std::fabs(sum) >= variance)
      break;  // rows that do not count may leave covariances that are no process's
    const double reflected = std::clamp(sum / variance, -k_max_reflected, k_max_reflected);
    phi = raised(phi, reflected);
    variance *= 1.0 - reflected * reflected;
    if (const double cost = rows * std::log(variance) + order * std::log(rows); cost < least) {
      least = cost;
      best.ar = phi;
      const double left = left_by(phi, c), expected = variance / (1.0 + k_white_share);
      best.step_sd_n = std::max(1e-9, std::sqrt(left > k_min_left * c[0] ? left : expected));
    }
  }
  best.rho = std::clamp(c[1] / c[0], -k_max_reflected, k_max_reflected);
  best.sd_n = std::max(best.sd_n, rounding_n);
  best.step_sd_n = std::max(best.step_sd_n, rounding_n);
  return best;
}

Whitening::Whitening(const Recording& recording, const Noise& noise, const Series& weight,
                     const Series& robust)
    : recording_(&recording), root_weight_(weight.size()) {
  // step down from the highest order to none (Levinson's recursion read backwards)
  predictors_.push_back(coefficients(noise));
  std::vector<double> sd{noise.step_sd_n};
  while (!predictors_.back().empty()) {
    const std::vector<double>& high = predictors_.back();
    const double reflected = high.back(), rest = std::max(1e-6, 1.0 - reflected * reflected);
    std::vector<double> low(high.size() - 1);
    for (std::size_t j = 0; j < low.size(); ++j)
      low[j] = (high[j] + reflected * high[high.size() - 2 - j]) / rest;
    sd.push_back(sd.back() / std::sqrt(rest));
    predictors_.push_back(std::move(low));
  }
  std::reverse(predictors_.begin(), predictors_.end());
  std::reverse(sd.begin(), sd.end());
  const auto uncertain = [&](Eigen::Index i) {
    return 1.0 / std::max(1e-12, weight[i]) - 1.0;
  };  // variance beside the noise's own
  for (const auto& s : recording.sessions)
    for (Eigen::Index i = s.begin; i < s.end; ++i) {
      const std::size_t order =
          std::min(predictors_.size() - 1, static_cast<std::size_t>(i - s.begin));
      double variance = 1.0 + uncertain(i);
      for (std::size_t j = 0; j < order; ++j)
        variance += predictors_[order][j] * predictors_[order][j] *
                    uncertain(i - 1 - static_cast<Eigen::Index>(j));
      root_weight_[i] = std::sqrt((robust.size() > 0 ? robust[i] : 1.0) / variance) / sd[order];
    }
}

void Whitening::apply(const double* in, double* out, const SessionRows& rows) const {
  const auto n = static_cast<std::size_t>(rows.end - rows.begin), most = predictors_.size() - 1;
  const Series z = Eigen::Map<const Series>(
      in, static_cast<Eigen::Index>(n));  // a copy, so that it can be done in place
  Eigen::Map<Series> u(out, static_cast<Eigen::Index>(n));
  u = z;
  for (std::size_t i = 0; i < std::min(most, n); ++i)
    for (std::size_t j = 0; j < i; ++j)
      u[static_cast<Eigen::Index>(i)] -=
          predictors_[i][j] * z[static_cast<Eigen::Index>(i - 1 - j)];
  constexpr Eigen::Index k_rows = 2048;  // at a time, so that they stay in the cache
  for (auto from = static_cast<Eigen::Index>(most); from < u.size(); from += k_rows) {
    const Eigen::Index count = std::min(k_rows, u.size() - from);
    for (std::size_t j = 0; j < most; ++j)
      u.segment(from, count) -=
          predictors_[most][j] * z.segment(from - 1 - static_cast<Eigen::Index>(j), count);
  }
  u *= root_weight_.segment(rows.begin, u.size());
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
