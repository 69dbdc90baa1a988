#include "engine/lab/explain/model/lines.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <set>
#include <unsupported/Eigen/FFT>

namespace cavum::explain {
namespace {

constexpr double k_lowest_hz = 1.0;  // below, other mechanisms are slow enough to look like a line

/// Power at `hz`, summed over the sessions, each with a phase of its own.
double power_at(const Recording& r, const Series& z, double hz) {
  double power = 0.0;
  for (const auto& s : r.sessions) {
    std::complex<double> sum = 0.0;
    std::complex<double> turn = std::polar(
                             1.0, -2 * std::numbers::pi * std::fmod(hz * r.t_s[s.begin], 1.0)),
                         step = 1.0;
    double dt = -1.0;
    for (Eigen::Index i = s.begin; i < s.end; ++i) {
      sum += z[i] * turn;
      if (i + 1 == s.end) break;
      const double now = r.t_s[i + 1] - r.t_s[i];
      if (std::fabs(now - dt) > 1e-9)
        step = std::polar(1.0, -2 * std::numbers::pi * hz * now), dt = now;
      turn *= step;
    }
    power += std::norm(sum);
  }
  return power;
}

}  // namespace

std::vector<double> strongest_lines_hz(const Scene& scene, const Series& whitened, int count,
                                       const std::vector<double>& known_hz) {
  const Recording& r = *scene.recording;
  const Series& z = whitened;
  Eigen::Index longest = 0;
  for (const auto& s : r.sessions) longest = std::max(longest, s.end - s.begin);
  std::size_t n = 1;
  while (n < static_cast<std::size_t>(longest)) n *= 2;
  const double dt = scene.dt_s.sum() / static_cast<double>(scene.dt_s.size());
  if (longest < 64 || dt <= 0.0) return {};
  Eigen::FFT<double> fft;
  std::vector<double> power(n / 2, 0.0), in(n);
  std::vector<std::complex<double>> spectrum;
  for (const auto& s : r.sessions) {
    std::fill(in.begin(), in.end(), 0.0);
    for (Eigen::Index i = s.begin; i < s.end; ++i) in[static_cast<std::size_t>(i - s.begin)] = z[i];
    fft.fwd(spectrum, in);
    for (std::size_t i = 0; i < n / 2; ++i) power[i] += std::norm(spectrum[i]);
  }
  const double bin_hz = 1.0 / (static_cast<double>(n) * dt);
  std::set<double> own(known_hz.begin(),
                       known_hz.end());  // and rates of the spindle as the sampling shows them
  if (const Series* rpm = r.column("spindle_rpm")) {
    std::set<double> rates;
    for (Eigen::Index i = 0; i < rpm->size() && rates.size() < 64; i += 50)
      if ((*rpm)[i] > 0.0) rates.insert(std::round((*rpm)[i]));
    for (const double rate : rates) {
      const double hz = std::fmod(rate / 60.0 * dt, 1.0);
      own.insert(std::min(hz, 1.0 - hz) / dt);
    }
  }
  std::vector<double> out;
  while (static_cast<int>(out.size()) < count) {
    std::size_t best = 0;
    for (std::size_t i = 1; i + 1 < power.size(); ++i) {
      const double hz = static_cast<double>(i) * bin_hz;
      if (hz < k_lowest_hz || hz * dt > k_highest_line || power[i] < power[i - 1] ||
          power[i] < power[i + 1])
        continue;
      if (std::any_of(own.begin(), own.end(),
                      [&](double o) { return std::fabs(o - hz) < std::max(0.25, 4 * bin_hz); }))
        continue;
      if (best == 0 || power[i] > power[best]) best = i;
    }
    if (best == 0) break;
    const double around = static_cast<double>(best) * bin_hz;
    double hz = around, most = -1.0;
    for (int step = -12; step <= 12; ++step) {
      const double trial = around + step * bin_hz / 10.0, p = power_at(r, z, trial);
      if (p > most) most = p, hz = trial;
    }
    out.push_back(hz);
    for (std::size_t i = best > 4 ? best - 4 : 0; i < std::min(power.size(), best + 5); ++i)
      power[i] = 0.0;
  }
  return out;
}

double line_trials(const Scene& scene) {
  Eigen::Index longest = 0;
  for (const auto& s : scene.recording->sessions) longest = std::max(longest, s.end - s.begin);
  return std::max(1.0, static_cast<double>(longest) * k_highest_line);
}

double line_p_value(const Scene& scene, const Series& z, const Series& sine, const Series& cosine,
                    double trials) {
  const Recording& r = *scene.recording;
  constexpr int k_nearest = 3,
                k_farthest = 12;  // neighbours, in units of what a session can tell apart
  double x = 0.0, sessions = 0.0;
  for (const auto& s : r.sessions) {
    const double length_s = r.t_s[s.end - 1] - r.t_s[s.begin];
    const auto power = [&](double offset_hz) {
      // rows are taken as even: an offset of a few turns in a session is no more than a slow turn
      // of the phase
      const double per_row = -2 * std::numbers::pi * offset_hz * length_s /
                             static_cast<double>(std::max<Eigen::Index>(1, s.end - s.begin - 1));
      const std::complex<double> step = std::polar(1.0, per_row);
      std::complex<double> sum = 0.0, turn = 1.0;
      for (Eigen::Index i = s.begin; i < s.end; ++i, turn *= step)
        if (sine[i] != 0.0 || cosine[i] != 0.0)
          sum += z[i] * std::complex<double>(cosine[i], -sine[i]) * turn;
      return std::norm(sum);
    };
    if (!(length_s > 0.0)) continue;
    double level = 0.0;
    for (int step = k_nearest; step <= k_farthest; ++step)
      level += power(step / length_s) + power(-step / length_s);
    level /= 2.0 * (k_farthest - k_nearest + 1);
    if (!(level > 0.0)) continue;
    x += power(0.0) / level;
    sessions += 1.0;
  }
  // power over its level, summed over n sessions, is a gamma variable of order n
  double term = 1.0, sum = 1.0;
  for (double k = 1.0; k < sessions; k += 1.0) sum += term *= x / k;
  return sessions > 0.0 ? std::min(1.0, trials * sum * std::exp(-x)) : 1.0;
}

}  // namespace cavum::explain
