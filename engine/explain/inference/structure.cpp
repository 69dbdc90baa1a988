#include "engine/explain/inference/structure.h"

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

#include "engine/statistics/order.h"

namespace cavum::explain {
namespace {

constexpr int k_knots = 6;  // of a curve
constexpr double k_lags_s[] = {0.1, 0.3, 1.0, 3.0};

/// The residual and what is already in the model, whitened.
struct Left {
  const View* view;
  Whitening white;
  Eigen::MatrixXd model;                // [rows, k c and causes]
  Eigen::LDLT<Eigen::MatrixXd> solver;  // of modelᵀ model
  Eigen::VectorXd residual;
};

Left left_of(const View& v) {
  Left l{&v, whitening_of(v), {}, {}, {}};
  std::vector<Series> columns{v.scene.spring_mm, v.scene.damper_mm_s};
  Eigen::Index own_at = 2;
  for (const auto& term : v.causes) {
    Columns c = mechanism_at(term.mechanism).columns(v.scene, term.shape);
    if (c.spring.size() > 0) columns[0] += c.spring;
    if (c.damper.size() > 0) columns[1] += c.damper;
    std::vector<double> own;
    for (auto& o : c.own) {
      own.push_back(v.base_fit.value[own_at++]);
      columns.push_back(std::move(o));
    }
    for (auto& t : tangents_of(v.scene, term, own, v.scene.base)) columns.push_back(std::move(t));
  }
  l.model.resize(v.residual_n.size(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    l.white.apply(columns[i]);
    l.model.col(static_cast<Eigen::Index>(i)) = columns[i].matrix();
  }
  Eigen::MatrixXd a = l.model.transpose() * l.model;
  a.diagonal().array() += 1e-10 * a.diagonal().maxCoeff();
  l.solver.compute(a);
  Series r = v.residual_n;
  l.white.apply(r);
  l.residual = r.matrix();
  l.residual -= l.model * l.solver.solve(l.model.transpose() * l.residual);
  return l;
}

struct Gain {
  double chi2 = 0, effect_n = 0;
};

/// Fall of chi² by columns `raw` [rows] fitted to what is left, together with the model.
Gain gain_of(const Left& l, const std::vector<Series>& raw) {
  const auto n = static_cast<Eigen::Index>(raw.size());
  Eigen::MatrixXd b(l.residual.size(), n);
  for (Eigen::Index i = 0; i < n; ++i) {
    Series z = raw[static_cast<std::size_t>(i)];
    l.white.apply(z);
    b.col(i) = z.matrix();
  }
  const Eigen::MatrixXd cross = l.model.transpose() * b;
  Eigen::MatrixXd own = b.transpose() * b;
  const Eigen::VectorXd norm = own.diagonal().cwiseMax(1e-300);
  Eigen::MatrixXd a = own - cross.transpose() * l.solver.solve(cross);
  for (Eigen::Index i = 0; i < n; ++i) a(i, i) += 1e-6 * norm[i];  // what the model spans already stays out
  const Eigen::VectorXd g = b.transpose() * l.residual, x = a.ldlt().solve(g);
  Gain out;
  out.chi2 = g.dot(x);
  if (!std::isfinite(out.chi2)) return {};
  Series f = Series::Zero(raw.front().size());
  for (Eigen::Index i = 0; i < n; ++i) f += x[i] * raw[static_cast<std::size_t>(i)];
  out.effect_n = std::sqrt(f.square().mean());
  return out;
}

/// Piecewise linear curves over quantiles of u, the mean over `where` taken out, times `where`. Empty when u is constant.
std::vector<Series> curve(const Series& u, const Series& where) {
  std::vector<double> sorted;
  const Eigen::Index stride = std::max<Eigen::Index>(1, u.size() / 5000);
  for (Eigen::Index i = 0; i < u.size(); i += stride)
    if (where[i] > 0.0) sorted.push_back(u[i]);
  if (sorted.size() < 50) return {};
  std::sort(sorted.begin(), sorted.end());
  std::vector<double> knots;
  for (int k = 0; k < k_knots; ++k) {
    const double q = quantile_of_sorted(sorted, static_cast<double>(k) / (k_knots - 1));
    if (knots.empty() || q > knots.back() + 1e-9 * (sorted.back() - sorted.front())) knots.push_back(q);
  }
  if (std::vector<double> few = sorted; few.erase(std::unique(few.begin(), few.end()), few.end()), few.size() <= k_knots)
    knots.assign(few.begin(), few.end());
  if (knots.size() < 2) return {};
  std::vector<Series> out(knots.size() - 1, Series::Zero(u.size()));
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    if (where[i] == 0.0) continue;
    const double x = std::clamp(u[i], knots.front(), knots.back());
    const auto at = static_cast<std::size_t>(std::upper_bound(knots.begin() + 1, knots.end() - 1, x) - knots.begin() - 1);
    const double part = (x - knots[at]) / (knots[at + 1] - knots[at]);
    if (at > 0) out[at - 1][i] = 1.0 - part;
    out[at][i] = part;
  }
  const double weight = where.sum();
  for (auto& column : out) column = (column - (column * where).sum() / weight) * where;
  return out;
}

void keep(Structure& best, const Gain& gain, double parameters, const std::string& form) {
  const double value = gain.chi2 - k_parameter_penalty * (parameters - 1.0);
  if (best.form.empty() || value > best.gain) best = {best.variable, form, value, gain.chi2, gain.effect_n};
}

/// A ripple sin(2 pi x/L + phase): the strongest of many L by the score of the residual alone, then fitted.
void ripple(const Left& l, const Series& x, Structure& best) {
  const Scene& s = l.view->scene;
  const double low = x.minCoeff(), range = x.maxCoeff() - low;
  if (!(range > 0.0)) return;
  // score Ω⁻¹ r: whitening and its transpose
  Series score = Series::Zero(x.size());
  const double rho = l.view->noise.rho;
  for (const auto& rows : s.recording->sessions)
    for (Eigen::Index i = rows.begin; i < rows.end; ++i) {
      const double z = l.residual[i] * l.white.root_weight()[i];
      score[i] += z;
      if (i > rows.begin) score[i - 1] -= rho * z;
    }
  const double finest = std::max({range / 200.0, 2.5 * s.motion.quantum_mm, 1e-4});
  constexpr int k_bins = 4096;
  for (const bool contact : {false, true}) {
    std::vector<double> bins(k_bins, 0.0);
    for (Eigen::Index i = 0; i < x.size(); ++i)
      bins[static_cast<std::size_t>((x[i] - low) / range * (k_bins - 1))] += contact ? score[i] * s.active[i] : score[i];
    double most = 0.0, best_f = 0.0;
    for (double f = 2.0 / range; f < 1.0 / finest; f += 0.2 / range) {
      double re = 0.0, im = 0.0, c = 1.0, d = 0.0;
      const double step = 2 * std::numbers::pi * f * range / (k_bins - 1), sc = std::cos(step), ss = std::sin(step);
      for (const double b : bins) {
        re += b * c;
        im += b * d;
        const double next = c * sc - d * ss;
        d = c * ss + d * sc;
        c = next;
      }
      if (re * re + im * im > most) most = re * re + im * im, best_f = f;
    }
    if (best_f == 0.0) continue;
    Series in = (x * (2 * std::numbers::pi * best_f)).sin(), quad = (x * (2 * std::numbers::pi * best_f)).cos();
    if (contact) in *= s.active, quad *= s.active;
    keep(best, gain_of(l, {in, quad}), 3, fmt::format("a ripple of {} mm in position", std::to_string(1.0 / best_f).substr(0, 6)));
  }
}

/// A step that stays to the end (of the recording, or of its session), at the best instant.
void step_in_time(const Left& l, Structure& best) {
  const Recording& r = *l.view->scene.recording;
  Series ones = Series::Ones(r.rows());
  l.white.apply(ones);
  const Eigen::Index p = l.model.cols();
  for (const bool whole : {true, false}) {
    Eigen::VectorXd cross = Eigen::VectorXd::Zero(p);
    double own = 0.0, score = 0.0, most = -1.0;
    Eigen::Index at = -1;
    for (auto s = r.sessions.rbegin(); s != r.sessions.rend(); ++s) {
      if (!whole) cross.setZero(), own = score = 0.0;
      for (Eigen::Index i = s->end - 1; i >= s->begin; --i) {
        if (i > s->begin && (s->end - i) % 20 == 0 && s->end - i > 40 && i - s->begin > 40) {
          const double edge = l.white.root_weight()[i];  // the row of the step itself sees all of it
          const Eigen::VectorXd c = cross + edge * l.model.row(i).transpose();
          const double a = own + edge * edge - c.dot(l.solver.solve(c));
          const double g = score + edge * l.residual[i];
          if (a > 0.01 * own && g * g / a > most) most = g * g / a, at = i;
        }
        cross += ones[i] * l.model.row(i).transpose();
        own += ones[i] * ones[i];
        score += ones[i] * l.residual[i];
      }
    }
    if (at < 0) continue;
    Series step = Series::Zero(r.rows());
    const auto session = std::find_if(r.sessions.begin(), r.sessions.end(), [&](const SessionRows& s) { return at >= s.begin && at < s.end; });
    step.segment(at, (whole ? r.rows() : session->end) - at) = 1.0;
    keep(best, gain_of(l, {step}), 2,
         fmt::format("a step at {} s of session {}{}", std::to_string(r.t_s[at]).substr(0, 6), session->name, whole ? "" : ", until its end"));
  }
}

Series lagged_by(const Recording& r, const Series& u, double lag_s) {
  Series out(u.size());
  for (const auto& rows : r.sessions) {
    Eigen::Index j = rows.begin;
    for (Eigen::Index i = rows.begin; i < rows.end; ++i) {
      while (j + 1 < i && r.t_s[j + 1] <= r.t_s[i] - lag_s) ++j;
      out[i] = u[j];
    }
  }
  return out;
}

}  // namespace

std::vector<Structure> structures(const View& v) {
  const Left l = left_of(v);
  const Recording& r = *v.scene.recording;
  const Series everywhere = Series::Ones(r.rows());
  std::vector<Structure> out;
  const auto curves = [&](Structure& s, const Series& u, bool with_force) {
    if (const auto c = curve(u, everywhere); !c.empty()) keep(s, gain_of(l, c), static_cast<double>(c.size()), "a curve, in air too");
    if (const auto c = curve(u, v.scene.active); !c.empty()) keep(s, gain_of(l, c), static_cast<double>(c.size()), "a curve while in contact");
    if (!with_force) return;
    if (const auto c = curve(u, v.scene.force_n); !c.empty())
      keep(s, gain_of(l, c), static_cast<double>(c.size()), "a curve in proportion to the force");
  };
  const auto add = [&](const std::string& name) -> Structure& {
    out.push_back({name, "", 0, 0, 0});
    return out.back();
  };
  {
    Structure& s = add("t_s");
    curves(s, r.t_s, false);
    step_in_time(l, s);
  }
  if (r.sessions.size() > 1 && r.sessions.size() <= 12) {
    Structure& s = add("session");
    std::vector<Series> offsets, loads;
    for (std::size_t i = 1; i < r.sessions.size(); ++i) {
      Series one = Series::Zero(r.rows());
      one.segment(r.sessions[i].begin, r.sessions[i].end - r.sessions[i].begin) = 1.0;
      offsets.push_back(one);
      loads.push_back(one * v.scene.force_n);
    }
    keep(s, gain_of(l, offsets), static_cast<double>(offsets.size()) + 1, "an offset that differs from session to session");
    keep(s, gain_of(l, loads), static_cast<double>(loads.size()) + 1, "a gain that differs from session to session");
  }
  {
    Structure& s = add("x_mm");
    curves(s, v.scene.motion.x_mm, false);
    ripple(l, v.scene.motion.x_mm, s);
  }
  curves(add("v_mm_s"), v.scene.motion.v_mm_s, false);
  for (const auto& [name, u] : r.columns) {
    if (!(u.maxCoeff() > u.minCoeff())) continue;
    Structure& s = add(name);
    curves(s, u, true);
    if (std::set<double> few(u.data(), u.data() + std::min<Eigen::Index>(u.size(), 2000)); few.size() > 20)
      for (const double lag : k_lags_s)
        keep(s, gain_of(l, {lagged_by(r, u, lag)}), 2, fmt::format("in proportion, {} s later", std::to_string(lag).substr(0, 3)));
  }
  out.erase(std::remove_if(out.begin(), out.end(), [](const Structure& s) { return s.form.empty(); }), out.end());
  return out;
}

}  // namespace cavum::explain
