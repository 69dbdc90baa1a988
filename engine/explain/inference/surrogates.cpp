#include "engine/explain/inference/surrogates.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "engine/base/random.h"
#include "engine/statistics/independent_runs.h"

namespace cavum::explain {
namespace {

constexpr std::size_t k_motions = 24;      // drawn, and shared by the surrogates
constexpr double k_certain_mean = 0.9995;  // of the rows' weights: beyond it the position leaves nothing open
constexpr std::size_t k_at_a_time = 50;    // surrogates that one thread makes

/// Largest number up to n with no prime factor above 5: what the transform is quick for.
std::size_t smooth_length(std::size_t n) {
  std::size_t best = 1;
  for (std::size_t a = 1; a <= n; a *= 2)
    for (std::size_t b = a; b <= n; b *= 3)
      for (std::size_t c = b; c <= n; c *= 5) best = std::max(best, c);
  return best;
}

/// Same spectrum, other phases; the few rows beyond a smooth length are drawn from the session's own.
void draw_phases(const Series& z, const SessionRows& rows, Random& random, Eigen::MatrixXf& out, Eigen::Index column) {
  const auto n = static_cast<std::size_t>(rows.end - rows.begin), smooth = smooth_length(n);
  std::vector<float> in(smooth);
  for (std::size_t i = 0; i < smooth; ++i) in[i] = static_cast<float>(z[rows.begin + static_cast<Eigen::Index>(i)]);
  Eigen::FFT<float> fft;
  fft.SetFlag(Eigen::FFT<float>::HalfSpectrum);
  std::vector<std::complex<float>> spectrum;
  fft.fwd(spectrum, in);
  for (std::size_t i = 0; i < spectrum.size(); ++i) {
    const bool real = i == 0 || 2 * i == smooth;
    const double phase = real ? std::numbers::pi * static_cast<double>(random.below(2)) : random.uniform(0.0, 2 * std::numbers::pi);
    spectrum[i] = std::abs(spectrum[i]) * std::polar(1.0F, static_cast<float>(phase));
  }
  fft.inv(in, spectrum, static_cast<Eigen::Index>(smooth));
  for (std::size_t i = 0; i < n; ++i)
    out(rows.begin + static_cast<Eigen::Index>(i), column) =
        i < smooth ? in[i] : static_cast<float>(z[rows.begin + static_cast<Eigen::Index>(random.below(n))]);
}

/// What the force would be off by if the tool had moved otherwise, as far as the position leaves that open, whitened; empty when it leaves nothing
/// open.
Eigen::MatrixXf motion_errors(const View& v, std::uint64_t seed) {
  if (v.scene.weight.mean() > k_certain_mean) return {};
  const std::vector<Motion> drawn = draw_motions(*v.scene.recording, v.scene.motion, k_motions, seed);
  Eigen::MatrixXf out(v.force_n.size(), static_cast<Eigen::Index>(drawn.size()));
  const Whitening white = whitening_of(v);
  independent_runs(drawn.size(), [&](std::size_t i) {
    Scene truth = make_scene(*v.scene.recording, drawn[i], v.scene.base, v.noise.sd_n, v.noise.rho);
    truth.lines_hz = v.scene.lines_hz;
    truth.left_n = v.scene.left_n;
    Series off = force_of(truth, v.causes, v.base_fit.value) - v.model_n;
    white.apply(off);
    out.col(static_cast<Eigen::Index>(i)) = off.cast<float>().matrix();
  });
  return out;
}

}  // namespace

Eigen::MatrixXf surrogate_noise(const View& v, std::size_t count, std::uint64_t seed) {
  Series z = v.residual_n;
  whitening_of(v).apply(z);
  Eigen::MatrixXf out(z.size(), static_cast<Eigen::Index>(count));
  const Eigen::MatrixXf errors = motion_errors(v, seed);
  independent_runs((count + k_at_a_time - 1) / k_at_a_time, [&](std::size_t batch) {
    for (std::size_t i = batch * k_at_a_time; i < std::min(count, (batch + 1) * k_at_a_time); ++i) {
      Random random(seed + 0x9e3779b97f4a7c15ULL * (i + 1));
      const auto column = static_cast<Eigen::Index>(i);
      for (const auto& s : v.scene.recording->sessions) draw_phases(z, s, random, out, column);
      if (errors.cols() > 0) out.col(column) += errors.col(column % errors.cols());
    }
  });
  return out;
}

Observed observed_data(const std::vector<SpreadSums>& sums) {
  Observed out;
  for (const auto& u : sums) {
    out.with_columns.emplace_back(u.all.col(0));
    out.squares.emplace_back(Eigen::VectorXd::Constant(1, u.all(0, 0)));
  }
  return out;
}

Observed observed_surrogates(const View& v, std::size_t count, std::uint64_t seed) {
  const Eigen::MatrixXf z = surrogate_noise(v, count, seed);
  const auto n = static_cast<Eigen::Index>(count);
  Eigen::MatrixXd with_columns = (v.white->transpose() * z).cast<double>();
  Eigen::VectorXd squares = z.colwise().squaredNorm().transpose().cast<double>();
  // sessions differ, as those of the recording do
  std::vector<Eigen::MatrixXd> with_effects;
  Random random(seed);
  for (const auto& s : v.by_session) {
    const Eigen::MatrixXd effects = v.white_effects.middleRows(s.begin, s.end - s.begin);
    Eigen::MatrixXd noise = effects.transpose() * z.middleRows(s.begin, s.end - s.begin).cast<double>();
    Eigen::MatrixXd own(k_session_effects, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (std::size_t e = 0; e < k_session_effects; ++e) own(static_cast<Eigen::Index>(e), i) = v.spread[e] * random.normal();
    with_columns += s.with_effects * own;
    squares += (2.0 * own.cwiseProduct(noise) + own.cwiseProduct(s.effects * own)).colwise().sum().transpose();
    with_effects.push_back(noise + s.effects * own);
  }
  Observed out;
  for (const auto& spread : narrower_spreads(v.spread)) {
    out.with_columns.push_back(with_columns);
    out.squares.push_back(squares);
    for (std::size_t i = 0; i < v.by_session.size(); ++i) {
      double log_det = 0.0;
      const Eigen::MatrixXd inverse = shrunk_inverse(v.by_session[i].effects, spread, log_det);
      out.with_columns.back() -= v.by_session[i].with_effects * (inverse * with_effects[i]);
      out.squares.back() -= with_effects[i].cwiseProduct(inverse * with_effects[i]).colwise().sum().transpose();
    }
  }
  return out;
}

}  // namespace cavum::explain
