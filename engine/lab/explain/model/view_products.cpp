#include <algorithm>

#include "engine/base/independent_runs.h"
#include "engine/lab/explain/model/lines.h"
#include "engine/lab/explain/model/view.h"

namespace cavum::explain {
namespace {

/// A term with its whitened columns, numbered from 0.
struct WhiteTerm {
  Hypothesis hypothesis;
  std::vector<Series> columns;
};

/// `apart`: a column for each session, where the mechanism has coefficients for each; else they
/// share columns, for they do not overlap.
WhiteTerm white_term(const View& v, const Whitening& white, const Term& term, bool apart) {
  const Mechanism& m = mechanism_at(term.mechanism);
  Columns c = m.columns(*v.scene, term.shape);
  WhiteTerm out;
  Hypothesis& h = out.hypothesis;
  h.term = term;
  h.repeats =
      m.by_session && !apart ? static_cast<Eigen::Index>(session_groups(*v.scene->recording)) : 1;
  h.own = static_cast<Eigen::Index>(c.own.size()) / h.repeats;
  for (Eigen::Index i = 0; i < h.own; ++i) {
    Series whole = std::move(c.own[static_cast<std::size_t>(i)]);
    for (Eigen::Index s = 1; s < h.repeats; ++s)
      whole += c.own[static_cast<std::size_t>(s * h.own + i)];
    out.columns.push_back(std::move(whole));
  }
  if (c.spring.size() > 0)
    h.spring = static_cast<Eigen::Index>(out.columns.size()),
    out.columns.push_back(std::move(c.spring));
  if (c.damper.size() > 0)
    h.damper = static_cast<Eigen::Index>(out.columns.size()),
    out.columns.push_back(std::move(c.damper));
  for (auto& column : out.columns) white.apply(column);
  return out;
}

Hypothesis put_into(WhiteTable& table, WhiteTerm term, bool exact) {
  Hypothesis h = std::move(term.hypothesis);
  h.first = table.columns();
  if (h.spring >= 0) h.spring += h.first;
  if (h.damper >= 0) h.damper += h.first;
  for (const auto& column : term.columns) exact ? table.add_exact(column) : table.add(column);
  return h;
}

/// What is left of the force, k, c, and the causes with tangents at the coefficients that the base
/// was fitted with. What was taken.
Taken add_known(View& v, const Whitening& white, WhiteTable& table) {
  Taken taken{v.base_fit.value[0], v.base_fit.value[1], {}, {}, {}};
  const auto add = [&](Series column) {
    white.apply(column);
    table.add_exact(column);
  };
  add(*v.force_n - *v.model_n);
  add(v.scene->spring_mm);
  add(v.scene->damper_mm_s);
  const Base base = base_of(v);
  Eigen::Index own_at = 2;
  for (const auto& term : v.causes) {
    Hypothesis h = put_into(table, white_term(v, white, term, true), true);
    std::vector<double> own;
    for (Eigen::Index i = 0; i < h.coefficients(); ++i) {
      own.push_back(v.base_fit.value[own_at++]);
      taken.own.emplace_back(h.first + i, own.back());
    }
    h.tangents = table.columns();
    for (auto& t : tangents_of(*v.scene, term, own, base)) {
      add(std::move(t));
      ++h.tangent_count;
    }
    if (h.spring >= 0) taken.spring.push_back(h.spring);
    if (h.damper >= 0) taken.damper.push_back(h.damper);
    v.known.push_back(h);
  }
  return taken;
}

/// All mechanisms at all points of their grids; a few at a time, for their columns are large.
void add_grid(View& v, const Whitening& white, WhiteTable& table) {
  constexpr std::size_t k_at_a_time = 8;
  std::vector<Term> terms;
  for (std::size_t m = 0; m < mechanisms().size(); ++m)
    for (auto& shape : starts(mechanisms()[m], *v.scene))
      terms.push_back({static_cast<int>(m), std::move(shape)});
  for (std::size_t first = 0; first < terms.size(); first += k_at_a_time) {
    std::vector<WhiteTerm> made(std::min(k_at_a_time, terms.size() - first));
    independent_runs(made.size(), [&](std::size_t i) {
      made[i] = white_term(v, white, terms[first + i], false);
    });
    for (auto& one : made) v.grid.push_back(put_into(table, std::move(one), false));
  }
}

void add_curves(View& v, const Whitening& white, WhiteTable& table) {
  each_curve(*v.scene, [&](Curve curve) {
    const auto count = static_cast<Eigen::Index>(curve.columns.size());
    Eigen::MatrixXd products(count, count);
    for (Eigen::Index i = 0; i < count; ++i)
      for (Eigen::Index j = 0; j < count; ++j)
        products(i, j) = (curve.columns[static_cast<std::size_t>(i)] *
                          curve.columns[static_cast<std::size_t>(j)])
                             .mean();
    v.curves.push_back({std::move(curve.variable), std::move(curve.form), table.columns(), count,
                        std::move(products)});
    for (auto& column : curve.columns) {
      white.apply(column);
      table.add(column);
    }
  });
}

/// Sums of products, by fold, and with the effects of each session within it.
void sum_products(View& v, const Whitening& whitening, Taken taken) {
  const WhiteTable& white = *v.white;
  const Eigen::Index count = white.columns();
  Products p;
  p.tried = narrower_spreads(v.spread);
  p.folds.assign(v.folds.size(), {});
  std::vector<std::vector<SessionProducts>> sessions(v.folds.size());
  independent_runs(v.folds.size(), [&](std::size_t f) {
    const auto [begin, end] = v.folds[f];
    Eigen::MatrixXd& sums = p.folds[f] = Eigen::MatrixXd::Zero(count, count);
    Eigen::MatrixXf part(count, count);
    for (const auto& s : v.scene->recording->sessions) {
      SessionProducts own{std::max(begin, s.begin),
                          std::min(end, s.end),
                          f,
                          Eigen::MatrixXd::Zero(count, k_session_effects),
                          {},
                          {},
                          {}};
      if (own.begin >= own.end) continue;
      for (Eigen::Index at = own.begin; at < own.end; at += k_white_rows) {
        const Eigen::MatrixXf rows = white.rows(at, std::min(k_white_rows, own.end - at));
        part.setZero();
        part.selfadjointView<Eigen::Lower>().rankUpdate(rows.transpose());
        sums.triangularView<Eigen::Lower>() += part.cast<double>();
        own.with_effects +=
            (rows.transpose() * v.white_effects->middleRows(at, rows.rows())).cast<double>();
      }
      const Eigen::MatrixXd effects =
          v.white_effects->middleRows(own.begin, own.end - own.begin).cast<double>();
      own.effects = effects.transpose() * effects;
      sessions[f].push_back(std::move(own));
    }
    sums.triangularView<Eigen::StrictlyUpper>() = sums.transpose();
  });
  for (auto& of_fold : sessions)
    for (auto& s : of_fold) p.sessions.push_back(std::move(s));
  integrate(p);
  set_prior(p, v.scene->recording->rig);
  p.rows = (whitening.root_weight() * v.noise.step_sd_n).square().sum();
  p.taken = std::move(taken);
  Series force = *v.force_n;
  whitening.apply(force);
  p.force_squares = force.square().sum();
  v.products = std::move(p);
}

}  // namespace

std::vector<std::pair<Eigen::Index, Eigen::Index>> folds_of(const Recording& r) {
  std::vector<std::pair<Eigen::Index, Eigen::Index>> out;
  constexpr std::size_t k_most = 12;
  const std::size_t n = r.sessions.size();
  if (n == 1) {
    for (Eigen::Index i = 0; i < 5; ++i) out.emplace_back(r.rows() * i / 5, r.rows() * (i + 1) / 5);
    return out;
  }
  const std::size_t folds = std::min(n, k_most);
  for (std::size_t f = 0; f < folds; ++f)
    out.emplace_back(r.sessions[f * n / folds].begin, r.sessions[(f + 1) * n / folds - 1].end);
  return out;
}

void find_lines(View& v) {
  Scene& scene = v.scene.change();
  scene.left_n = *v.residual_n + *v.session_n;
  Series z = *v.residual_n;
  whitening_of(v).apply(z);
  std::vector<double> known_hz;
  for (const auto& term : v.causes)
    if (const Mechanism& m = mechanism_at(term.mechanism); m.by_session && m.from_residual)
      known_hz.push_back(term.shape[0]);
  scene.lines_hz = strongest_lines_hz(scene, z * scene.active, 2, known_hz);
  scene.lines_in_air_hz = strongest_lines_hz(scene, z, 2, known_hz);
}

void add_products(View& v) {
  auto table = std::make_shared<WhiteTable>();
  const Whitening white = whitening_of(v);
  Taken taken = add_known(v, white, *table);
  add_grid(v, white, *table);
  add_curves(v, white, *table);
  v.white = std::move(table);
  v.folds = folds_of(*v.scene->recording);
  sum_products(v, white, std::move(taken));
}

}  // namespace cavum::explain
