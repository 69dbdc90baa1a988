#include "engine/lab/explain/inference/surrogates.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "engine/base/independent_runs.h"
#include "engine/base/random.h"

namespace cavum::explain {
namespace {

constexpr std::size_t k_motions = 24;  // drawn, and shared by the surrogates
constexpr double k_certain_mean =
    0.9995;  // of the rows' weights: beyond it the position leaves nothing open
constexpr std::size_t k_motions_at_a_time = 4;
constexpr std::size_t k_at_a_time =
    16;  // surrogates that are made and scored: all at once would be large

/// Largest number up to n with no prime factor above 5: what the transform is quick for.
std::size_t smooth_length(std::size_t n) {
  std::size_t best = 1;
  for (std::size_t a = 1; a <= n; a *= 2)
    for (std::size_t b = a; b <= n; b *= 3)
      for (std::size_t c = b; c <= n; c *= 5) best = std::max(best, c);
  return best;
}

/// Sines and cosines of all phases that are drawn: as many as no noise tells from all.
const std::vector<std::complex<float>>& phases() {
  static const std::vector<std::complex<float>> all = [] {
    constexpr std::size_t k_phases = 4096;
    std::vector<std::complex<float>> out(k_phases);
    for (std::size_t i = 0; i < k_phases; ++i)
      out[i] = std::complex<float>(std::polar(
          1.0, 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(k_phases)));
    return out;
  }();
  return all;
}

/// Plans are kept, one set for each thread.
Eigen::FFT<float>& transform() {
  thread_local Eigen::FFT<float> fft = [] {
    Eigen::FFT<float> made;
    made.SetFlag(Eigen::FFT<float>::HalfSpectrum);
    return made;
  }();
  return fft;
}

/// What the force would be off by if the tool had moved otherwise, as far as the position leaves
/// that open, whitened; empty when it leaves nothing open.
Eigen::MatrixXf motion_errors(const View& v, std::uint64_t seed) {
  if (v.scene->weight.mean() > k_certain_mean) return {};
  Eigen::MatrixXf out(v.force_n->size(), static_cast<Eigen::Index>(k_motions));
  const Whitening white = whitening_of(v);
  for (std::size_t first = 0; first < k_motions; first += k_motions_at_a_time) {
    const std::vector<Motion> drawn = draw_motions(*v.scene->recording, *v.scene->motion,
                                                   {first, first + k_motions_at_a_time}, seed);
    independent_runs(drawn.size(), [&](std::size_t i) {
      Scene truth =
          make_scene(*v.scene->recording, drawn[i], v.scene->base, v.noise.sd_n, v.noise.rho);
      truth.lines_hz = v.scene->lines_hz;
      truth.left_n = v.scene->left_n;
      Series off = force_of(truth, v.causes, v.base_fit.value) - *v.model_n;
      white.apply(off);
      out.col(static_cast<Eigen::Index>(first + i)) = off.cast<float>().matrix();
    });
  }
  return out;
}

}  // namespace

Phases::Phases(const Series& z, const SessionRows& rows)
    : own_(z.segment(rows.begin, rows.end - rows.begin).cast<float>()),
      smooth_(smooth_length(static_cast<std::size_t>(own_.size()))) {
  const std::vector<float> in(own_.data(), own_.data() + smooth_);
  std::vector<std::complex<float>> spectrum;
  transform().fwd(spectrum, in);
  for (const auto& s : spectrum) size_.push_back(std::abs(s));
}

void Phases::draw(Random& random, float* out) const {
  std::vector<std::complex<float>> spectrum(size_.size());
  for (std::size_t i = 0; i < spectrum.size(); ++i) {
    const bool real = i == 0 || 2 * i == smooth_;
    spectrum[i] =
        size_[i] *
        phases()[real ? phases().size() / 2 * random.below(2) : random.below(phases().size())];
  }
  std::vector<float> drawn(smooth_);
  transform().inv(drawn, spectrum, static_cast<Eigen::Index>(smooth_));
  const auto n = static_cast<std::size_t>(own_.size());
  for (std::size_t i = 0; i < n; ++i)
    out[i] = i < smooth_ ? drawn[i] : own_[static_cast<Eigen::Index>(random.below(n))];
}

Surrogates::Surrogates(const View& v, std::uint64_t seed)
    : seed_(seed), errors_(motion_errors(v, seed)) {
  Series z = *v.residual_n;
  whitening_of(v).apply(z);
  for (const auto& s : v.scene->recording->sessions) {
    sessions_.emplace_back(z, s);
    begin_.push_back(s.begin);
  }
}

Eigen::MatrixXf Surrogates::noise(std::size_t first, std::size_t count) const {
  const Eigen::Index rows = sessions_.empty() ? 0 : begin_.back() + sessions_.back().rows();
  Eigen::MatrixXf out(rows, static_cast<Eigen::Index>(count));
  independent_runs(count, [&](std::size_t i) {
    Random random(seed_ + 0x9e3779b97f4a7c15ULL * (first + i + 1));
    const auto column = static_cast<Eigen::Index>(i);
    for (std::size_t s = 0; s < sessions_.size(); ++s)
      sessions_[s].draw(random, out.col(column).data() + begin_[s]);
    if (errors_.cols() > 0)
      out.col(column) += errors_.col(static_cast<Eigen::Index>(first + i) % errors_.cols());
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

Observed observed_surrogates(const View& v, const Surrogates& surrogates, std::size_t count) {
  const auto n = static_cast<Eigen::Index>(count), columns = v.white->columns();
  const std::vector<SessionProducts>& sessions = v.products->sessions;
  Eigen::MatrixXd with_columns = Eigen::MatrixXd::Zero(columns, n);
  Eigen::VectorXd squares(n);
  std::vector<Eigen::MatrixXd> with_effects(sessions.size(), Eigen::MatrixXd(k_session_effects, n));
  for (std::size_t first = 0; first < count; first += k_at_a_time) {
    const std::size_t many = std::min(k_at_a_time, count - first);
    const auto from = static_cast<Eigen::Index>(first), size = static_cast<Eigen::Index>(many);
    const Eigen::MatrixXf z = surrogates.noise(first, many);
    std::vector<Eigen::MatrixXd> by_session(sessions.size());
    independent_runs(sessions.size(), [&](std::size_t s) {
      by_session[s] = Eigen::MatrixXd::Zero(columns, size);
      for (Eigen::Index at = sessions[s].begin; at < sessions[s].end; at += k_white_rows) {
        const Eigen::Index rows = std::min(k_white_rows, sessions[s].end - at);
        by_session[s] +=
            (v.white->rows(at, rows).transpose() * z.middleRows(at, rows)).cast<double>();
      }
      const Eigen::Index begin = sessions[s].begin, length = sessions[s].end - begin;
      with_effects[s].middleCols(from, size) =
          v.white_effects->middleRows(begin, length).transpose().cast<double>() *
          z.middleRows(begin, length).cast<double>();
    });
    for (const auto& one : by_session) with_columns.middleCols(from, size) += one;
    squares.segment(from, size) = z.colwise().squaredNorm().transpose().cast<double>();
  }
  // sessions differ, as those of the recording do
  Random random(surrogates.seed());
  for (std::size_t s = 0; s < sessions.size(); ++s) {
    Eigen::MatrixXd own(k_session_effects, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (std::size_t e = 0; e < k_session_effects; ++e)
        own(static_cast<Eigen::Index>(e), i) = v.spread[e] * random.normal();
    with_columns += sessions[s].with_effects * own;
    squares +=
        (2.0 * own.cwiseProduct(with_effects[s]) + own.cwiseProduct(sessions[s].effects * own))
            .colwise()
            .sum()
            .transpose();
    with_effects[s] += sessions[s].effects * own;
  }
  Observed out;
  for (std::size_t u = 0; u < v.products->tried.size(); ++u) {
    out.with_columns.push_back(with_columns);
    out.squares.push_back(squares);
    for (std::size_t i = 0; i < sessions.size(); ++i) {
      const Eigen::MatrixXd& inverse = sessions[i].inverse[u];
      out.with_columns.back() -= sessions[i].with_effects * (inverse * with_effects[i]);
      out.squares.back() -=
          with_effects[i].cwiseProduct(inverse * with_effects[i]).colwise().sum().transpose();
    }
  }
  return out;
}

}  // namespace cavum::explain
