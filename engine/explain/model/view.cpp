#include "engine/explain/model/view.h"

#include <algorithm>
#include <cmath>

#include "engine/explain/model/lines.h"

namespace cavum::explain {
namespace {

constexpr int k_rounds = 4;          // of base, noise and weights in turn; more changed k by less than 1e-4 of itself
constexpr double k_rig_doubt = 0.1;  // relative: rig.toml's k and c count as known to 10 %, which only matters where the data are silent

/// Design matrix of base and causes, raw: force, k, c, own columns of each.
struct Design {
  std::vector<Series> columns;
};

Design design_of(const Scene& scene, const std::vector<Term>& causes) {
  Design d;
  Series spring = scene.spring_mm, damper = scene.damper_mm_s;
  std::vector<Series> own;
  for (const auto& term : causes) {
    Columns c = mechanism_at(term.mechanism).columns(scene, term.shape);
    if (c.spring.size() > 0) spring += c.spring;
    if (c.damper.size() > 0) damper += c.damper;
    for (auto& o : c.own) own.push_back(std::move(o));
  }
  d.columns.push_back(std::move(spring));
  d.columns.push_back(std::move(damper));
  for (auto& o : own) d.columns.push_back(std::move(o));
  return d;
}

void set_prior(Products& p, const Rig& rig) {
  const std::optional<double> given[2] = {rig.k_n_per_mm, rig.c_n_s_per_mm};
  for (int i = 0; i < 2; ++i)
    if (given[i]) {
      p.prior_at[i] = *given[i];
      p.prior[i] = 1.0 / std::pow(std::max(1e-6, k_rig_doubt * *given[i]), 2);
    }
}

/// Adds a session's products under each spread to `sums` (one for each spread; empty at first).
void add_session(std::vector<SpreadSums>& sums, const std::vector<SessionSpread>& spreads, const Eigen::MatrixXd& own,
                 const Eigen::MatrixXd& with_effects, const Eigen::MatrixXd& effects) {
  if (sums.empty()) sums.resize(spreads.size(), {Eigen::MatrixXd::Zero(own.rows(), own.cols()), 0.0});
  for (std::size_t u = 0; u < spreads.size(); ++u) {
    const Integrated one = integrate_out(own, with_effects, effects, spreads[u]);
    sums[u].all += one.sums;
    sums[u].log_det += one.log_det;
  }
}

/// Products of the force and a few columns: force, k, c, own.
Products products_of(const View& v, const Design& design) {
  const Whitening white = whitening_of(v);
  const auto n = static_cast<Eigen::Index>(design.columns.size()) + 1;
  Eigen::MatrixXd z(v.force_n.size(), n);
  for (Eigen::Index i = 0; i < n; ++i) {
    Series column = i == 0 ? v.force_n : design.columns[static_cast<std::size_t>(i - 1)];
    white.apply(column);
    z.col(i) = column.matrix();
  }
  Products p;
  const std::vector<SessionSpread> spreads = narrower_spreads(v.spread);
  const bool alike = spreads.size() == 1;
  if (alike) {
    p.spreads.push_back({z.transpose() * z, 0.0});
  } else {
    for (const auto& s : v.scene.recording->sessions) {
      const auto block = z.middleRows(s.begin, s.end - s.begin);
      const auto effects = v.white_effects.middleRows(s.begin, s.end - s.begin);
      add_session(p.spreads, spreads, block.transpose() * block, block.transpose() * effects, effects.transpose() * effects);
    }
  }
  set_prior(p, v.scene.recording->rig);
  return p;
}

FitResult fit_design(const View& v, const Design& design, bool covariance) {
  const Products p = products_of(v, design);
  Hypothesis rest;
  rest.term.mechanism = 0;
  rest.first = 3;
  rest.own = static_cast<Eigen::Index>(design.columns.size()) - 2;
  return fit(p, rest.own > 0 ? std::vector<const Hypothesis*>{&rest} : std::vector<const Hypothesis*>{}, -1, covariance);
}

Series combined(const Design& d, const Eigen::VectorXd& value) {
  Series out = Series::Zero(d.columns.front().size());
  for (std::size_t i = 0; i < d.columns.size(); ++i) out += value[static_cast<Eigen::Index>(i)] * d.columns[i];
  return out;
}

/// Force of the base and of those causes that act inside the contact, as if it could pull, [rows].
Series pressed_n(const Scene& scene, const std::vector<Term>& causes, const Eigen::VectorXd& value) {
  Scene open = scene;
  never_pull(open, nullptr);
  Series f = value[0] * open.spring_mm + value[1] * open.damper_mm_s;
  Eigen::Index at = 2;
  for (const auto& term : causes) {
    const Mechanism& m = mechanism_at(term.mechanism);
    const Columns c = m.columns(open, term.shape);
    if (m.inside) {
      for (std::size_t i = 0; i < c.own.size(); ++i) f += value[at + static_cast<Eigen::Index>(i)] * c.own[i];
      if (c.spring.size() > 0) f += value[0] * c.spring;
      if (c.damper.size() > 0) f += value[1] * c.damper;
    }
    at += static_cast<Eigen::Index>(c.own.size());
  }
  return f;
}

bool any_inside(const std::vector<Term>& causes) {
  return std::any_of(causes.begin(), causes.end(), [](const Term& t) { return mechanism_at(t.mechanism).inside; });
}

void whiten_effects(View& v) {
  const Whitening white = whitening_of(v);
  const bool any = !v.causes.empty() && v.model_n.size() > 0;
  v.effects = session_columns(
      v.scene, any ? Series(v.model_n - v.base_fit.value[0] * v.scene.spring_mm - v.base_fit.value[1] * v.scene.damper_mm_s) : Series());
  v.white_effects.resize(v.effects.rows(), v.effects.cols());
  for (Eigen::Index e = 0; e < v.effects.cols(); ++e) {
    Series column = v.effects.col(e).array();
    white.apply(column);
    v.white_effects.col(e) = column.matrix();
  }
}

/// Base, noise, sessions and weights in turn, with the causes at their shapes. The base that came out.
Base fit_in_turn(View& v, const Recording& recording, const Motion& motion, Base base) {
  double noise_sd = 0.0;
  Series pressed;
  v.session_n = Series::Zero(recording.rows());
  for (int round = 0; round < k_rounds; ++round) {
    v.scene = make_scene(recording, motion, base, noise_sd, v.noise.rho, pressed.size() > 0 ? &pressed : nullptr);
    if (!(v.noise.step_sd_n > 0.0)) v.noise = {0.0, 1.0, 1.0, {}};
    whiten_effects(v);
    const Design d = design_of(v.scene, v.causes);
    v.base_fit = fit_design(v, d, false);
    v.model_n = combined(d, v.base_fit.value);
    const Series left = v.force_n - v.model_n;
    base = {std::max(1e-9, v.base_fit.value[0]),
            std::max(0.0, v.base_fit.value[1])};  // a damper that pushes is an offset in disguise: no contact is lost by it
    v.noise = estimate_noise(recording, left - v.session_n, v.scene.weight);
    noise_sd = v.noise.sd_n;
    if (any_inside(v.causes)) pressed = pressed_n(v.scene, v.causes, v.base_fit.value);
    v.robust.resize(0);
    Series z = left - v.session_n;
    whitening_of(v).apply(z);
    v.robust = robust_weights(z);
    whiten_effects(v);
    z = left;
    whitening_of(v).apply(z);
    v.spread = estimate_spread(recording, v.white_effects, z);
    v.session_n = session_force_n(recording, v.effects, v.white_effects, z, v.spread);
    v.residual_n = left - v.session_n;
  }
  return base;
}

/// Columns of the products, whitened, one after the other.
class WhiteColumns {
 public:
  explicit WhiteColumns(const View& v) : view_(v), white_(whitening_of(v)) {
    add(v.force_n);
    add(v.scene.spring_mm);
    add(v.scene.damper_mm_s);
  }
  [[nodiscard]] Eigen::Index count() const { return static_cast<Eigen::Index>(columns_.size()); }
  [[nodiscard]] std::shared_ptr<const Eigen::MatrixXf> matrix() {
    auto out = std::make_shared<Eigen::MatrixXf>(view_.force_n.size(), count());
    for (Eigen::Index c = 0; c < out->cols(); ++c) {
      out->col(c) = columns_[static_cast<std::size_t>(c)].matrix();
      columns_[static_cast<std::size_t>(c)].resize(0);
    }
    return out;
  }

  Eigen::Index add(Series column) {
    white_.apply(column);
    columns_.emplace_back(column.cast<float>());
    return count() - 1;
  }

  /// `apart`: a column for each session, where the mechanism has coefficients for each; else they share columns, for they do not overlap.
  Hypothesis add_term(const Term& term, bool apart) {
    const Mechanism& m = mechanism_at(term.mechanism);
    Columns c = m.columns(view_.scene, term.shape);
    Hypothesis h;
    h.term = term;
    h.first = count();
    h.repeats = m.by_session && !apart ? static_cast<Eigen::Index>(session_groups(*view_.scene.recording)) : 1;
    h.own = static_cast<Eigen::Index>(c.own.size()) / h.repeats;
    for (Eigen::Index i = 0; i < h.own; ++i) {
      Series whole = std::move(c.own[static_cast<std::size_t>(i)]);
      for (Eigen::Index s = 1; s < h.repeats; ++s) whole += c.own[static_cast<std::size_t>(s * h.own + i)];
      add(std::move(whole));
    }
    if (c.spring.size() > 0) h.spring = add(std::move(c.spring));
    if (c.damper.size() > 0) h.damper = add(std::move(c.damper));
    return h;
  }

 private:
  const View& view_;
  Whitening white_;
  std::vector<Eigen::ArrayXf> columns_;
};

/// The causes, with tangents at the coefficients that the base was fitted with.
void add_known(View& v, WhiteColumns& columns, Base base) {
  Eigen::Index own_at = 2;
  for (const auto& term : v.causes) {
    Hypothesis h = columns.add_term(term, true);
    std::vector<double> own;
    for (Eigen::Index i = 0; i < h.coefficients(); ++i) own.push_back(v.base_fit.value[own_at++]);
    h.tangents = columns.count();
    for (auto& t : tangents_of(v.scene, term, own, base)) {
      columns.add(std::move(t));
      ++h.tangent_count;
    }
    v.known.push_back(h);
  }
}

/// Rows [begin, end) of whitened columns, times one another.
Eigen::MatrixXd products_between(const Eigen::MatrixXf& columns, Eigen::Index begin, Eigen::Index end) {
  const Eigen::Index count = columns.cols();
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(count, count);
  constexpr Eigen::Index k_block = 512;  // rows that single precision sums up
  for (Eigen::Index at = begin; at < end; at += k_block) {
    Eigen::MatrixXf part = Eigen::MatrixXf::Zero(count, count);
    part.selfadjointView<Eigen::Lower>().rankUpdate(columns.middleRows(at, std::min(k_block, end - at)).transpose());
    sums.triangularView<Eigen::Lower>() += part.cast<double>();
  }
  sums.triangularView<Eigen::StrictlyUpper>() = sums.transpose();
  return sums;
}

/// Sums of products, session by session within each fold, and all together.
void sum_products(View& v) {
  const std::vector<SessionSpread> spreads = narrower_spreads(v.spread);
  for (const auto& [begin, end] : v.folds) {
    std::vector<SpreadSums> fold;
    for (const auto& s : v.scene.recording->sessions) {
      SessionProducts own{std::max(begin, s.begin), std::min(end, s.end), {}, {}};
      if (own.begin >= own.end) continue;
      const auto effects = v.white_effects.middleRows(own.begin, own.end - own.begin);
      own.effects = effects.transpose() * effects;
      own.with_effects = (v.white->middleRows(own.begin, own.end - own.begin).transpose() * effects.cast<float>()).cast<double>();
      add_session(fold, spreads, products_between(*v.white, own.begin, own.end), own.with_effects, own.effects);
      v.by_session.push_back(std::move(own));
    }
    if (v.products.spreads.empty()) v.products.spreads.resize(spreads.size(), {Eigen::MatrixXd::Zero(v.white->cols(), v.white->cols()), 0.0});
    for (std::size_t u = 0; u < spreads.size(); ++u) {
      v.products.spreads[u].all += fold[u].all;
      v.products.spreads[u].log_det += fold[u].log_det;
    }
    v.products.folds.push_back(std::move(fold));
  }
}

}  // namespace

View without_pulling(const View& view, const std::vector<Term>& causes) {
  View v = view;
  const Series pressed = pressed_n(v.scene, causes, fit_terms(v, causes).value);
  never_pull(v.scene, &pressed);
  return v;
}

Series force_of(const Scene& scene, const std::vector<Term>& causes, const Eigen::VectorXd& value) {
  return combined(design_of(scene, causes), value);
}

Whitening whitening_of(const View& v) { return {*v.scene.recording, v.noise, v.scene.weight, v.robust}; }

FitResult fit_terms(const View& v, const std::vector<Term>& causes, bool covariance) { return fit_design(v, design_of(v.scene, causes), covariance); }

std::vector<Series> tangents_of(const Scene& scene, const Term& term, const std::vector<double>& own, Base base) {
  const Mechanism& m = mechanism_at(term.mechanism);
  const auto force = [&](const std::vector<double>& shape) {
    const Columns c = m.columns(scene, shape);
    Series f = Series::Zero(scene.force_n.size());
    for (std::size_t i = 0; i < c.own.size() && i < own.size(); ++i) f += own[i] * c.own[i];
    if (c.spring.size() > 0) f += base.k_n_per_mm * c.spring;
    if (c.damper.size() > 0) f += base.c_n_s_per_mm * c.damper;
    return f;
  };
  std::vector<Series> out;
  for (std::size_t i = 0; i < m.shape.size(); ++i) {
    if (!m.shape[i].fitted || term.shape[i] == 0.0) continue;
    const double step = m.shape[i].logarithmic ? 0.02 * term.shape[i] : 0.01 * std::max(0.1, std::fabs(term.shape[i]));
    const std::string name = m.shape[i].name;
    const double real_step = name == "frequency_hz" ? 1e-3 : name == "rate_ratio" ? 3e-6 : step;
    auto up = term.shape, down = term.shape;
    up[i] += real_step;
    down[i] -= real_step;
    out.push_back((force(up) - force(down)) / (2 * real_step));
  }
  return out;
}

std::vector<std::pair<Eigen::Index, Eigen::Index>> folds_of(const Recording& r) {
  std::vector<std::pair<Eigen::Index, Eigen::Index>> out;
  constexpr std::size_t k_most = 12;
  const std::size_t n = r.sessions.size();
  if (n == 1) {
    for (Eigen::Index i = 0; i < 5; ++i) out.emplace_back(r.rows() * i / 5, r.rows() * (i + 1) / 5);
    return out;
  }
  const std::size_t folds = std::min(n, k_most);
  for (std::size_t f = 0; f < folds; ++f) out.emplace_back(r.sessions[f * n / folds].begin, r.sessions[(f + 1) * n / folds - 1].end);
  return out;
}

View make_view(const Recording& recording, const Motion& motion, const std::vector<Term>& causes, std::optional<Base> start,
               const ViewOptions& options) {
  View v;
  v.causes = causes;
  v.force_n = options.fixed_n != nullptr ? Series(recording.f_n - *options.fixed_n) : recording.f_n;
  Base base;
  if (start) {
    base = *start;
  } else if (recording.rig.k_n_per_mm) {
    base = {*recording.rig.k_n_per_mm, recording.rig.c_n_s_per_mm.value_or(0.0)};
  }
  base = fit_in_turn(v, recording, motion, base);
  if (!options.products) return v;

  v.scene.left_n = v.residual_n + v.session_n;
  Series z = v.residual_n;
  whitening_of(v).apply(z);
  std::vector<double> known_hz;
  for (const auto& term : causes)
    if (const Mechanism& m = mechanism_at(term.mechanism); m.by_session && m.from_residual) known_hz.push_back(term.shape[0]);
  v.scene.lines_hz = strongest_lines_hz(v.scene, z * v.scene.active, 2, known_hz);
  v.scene.lines_in_air_hz = strongest_lines_hz(v.scene, z, 2, known_hz);
  WhiteColumns columns(v);
  add_known(v, columns, base);
  for (std::size_t m = 0; m < mechanisms().size(); ++m)
    for (auto& shape : starts(mechanisms()[m], v.scene)) v.grid.push_back(columns.add_term({static_cast<int>(m), std::move(shape)}, false));
  for (auto& curve : curves_of(v.scene)) {
    const auto count = static_cast<Eigen::Index>(curve.columns.size());
    Eigen::MatrixXd raw(recording.rows(), count);
    for (Eigen::Index i = 0; i < count; ++i) raw.col(i) = curve.columns[static_cast<std::size_t>(i)].matrix();
    v.curves.push_back({curve.variable, curve.form, columns.count(), count, raw.transpose() * raw / static_cast<double>(recording.rows())});
    for (auto& c : curve.columns) columns.add(std::move(c));
  }
  v.white = columns.matrix();
  set_prior(v.products, recording.rig);
  v.products.rows = (whitening_of(v).root_weight() * v.noise.step_sd_n).square().sum();
  v.folds = folds_of(recording);
  sum_products(v);
  return v;
}

}  // namespace cavum::explain
