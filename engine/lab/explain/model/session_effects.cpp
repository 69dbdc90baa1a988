#include "engine/lab/explain/model/session_effects.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace cavum::explain {
namespace {

constexpr int k_passes =
    60;  // of expectation maximisation; what is not there is at a tenth of its first guess by then
constexpr SessionSpread k_first_guess{0.1, 0.05, 0.1, 0.005, 0.2};  // N, mm, relative, s, relative
constexpr double k_worth = 1.0;  // of -2 log likelihood, for an effect to be kept
constexpr std::array k_narrower{0.3, 0.0};

struct SessionSums {
  Eigen::MatrixXd effects;
  Eigen::VectorXd residual;
};

std::vector<SessionSums> sums_of(const Recording& r, const EffectColumns& white,
                                 const Series& residual) {
  std::vector<SessionSums> out;
  for (const auto& s : r.sessions) {
    const Eigen::MatrixXd block = white.middleRows(s.begin, s.end - s.begin).cast<double>();
    SessionSums one{block.transpose() * block,
                    block.transpose() * residual.segment(s.begin, s.end - s.begin).matrix()};
    if (one.effects.trace() > 0.0) out.push_back(std::move(one));
  }
  return out;
}

/// -2 log likelihood beyond that of no effects.
double cost_of(const std::vector<SessionSums>& sessions, const SessionSpread& spread) {
  double cost = 0.0;
  for (const auto& s : sessions) {
    double log_det = 0.0;
    const Eigen::MatrixXd inverse = shrunk_inverse(s.effects, spread, log_det);
    cost += log_det - s.residual.dot(inverse * s.residual);
  }
  return cost;
}

SessionSpread maximised(const std::vector<SessionSums>& sessions, SessionSpread spread) {
  for (int pass = 0; pass < k_passes; ++pass) {
    SessionSpread square{};
    for (const auto& s : sessions) {
      double log_det = 0.0;
      const Eigen::MatrixXd inverse = shrunk_inverse(s.effects, spread, log_det);
      const Eigen::VectorXd mean = inverse * s.residual;
      for (std::size_t e = 0; e < k_session_effects; ++e) {
        const auto i = static_cast<Eigen::Index>(e);
        square[e] += mean[i] * mean[i] + inverse(i, i);
      }
    }
    for (std::size_t e = 0; e < k_session_effects; ++e)
      spread[e] =
          spread[e] > 0.0 ? std::sqrt(square[e] / static_cast<double>(sessions.size())) : 0.0;
  }
  return spread;
}

}  // namespace

EffectColumns session_columns(const Scene& s, const Series& causes_n) {
  EffectColumns out = EffectColumns::Zero(s.force_n.size(), k_session_effects);
  out.col(k_force_zero).setOnes();
  out.col(k_surface_position) = (s.base.k_n_per_mm * s.active).cast<float>().matrix();
  out.col(k_stiffness) = (s.base.k_n_per_mm * s.spring_mm)
                             .cast<float>()
                             .matrix();  // c apart, or a c that the rig knows would hold k by it
  // k V on every row that c V has, or c would be whatever the first rows of contact ask for
  Series late = -s.base.k_n_per_mm * s.damper_mm_s;
  for (const auto& rows : s.recording->sessions)
    for (Eigen::Index i = rows.begin + 1; i + 1 < rows.end;
         ++i)  // c dV/dt where contact lasts: its beginning is a step and no slope
      if (s.active[i - 1] > 0.5 && s.active[i] > 0.5 && s.active[i + 1] > 0.5)
        late[i] -= s.base.c_n_s_per_mm * (s.damper_mm_s[i + 1] - s.damper_mm_s[i - 1]) /
                   std::max(1e-12, s.dt_s[i - 1] + s.dt_s[i]);
  out.col(k_lateness) = late.cast<float>().matrix();
  if (causes_n.size() > 0) out.col(k_strength) = causes_n.cast<float>().matrix();
  return out;
}

Eigen::MatrixXd shrunk_inverse(const Eigen::MatrixXd& effects, const SessionSpread& spread,
                               double& log_det) {
  const Eigen::VectorXd d = Eigen::Map<const Eigen::VectorXd>(spread.data(), k_session_effects);
  // D (1 + D A D)^-1 D: good for a spread of 0, too
  const Eigen::MatrixXd scaled = d.asDiagonal() * effects * d.asDiagonal();
  const Eigen::LDLT<Eigen::MatrixXd> solver(
      Eigen::MatrixXd::Identity(k_session_effects, k_session_effects) + scaled);
  log_det = solver.vectorD().array().max(1e-300).log().sum();
  return d.asDiagonal() *
         solver.solve(Eigen::MatrixXd::Identity(k_session_effects, k_session_effects)) *
         d.asDiagonal();
}

SessionSpread estimate_spread(const Recording& r, const EffectColumns& white,
                              const Series& residual) {
  const std::vector<SessionSums> sessions = sums_of(r, white, residual);
  if (r.sessions.size() < 3 || sessions.size() < 3) return {};
  SessionSpread spread = maximised(sessions, k_first_guess);
  for (std::size_t e = 0; e < k_session_effects; ++e) {
    SessionSpread without = spread;
    without[e] = 0.0;
    if (cost_of(sessions, without) < cost_of(sessions, spread) + k_worth)
      spread = maximised(sessions, without);
  }
  return spread;
}

Series session_force_n(const Recording& r, const EffectColumns& raw, const EffectColumns& white,
                       const Series& residual, const SessionSpread& spread) {
  Series out = Series::Zero(residual.size());
  for (const auto& s : r.sessions) {
    const Eigen::Index n = s.end - s.begin;
    const Eigen::MatrixXd block = white.middleRows(s.begin, n).cast<double>();
    double log_det = 0.0;
    const Eigen::MatrixXd inverse = shrunk_inverse(block.transpose() * block, spread, log_det);
    const Eigen::VectorXd effect =
        inverse * (block.transpose() * residual.segment(s.begin, n).matrix());
    out.segment(s.begin, n) = (raw.middleRows(s.begin, n).cast<double>() * effect).array();
  }
  return out;
}

std::vector<SessionSpread> narrower_spreads(const SessionSpread& spread) {
  std::vector<SessionSpread> out{spread};
  std::size_t there = 0;
  for (std::size_t e = 0; e < k_session_effects; ++e) {
    if (spread[e] <= 0.0) continue;
    ++there;
    for (const double part : k_narrower) {
      out.push_back(spread);
      out.back()[e] *= part;
    }
  }
  if (there > 1) out.push_back({});
  return out;
}

}  // namespace cavum::explain
