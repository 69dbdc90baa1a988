#include "engine/lab/explain/inference/search.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <string>

#include "engine/base/order.h"
#include "engine/lab/explain/model/lines.h"

namespace cavum::explain {
namespace {

constexpr double k_testable =
    0.05;  // of a column's norm left beside k and c, docs/physics.md section 13
constexpr double k_scales[] = {0.04, 0.12, 0.3, 0.55, 0.8, 1.0, 1.3};
constexpr double k_plain_trials = 200.0;  // hypotheses of the grids and curves, about
constexpr double k_noise_gain =
    3.0;  // what the best of a mechanism's grid gains in noise alone, about

/// Share of the norm of `h`'s force that k and c cannot take over.
double share_left(const View& v, const Hypothesis& h) {
  const Eigen::MatrixXd& g =
      v.products->spreads.back().all;  // what sessions differ in takes no one's place
  const auto share = [&](auto product, double norm2) {
    // residual of a column on columns 1 and 2
    const double a = g(1, 1), b = g(1, 2), c = g(2, 2), p = product(1), q = product(2);
    const double det = a * c - b * b;
    const double taken = det > 1e-9 * a * c ? (c * p * p - 2 * b * p * q + a * q * q) / det
                         : a > 0.0          ? p * p / a
                                            : 0.0;
    return norm2 > 0.0 ? std::sqrt(std::max(0.0, norm2 - taken) / norm2) : 0.0;
  };
  double best = 0.0;
  for (Eigen::Index i = 0; i < h.own; ++i) {
    const Eigen::Index c = h.first + i;
    best = std::max(best, share([&](Eigen::Index r) { return g(r, c); }, g(c, c)));
  }
  if (h.spring >= 0 || h.damper >= 0) {
    const double k = v.base_fit.value[0], cc = v.base_fit.value[1];
    const auto product = [&](Eigen::Index r) {
      return (h.spring >= 0 ? k * g(r, h.spring) : 0.0) +
             (h.damper >= 0 ? cc * g(r, h.damper) : 0.0);
    };
    const double norm2 = (h.spring >= 0 ? k * product(h.spring) : 0.0) +
                         (h.damper >= 0 ? cc * product(h.damper) : 0.0);
    best = std::max(best, share(product, norm2));
  }
  return best;
}

/// Columns of the products that a parameter sums up, with their factors.
using Direction = std::vector<std::pair<Eigen::Index, double>>;

/// k, c, the causes' coefficients and tangents.
std::vector<Direction> directions_of_model(const View& v) {
  std::vector<Direction> out{{{1, 1.0}}, {{2, 1.0}}};
  for (const auto& h : v.known) {
    if (h.spring >= 0) out[0].emplace_back(h.spring, 1.0);
    if (h.damper >= 0) out[1].emplace_back(h.damper, 1.0);
    for (Eigen::Index i = 0; i < h.own; ++i) out.push_back({{h.first + i, 1.0}});
  }
  for (const auto& h : v.known)
    for (Eigen::Index i = 0; i < h.tangent_count; ++i) out.push_back({{h.tangents + i, 1.0}});
  return out;
}

/// What a hypothesis adds, to first order: its own columns, and what it changes in those of k and
/// c.
std::vector<Direction> directions_of(const View& v, const Hypothesis& h) {
  std::vector<Direction> out;
  for (Eigen::Index i = 0; i < h.own; ++i) out.push_back({{h.first + i, 1.0}});
  if (h.spring >= 0 || h.damper >= 0) {
    Direction change;
    if (h.spring >= 0) change.emplace_back(h.spring, v.base_fit.value[0]);
    if (h.damper >= 0) change.emplace_back(h.damper, v.base_fit.value[1]);
    out.push_back(std::move(change));
  }
  return out;
}

Eigen::MatrixXd as_matrix(const std::vector<Direction>& directions, Eigen::Index columns) {
  Eigen::MatrixXd out =
      Eigen::MatrixXd::Zero(columns, static_cast<Eigen::Index>(directions.size()));
  for (std::size_t i = 0; i < directions.size(); ++i)
    for (const auto& [column, factor] : directions[i])
      out(column, static_cast<Eigen::Index>(i)) += factor;
  return out;
}

/// The model's part taken out of all columns and forces, under one spread.
struct Beside {
  Eigen::MatrixXd columns;   ///< [columns, columns]
  Eigen::MatrixXd observed;  ///< [columns, recordings]
  Eigen::VectorXd left;      ///< -2 log likelihood of the model alone, [recordings]
  Eigen::MatrixXd moved;     ///< the model's parameters, [parameters, recordings]
};

Beside adjacent_model(const View& v, const Eigen::MatrixXd& model, const SpreadSums& sums,
                      const Eigen::MatrixXd& observed, const Eigen::VectorXd& squares,
                      bool with_prior) {
  const Eigen::MatrixXd with = sums.all * model;  // [columns, parameters]
  Eigen::MatrixXd own = model.transpose() * with;
  Eigen::MatrixXd b = model.transpose() * observed;
  Eigen::VectorXd squared = squares;
  for (Eigen::Index i = 0; i < 2; ++i) {
    own(i, i) += v.products->prior[i];
    if (!with_prior) continue;  // a surrogate has the base that it was made with
    const double at = v.products->prior_at[i] -
                      (i == 0 ? v.products->taken.k_n_per_mm : v.products->taken.c_n_s_per_mm);
    b.row(i).array() += v.products->prior[i] * at;
    squared.array() += v.products->prior[i] * at * at;
  }
  const Eigen::VectorXd scale = own.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd scaled = scale.asDiagonal() * own * scale.asDiagonal();
  scaled.diagonal().array() += 1e-10;
  const Eigen::LDLT<Eigen::MatrixXd> solver(scaled);
  Beside out;
  out.moved = scale.asDiagonal() * solver.solve(scale.asDiagonal() * b);
  out.observed = observed - with * out.moved;
  out.left = squared - b.cwiseProduct(out.moved).colwise().sum().transpose();
  out.left.array() += sums.log_det;
  out.columns =
      sums.all - with * (scale.asDiagonal() * solver.solve(scale.asDiagonal() * with.transpose()));
  return out;
}

/// Fall of chi² by a group of directions. A single one, or those of a mechanism with a range, must
/// point the way that makes sense: `one_sided`.
Eigen::VectorXd gains_of(const Beside& u, const std::vector<Direction>& group, bool one_sided) {
  const auto n = static_cast<Eigen::Index>(group.size());
  Eigen::MatrixXd own = Eigen::MatrixXd::Zero(n, n),
                  b = Eigen::MatrixXd::Zero(n, u.observed.cols());
  for (Eigen::Index i = 0; i < n; ++i)
    for (const auto& [column, factor] : group[static_cast<std::size_t>(i)]) {
      b.row(i) += factor * u.observed.row(column);
      for (Eigen::Index j = 0; j < n; ++j)
        for (const auto& [other, times] : group[static_cast<std::size_t>(j)])
          own(i, j) += factor * times * u.columns(column, other);
    }
  own.diagonal() *= 1.0 + 1e-9;
  own.diagonal().array() += 1e-12;
  const Eigen::MatrixXd x = own.ldlt().solve(b);
  Eigen::VectorXd gain = b.cwiseProduct(x).colwise().sum().transpose().cwiseMax(0.0);
  if (one_sided)
    for (Eigen::Index i = 0; i < gain.size(); ++i)
      if (x.col(i).minCoeff() <= 0.0) gain[i] = 0.0;
  return gain.unaryExpr([](double g) { return std::isfinite(g) ? g : 0.0; });
}

/// What surrogates gain by a mechanism that these data can show: the middle of all, for one that
/// goes with the residual's own spectrum gains far more.
double usual_gain(const Null& null) {
  std::vector<double> gains;
  for (std::size_t m = 0; m < mechanisms().size(); ++m)
    if (const double gain = null.mean[static_cast<Eigen::Index>(m)]; gain > 0.0)
      gains.push_back(gain);
  return gains.empty() ? 0.0 : median(std::move(gains));
}

}  // namespace

Eigen::Index parameters_of(const Term& term, const Scene& scene) {
  const Mechanism& m = mechanism_at(term.mechanism);
  auto n = static_cast<Eigen::Index>(m.columns(scene, term.shape).own.size());
  if (const auto groups = static_cast<Eigen::Index>(session_groups(*scene.recording)); m.by_session)
    n = n / groups + groups - 1;
  for (std::size_t i = 0; i < m.shape.size(); ++i) n += m.shape[i].fitted && term.shape[i] != 0.0;
  return n;
}

std::vector<Candidate> candidates_of(const View& v, int left_out) {
  std::vector<Candidate> out(mechanisms().size());
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i].hypothesis.term.mechanism = static_cast<int>(i), out[i].testable = false;
  const std::vector<SpreadSums> sums = sums_without(*v.products, left_out);
  std::vector<const Hypothesis*> model = known_of(v);
  const bool one_way = moves_one_way(*v.scene->motion);
  const double before = fit(sums, *v.products, model, left_out).chi2;
  Eigen::Index own_at = 2;  // of the candidate, after the causes' own coefficients
  for (const auto* h : model) own_at += h->coefficients();
  model.push_back(nullptr);
  for (const auto& h : v.grid) {
    Candidate& c = out[static_cast<std::size_t>(h.term.mechanism)];
    // an offset in one direction is c in other words, but no other cause may be named for want of
    // it
    const bool offset = one_way && mechanism_at(h.term.mechanism).one_way == OneWay::is_offset;
    if (!offset && share_left(v, h) < k_testable) continue;
    c.testable = true;
    if (std::any_of(v.causes.begin(), v.causes.end(),
                    [&](const Term& t) { return law_of(t.mechanism) == law_of(h.term.mechanism); }))
      continue;
    const bool changes = h.spring >= 0 || h.damper >= 0;
    for (const double scale : k_scales) {
      if (!changes && scale != 1.0) continue;
      Hypothesis trial = h;
      trial.scale = scale;
      model.back() = &trial;
      const FitResult f = fit(sums, *v.products, model, left_out);
      if (!makes_sense(mechanism_at(h.term.mechanism), f.value.data() + own_at,
                       static_cast<std::size_t>(h.coefficients())))
        continue;
      const double gain =
          before - f.chi2 - k_parameter_penalty * static_cast<double>(h.parameters() - 1);
      if (gain > c.gain) {
        c.gain = gain;
        c.raw_gain = before - f.chi2;
        c.hypothesis = trial;
      }
    }
  }
  return out;
}

Scores scores_of(const View& view) { return {candidates_of(view), structures(view)}; }

double best_pair_gain(const View& v, const std::vector<Candidate>& candidates) {
  std::vector<const Hypothesis*> model = known_of(v);
  const double before = fit(*v.products, model).chi2;
  const std::size_t n = model.size();
  model.resize(n + 2);
  double best = -1e300;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      if (candidates[i].gain < 0.0 || candidates[j].gain < 0.0) continue;
      model[n] = &candidates[i].hypothesis;
      model[n + 1] = &candidates[j].hypothesis;
      const auto extra =
          static_cast<double>(model[n]->parameters() + model[n + 1]->parameters() - 1);
      best = std::max(best, before - fit(*v.products, model).chi2 - k_parameter_penalty * extra);
    }
  return best;
}

std::size_t Entries::count() const { return mechanisms().size() + variables.size(); }
std::size_t Entries::of_variable(const std::string& name) const {
  return mechanisms().size() +
         static_cast<std::size_t>(std::find(variables.begin(), variables.end(), name) -
                                  variables.begin());
}

Entries entries_of(const View& v) {
  Entries out;
  for (const auto& c : v.curves)
    if (out.variables.empty() || out.variables.back() != c.variable)
      out.variables.push_back(c.variable);
  return out;
}

Eigen::MatrixXd score_gains(const View& v, const std::vector<SpreadSums>& sums,
                            const Observed& observed) {
  const Entries entries = entries_of(v);
  const Eigen::Index recordings = observed.with_columns.front().cols(),
                     columns = sums.front().all.rows();
  const bool is_data = recordings == 1;
  const Eigen::MatrixXd model = as_matrix(directions_of_model(v), columns);
  std::vector<Beside> under;
  for (std::size_t u = 0; u < sums.size(); ++u)
    under.push_back(
        adjacent_model(v, model, sums[u], observed.with_columns[u], observed.squares[u], is_data));
  Eigen::VectorXd alone = under.front().left;
  for (const auto& u : under) alone = alone.cwiseMin(u.left);
  Eigen::MatrixXd out =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(entries.count()), recordings);
  const auto keep = [&](std::size_t entry, const std::vector<Direction>& group, bool one_sided) {
    for (const auto& u : under) {
      auto row = out.row(static_cast<Eigen::Index>(entry));
      row = row.cwiseMax((alone - u.left + gains_of(u, group, one_sided)).transpose());
    }
  };
  const bool one_way = moves_one_way(*v.scene->motion);
  for (const auto& h : v.grid) {
    const Mechanism& m = mechanism_at(h.term.mechanism);
    if (m.by_session) continue;  // lines are judged by their neighbours in frequency
    const bool offset = one_way && m.one_way == OneWay::is_offset;
    if (!offset && share_left(v, h) < k_testable) continue;
    if (std::any_of(v.causes.begin(), v.causes.end(),
                    [&](const Term& t) { return law_of(t.mechanism) == law_of(h.term.mechanism); }))
      continue;
    const auto group = directions_of(v, h);
    keep(static_cast<std::size_t>(h.term.mechanism), group,
         m.own.low == 0.0 || (h.own == 0 && group.size() == 1));
  }
  for (const auto& c : v.curves) {
    std::vector<Direction> group;
    for (Eigen::Index i = 0; i < c.count; ++i) group.push_back({{c.first + i, 1.0}});
    keep(entries.of_variable(c.variable), group, false);
  }
  return out;
}

Null null_of(const View& v, const Surrogates& surrogates, std::size_t count) {
  Null out;
  const Observed observed = observed_surrogates(v, surrogates, count);
  const Eigen::MatrixXd gains = score_gains(v, v.products->spreads, observed);
  const auto n = static_cast<double>(count);
  out.mean = gains.rowwise().mean();
  out.scatter =
      ((gains.colwise() - out.mean).array().square().rowwise().sum() / std::max(1.0, n - 1.0))
          .sqrt()
          .matrix();
  for (Eigen::Index i = 0; i < gains.cols(); ++i)
    out.largest_z.push_back(
        ((gains.col(i) - out.mean).array() / (out.scatter.array() + k_noise_gain)).maxCoeff());
  std::sort(out.largest_z.begin(), out.largest_z.end());
  out.moved =
      adjacent_model(v, as_matrix(directions_of_model(v), v.products->spreads.front().all.rows()),
                     v.products->spreads.front(), observed.with_columns.front(),
                     observed.squares.front(), false)
          .moved;
  return out;
}

namespace {

/// Lines are part of the noise's own spectrum, which surrogates have too: they are judged by their
/// neighbours in frequency.
void judge_lines(const View& v, Judgement& j, double least_p) {
  Series z = *v.residual_n;
  whitening_of(v).apply(z);
  std::vector<std::pair<Series, Series>> seen;
  for (const auto& h : v.grid) {
    const Mechanism& m = mechanism_at(h.term.mechanism);
    if (!m.by_session) continue;
    const Columns c = m.columns(*v.scene, h.term.shape);
    Series sine = Series::Zero(z.size()), cosine = sine;
    for (std::size_t i = 0; i + 1 < c.own.size(); i += 2) sine += c.own[i], cosine += c.own[i + 1];
    const double p =
        line_p_value(*v.scene, z, sine, cosine,
                     m.from_residual ? line_trials(*v.scene) : static_cast<double>(v.grid.size()));
    double& kept = j.p_value[static_cast<std::size_t>(h.term.mechanism)];
    kept = std::min(kept, std::max(least_p, p));
  }
}

/// That the surface lies elsewhere in each session is a spread between them: the likelihood falls
/// without it, by half a chi² of one degree by chance.
void judge_surface(const View& v, Judgement& j, double least_p) {
  const int surface = known_mechanism("contact_offset");
  if (std::any_of(v.causes.begin(), v.causes.end(),
                  [&](const Term& t) { return t.mechanism == surface; }) ||
      v.spread[k_surface_position] <= 0.0)
    return;
  const std::vector<SessionSpread> spreads = narrower_spreads(v.spread);
  double with = 1e300, without = 1e300;
  for (std::size_t u = 0; u < spreads.size(); ++u) {
    const double left = fit({v.products->spreads[u]}, *v.products, known_of(v)).chi2;
    double& least = spreads[u][k_surface_position] > 0.0 ? with : without;
    least = std::min(least, left);
  }
  const double p = 0.5 * std::erfc(std::sqrt(std::max(0.0, without - with) / 2.0));
  double& kept = j.p_value[static_cast<std::size_t>(surface)];
  kept = std::min(kept, std::max(least_p, p));
}

}  // namespace

Judgement judge(const View& v, const Null& null, int left_out) {
  const std::vector<SpreadSums> sums = sums_without(*v.products, left_out);
  const Eigen::VectorXd gains = score_gains(v, sums, observed_data(sums)).col(0);
  const auto n = static_cast<double>(null.largest_z.size());
  // what a wrong motion gains grows with the rows: without a fold there is less of it
  double share = 1.0;
  if (left_out >= 0) {
    const auto [begin, end] = v.folds[static_cast<std::size_t>(left_out)];
    share -= static_cast<double>(end - begin) / static_cast<double>(v.force_n->size());
  }
  Judgement j;
  for (Eigen::Index e = 0; e < gains.size(); ++e) {
    if (null.largest_z.empty()) {  // the plain rule: as if noise alone could gain anything, times
                                   // the number of things that are tried
      j.z.push_back(gains[e] / k_noise_gain);
      j.p_value.push_back(std::min(1.0, k_plain_trials * std::exp(-0.5 * gains[e])));
      continue;
    }
    j.z.push_back((gains[e] - share * null.mean[e]) / (share * null.scatter[e] + k_noise_gain));
    const auto above = null.largest_z.end() -
                       std::lower_bound(null.largest_z.begin(), null.largest_z.end(), j.z.back());
    j.p_value.push_back((1.0 + static_cast<double>(above)) / (n + 1.0));
  }
  if (!null.largest_z.empty()) j.inflation = std::max(1.0, usual_gain(null) / k_noise_gain);
  judge_lines(v, j, 1.0 / (n + 1.0));
  judge_surface(v, j, 1.0 / (n + 1.0));
  return j;
}

double penalised_chi2(TermFits& fits, const std::vector<Term>& causes) {
  double penalty = 0.0;
  for (const auto& t : causes)
    penalty += k_parameter_penalty * static_cast<double>(parameters_of(t, *fits.view().scene));
  return fits.fit(causes).chi2 + penalty;
}

}  // namespace cavum::explain
