#include "engine/lab/explain/model/view.h"

#include <algorithm>
#include <cmath>

#include "engine/base/independent_runs.h"
#include "engine/lab/explain/model/lines.h"
#include "engine/lab/explain/model/term_fits.h"

namespace cavum::explain {
namespace {

constexpr int k_rounds =
    4;  // of base, noise and weights in turn; more changed k by less than 1e-4 of itself

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

Series combined(const Design& d, const Eigen::VectorXd& value) {
  Series out = Series::Zero(d.columns.front().size());
  for (std::size_t i = 0; i < d.columns.size(); ++i)
    out += value[static_cast<Eigen::Index>(i)] * d.columns[i];
  return out;
}

/// Force of the base and of those causes that act inside the contact, as if it could pull, [rows].
Series pressed_n(const Scene& scene, const std::vector<Term>& causes,
                 const Eigen::VectorXd& value) {
  Scene open = scene;
  never_pull(open, nullptr);
  Series f = value[0] * open.spring_mm + value[1] * open.damper_mm_s;
  Eigen::Index at = 2;
  for (const auto& term : causes) {
    const Mechanism& m = mechanism_at(term.mechanism);
    const Columns c = m.columns(open, term.shape);
    if (m.inside) {
      for (std::size_t i = 0; i < c.own.size(); ++i)
        f += value[at + static_cast<Eigen::Index>(i)] * c.own[i];
      if (c.spring.size() > 0) f += value[0] * c.spring;
      if (c.damper.size() > 0) f += value[1] * c.damper;
    }
    at += static_cast<Eigen::Index>(c.own.size());
  }
  return f;
}

bool any_inside(const std::vector<Term>& causes) {
  return std::any_of(causes.begin(), causes.end(),
                     [](const Term& t) { return mechanism_at(t.mechanism).inside; });
}

void whiten_effects(View& v) {
  const Whitening white = whitening_of(v);
  const bool any = !v.causes.empty() && v.model_n->size() > 0;
  EffectColumns raw =
      session_columns(*v.scene, any ? Series(*v.model_n - v.base_fit.value[0] * v.scene->spring_mm -
                                             v.base_fit.value[1] * v.scene->damper_mm_s)
                                    : Series());
  EffectColumns whitened(raw.rows(), raw.cols());
  for (Eigen::Index e = 0; e < raw.cols(); ++e) {
    Series column = raw.col(e).cast<double>().array();
    white.apply(column);
    whitened.col(e) = column.cast<float>().matrix();
  }
  v.effects = std::move(raw);
  v.white_effects = std::move(whitened);
}

/// Force that is left, whitened, and what of it the sessions differ by.
Series session_part(const View& v, const Recording& recording, const Series& left,
                    SessionSpread* found) {
  Series z = left;
  whitening_of(v).apply(z);
  if (found != nullptr) *found = estimate_spread(recording, *v.white_effects, z);
  return session_force_n(recording, *v.effects, *v.white_effects, z,
                         found != nullptr ? *found : v.spread);
}

/// Variance of what `causes` add to k and c over the motions that the recording leaves possible,
/// [rows]. Averaged over neighbouring rows, for few motions are drawn.
Series variance_n2(const View& v, const std::vector<Term>& causes, const Eigen::VectorXd& value) {
  constexpr Eigen::Index k_beside = 2;  // rows on each side
  const Motion& m = *v.scene->motion;
  const auto causes_n = [&](const Scene& scene) {
    return Series(force_of(scene, causes, value) - value[0] * scene.spring_mm -
                  value[1] * scene.damper_mm_s);
  };
  const Series expected = causes_n(*v.scene);
  Series sum = Series::Zero(expected.size());
  for (const auto& [x, speed] : m.possible) {
    Motion one = m;
    one.x_mm = x, one.v_mm_s = speed;
    one.sd_x_mm.setZero(), one.sd_v_mm_s.setZero();
    Scene scene = *v.scene;
    scene.motion = std::move(one);
    sum += (causes_n(scene) - expected).square() / static_cast<double>(m.possible.size());
  }
  Series out = sum;
  for (const auto& s : v.scene->recording->sessions)
    for (Eigen::Index i = s.begin; i < s.end; ++i) {
      const Eigen::Index from = std::max(s.begin, i - k_beside),
                         to = std::min(s.end - 1, i + k_beside);
      out[i] = sum.segment(from, to - from + 1).mean();
    }
  return out;
}

/// What the position leaves open in the force, [rows]: of the causes, and of a dry friction that
/// may be there. At a reversal and in a hold its side is open, whatever has been named; rows judged
/// by what was named first would speak for it. Its size is that of the width that fits best, its
/// width the least of the grid.
Series uncertain_n2(const View& v) {
  const int friction = known_mechanism("coulomb_friction");
  TermFits fits(v);
  std::vector<Term> sharp;
  Eigen::VectorXd value;
  double least = 1e300;
  for (const auto& shape : mechanism_at(friction).grid(*v.scene)) {
    const FitResult fit = fits.fit({{friction, shape}});
    if (sharp.empty()) sharp = {{friction, shape}};
    if (fit.value[2] > 0.0 && fit.chi2 < least) least = fit.chi2, value = fit.value;
  }
  const Series open = value.size() > 0 ? variance_n2(v, sharp, value)
                                       : Series(Series::Zero(v.scene->force_n.size()));
  return v.causes.empty() ? open : Series(open.max(variance_n2(v, v.causes, v.base_fit.value)));
}

/// Base, noise, sessions and weights in turn, with the causes at their shapes.
void fit_in_turn(View& v, const Recording& recording, const Shared<Motion>& motion, Base base) {
  double noise_sd = 0.0;
  Series pressed, uncertain;
  for (int round = 0; round < k_rounds; ++round) {
    v.scene = make_scene(recording, motion, base, noise_sd, v.noise.rho,
                         pressed.size() > 0 ? &pressed : nullptr,
                         uncertain.size() > 0 ? &uncertain : nullptr);
    if (!(v.noise.step_sd_n > 0.0)) v.noise = {0.0, 1.0, 1.0, {}};
    whiten_effects(v);
    v.base_fit = TermFits(v).fit(v.causes);
    v.model_n = force_of(*v.scene, v.causes, v.base_fit.value);
    const Series left = *v.force_n - *v.model_n;
    const Series beside =
        left - session_part(v, recording, left, nullptr);  // the sessions beside the new base
    base = base_of(v);
    v.noise = estimate_noise(recording, beside, v.scene->weight);
    noise_sd = v.noise.sd_n;
    if (!motion->possible.empty()) uncertain = uncertain_n2(v);
    if (any_inside(v.causes)) pressed = pressed_n(*v.scene, v.causes, v.base_fit.value);
    v.robust = Series();
    Series z = beside;
    whitening_of(v).apply(z);
    v.robust = robust_weights(z);
    whiten_effects(v);
    v.session_n = session_part(v, recording, left, &v.spread);
    v.residual_n = Series(left - *v.session_n);
  }
}

}  // namespace

View without_pulling(const View& view, const std::vector<Term>& causes) {
  View v = view;
  const Series pressed = pressed_n(*v.scene, causes, TermFits(v).fit(causes).value);
  never_pull(v.scene.change(), &pressed);
  return v;
}

Series force_of(const Scene& scene, const std::vector<Term>& causes, const Eigen::VectorXd& value) {
  return combined(design_of(scene, causes), value);
}

Whitening whitening_of(const View& v) {
  return {*v.scene->recording, v.noise, v.scene->weight, *v.robust};
}

std::vector<Series> tangents_of(const Scene& scene, const Term& term,
                                const std::vector<double>& own, Base base) {
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
    const double step = m.shape[i].logarithmic ? 0.02 * term.shape[i]
                                               : 0.01 * std::max(0.1, std::fabs(term.shape[i]));
    const std::string name = m.shape[i].name;
    const double real_step = name == "frequency_hz" ? 1e-3 : name == "rate_ratio" ? 3e-6 : step;
    auto up = term.shape, down = term.shape;
    up[i] += real_step;
    down[i] -= real_step;
    out.push_back((force(up) - force(down)) / (2 * real_step));
  }
  return out;
}

View make_view(const Recording& recording, const Shared<Motion>& motion,
               const std::vector<Term>& causes, const Series* fixed_n) {
  View v;
  v.causes = causes;
  v.force_n = fixed_n != nullptr ? Series(recording.f_n - *fixed_n) : recording.f_n;
  Base start;  // else found from the data
  if (recording.rig.k_n_per_mm)
    start = {*recording.rig.k_n_per_mm, recording.rig.c_n_s_per_mm.value_or(0.0)};
  fit_in_turn(v, recording, motion, start);
  return v;
}

}  // namespace cavum::explain
