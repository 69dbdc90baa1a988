#include "engine/lab/explain/model/fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <map>

namespace cavum::explain {
namespace {

constexpr double k_ridge =
    1e-10;  // of a column's own norm: dependent columns share their coefficient instead of failing
constexpr Eigen::Index k_max_columns = 80;
constexpr double k_rig_doubt = 0.1;  // relative: rig.toml's k and c count as known to 10 %, which
                                     // only matters where the data are silent

/// Which columns of the products a parameter sums up.
struct Parameter {
  Eigen::Index column[9];
  double factor[9];
  int count = 0;
  Eigen::Index session = -1;  ///< the only one in which it acts; -1 = all
  void add(Eigen::Index c, double f = 1.0) {
    if (count == 9)
      return;  // more than eight causes that change one column: the search stops far earlier
    column[count] = c;
    factor[count++] = f;
  }
};

using Small =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, k_max_columns, k_max_columns>;
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, k_max_columns, 1>;

/// k, c, own coefficients of each hypothesis in turn, tangents of each in turn. How many.
Eigen::Index lay_out(const std::vector<const Hypothesis*>& model, Parameter* p) {
  Eigen::Index n = 2;
  p[0].add(1);
  p[1].add(2);
  for (const auto* h : model) {
    if (h->spring >= 0) p[0].add(h->spring, h->scale);
    if (h->damper >= 0) p[1].add(h->damper, h->scale);
    for (Eigen::Index s = 0; s < h->repeats; ++s)
      for (Eigen::Index i = 0; i < h->own && n < k_max_columns; ++i) {
        p[n].session = h->repeats > 1 ? s : -1;
        p[n++].add(h->first + i);
      }
  }
  for (const auto* h : model)
    for (Eigen::Index i = 0; i < h->tangent_count && n < k_max_columns; ++i)
      p[n++].add(h->tangents + i);
  return n;
}

/// Product of columns i and j over one fold, under spread `u`.
double product_in(const Products& products, std::size_t u, Eigen::Index fold, Eigen::Index i,
                  Eigen::Index j) {
  double out = products.folds[static_cast<std::size_t>(fold)](i, j);
  for (const auto& s : products.sessions)
    if (static_cast<Eigen::Index>(s.fold) == fold)
      out -= s.with_effects.row(i).dot(s.inverse[u] * s.with_effects.row(j).transpose());
  return out;
}

using Weighted = std::vector<std::pair<Eigen::Index, double>>;

/// The parameter that is the coefficient of one column; -1 = none is.
Eigen::Index parameter_of(Eigen::Index column, const Parameter* p, Eigen::Index n) {
  for (Eigen::Index i = 2; i < n; ++i)
    if (p[i].session < 0 && p[i].count == 1 && p[i].column[0] == column) return i;
  return -1;
}

/// Column 0, less what of the model's changes of k and c (at those that were taken) is not taken
/// yet, and with what was taken of causes that the model does not have.
Weighted what_is_left(const Taken& taken, const Parameter* p, Eigen::Index n) {
  Weighted out{{0, 1.0}};
  for (const auto& [column, value] : taken.own)
    if (parameter_of(column, p, n) < 0) out.emplace_back(column, value);
  const auto add = [&](const Parameter& of, double value,
                       const std::vector<Eigen::Index>& already) {
    std::map<Eigen::Index, double> factor;
    for (int at = 1; at < of.count; ++at) factor[of.column[at]] += of.factor[at];
    for (const Eigen::Index c : already) factor[c] -= 1.0;
    for (const auto& [column, f] : factor)
      if (f != 0.0 && value != 0.0) out.emplace_back(column, -f * value);
  };
  add(p[0], taken.k_n_per_mm, taken.spring);
  add(p[1], taken.c_n_s_per_mm, taken.damper);
  return out;
}

/// Left and right side of the normal equations under spread `u`, from the sums of products. The
/// squares of the force.
double equations(const Eigen::MatrixXd& sums, const Products& products, std::size_t u, int left_out,
                 const Parameter* p, Small& a, Vector& b) {
  const auto product = [&](Eigen::Index fold, Eigen::Index i, Eigen::Index j) {
    if (fold < 0) return sums(i, j);
    return fold == left_out ? 0.0 : product_in(products, u, fold, i, j);
  };
  const Weighted force = what_is_left(products.taken, p, b.size());
  for (Eigen::Index i = 0; i < b.size(); ++i) {
    b[i] = 0.0;
    for (int at = 0; at < p[i].count; ++at)
      for (const auto& [column, factor] : force)
        b[i] += p[i].factor[at] * factor * product(p[i].session, column, p[i].column[at]);
    for (Eigen::Index j = 0; j <= i; ++j) {
      const bool apart = p[i].session >= 0 && p[j].session >= 0 && p[i].session != p[j].session;
      const Eigen::Index fold = std::max(p[i].session, p[j].session);
      double sum = 0.0;
      for (int at = 0; at < p[i].count && !apart; ++at)
        for (int v = 0; v < p[j].count; ++v)
          sum += p[i].factor[at] * p[j].factor[v] * product(fold, p[i].column[at], p[j].column[v]);
      a(i, j) = a(j, i) = sum;
    }
  }
  double squares = 0.0;
  for (const auto& [i, f] : force)
    for (const auto& [j, g] : force) squares += f * g * sums(i, j);
  return squares;
}

FitResult fit_under(const SpreadSums& sums, const Products& products, std::size_t u,
                    const Parameter* p, Eigen::Index n, int left_out, bool covariance) {
  Small a(n, n);
  Vector b(n);
  double yy = equations(sums.all, products, u, left_out, p, a, b);
  const double taken[2] = {products.taken.k_n_per_mm, products.taken.c_n_s_per_mm};
  for (Eigen::Index i = 0; i < 2; ++i) {
    const double at = products.prior_at[i] - taken[i];
    a(i, i) += products.prior[i];
    b[i] += products.prior[i] * at;
    yy += products.prior[i] * at * at;
  }
  // scaled to ones on the diagonal: columns differ by many orders of magnitude
  Vector scale(n);
  for (Eigen::Index i = 0; i < n; ++i) scale[i] = a(i, i) > 0.0 ? 1.0 / std::sqrt(a(i, i)) : 0.0;
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      a(i, j) = i == j ? 1.0 + k_ridge : a(i, j) * scale[i] * scale[j];
  const Vector bs = b.cwiseProduct(scale);
  const Eigen::LDLT<Small> solver(a);
  FitResult out;
  const Vector xs = solver.solve(bs);
  out.solved = solver.info() == Eigen::Success && xs.allFinite();
  out.value = xs.cwiseProduct(scale);
  for (Eigen::Index i = 0; i < 2; ++i) out.value[i] += taken[i];
  for (const auto& [column, value] : products.taken.own)
    if (const Eigen::Index i = parameter_of(column, p, n); i >= 0) out.value[i] += value;
  out.chi2 = (out.solved ? yy - bs.dot(xs) : yy) + sums.log_det;
  if (covariance)
    out.covariance = scale.asDiagonal() * solver.solve(Small::Identity(n, n)) * scale.asDiagonal();
  return out;
}

}  // namespace

Eigen::Index Hypothesis::parameters() const {
  Eigen::Index fitted = 0;
  const auto& ranges = mechanism_at(term.mechanism).shape;
  for (std::size_t i = 0; i < ranges.size(); ++i)
    fitted += ranges[i].fitted && term.shape[i] != 0.0;
  return own + repeats - 1 + fitted;
}

namespace {

/// Sums under spread `u` over one fold, or over all of them (fold = -1).
SpreadSums integrated(const Products& products, std::size_t u, int fold) {
  const auto counts = [&](std::size_t f) { return fold < 0 || static_cast<int>(f) == fold; };
  SpreadSums out{
      Eigen::MatrixXd::Zero(products.folds.front().rows(), products.folds.front().cols()), 0.0};
  for (std::size_t f = 0; f < products.folds.size(); ++f)
    if (counts(f)) out.all += products.folds[f];
  const auto sessions = std::count_if(products.sessions.begin(), products.sessions.end(),
                                      [&](const auto& s) { return counts(s.fold); });
  Eigen::MatrixXd with(out.all.rows(), sessions * static_cast<Eigen::Index>(k_session_effects)),
      shrunk = with;  // side by side
  Eigen::Index at = 0;
  for (const auto& s : products.sessions) {
    if (!counts(s.fold)) continue;
    out.log_det += s.log_det[u];
    if (s.inverse[u].squaredNorm() == 0.0) continue;
    with.middleCols(at, k_session_effects) = s.with_effects;
    shrunk.middleCols(at, k_session_effects).noalias() = s.with_effects * s.inverse[u];
    at += static_cast<Eigen::Index>(k_session_effects);
  }
  if (at > 0) out.all.noalias() -= shrunk.leftCols(at) * with.leftCols(at).transpose();
  return out;
}

}  // namespace

void set_prior(Products& p, const Rig& rig) {
  const std::optional<double> given[2] = {rig.k_n_per_mm, rig.c_n_s_per_mm};
  for (int i = 0; i < 2; ++i)
    if (given[i]) {
      p.prior_at[i] = *given[i];
      p.prior[i] = 1.0 / std::pow(std::max(1e-6, k_rig_doubt * *given[i]), 2);
    }
}

void integrate(Products& products) {
  for (auto& s : products.sessions) {
    s.log_det.assign(products.tried.size(), 0.0);
    s.inverse.clear();
    for (std::size_t u = 0; u < products.tried.size(); ++u)
      s.inverse.push_back(shrunk_inverse(s.effects, products.tried[u], s.log_det[u]));
  }
  products.spreads.clear();
  for (std::size_t u = 0; u < products.tried.size(); ++u)
    products.spreads.push_back(integrated(products, u, -1));
}

std::vector<SpreadSums> sums_without(const Products& products, int left_out) {
  std::vector<SpreadSums> out = products.spreads;
  for (std::size_t u = 0; u < out.size() && left_out >= 0; ++u) {
    const SpreadSums fold = integrated(products, u, left_out);
    out[u].all -= fold.all;
    out[u].log_det -= fold.log_det;
  }
  return out;
}

FitResult fit(const std::vector<SpreadSums>& sums, const Products& products,
              const std::vector<const Hypothesis*>& model, int left_out, bool covariance) {
  Parameter p[k_max_columns];
  const Eigen::Index n = lay_out(model, p);
  FitResult best;
  for (std::size_t u = 0; u < sums.size(); ++u) {
    FitResult one = fit_under(sums[u], products, u, p, n, left_out, covariance);
    if (u == 0 || one.chi2 < best.chi2) best = std::move(one);
  }
  return best;
}

FitResult fit(const Products& products, const std::vector<const Hypothesis*>& model, int left_out,
              bool covariance) {
  return left_out < 0
             ? fit(products.spreads, products, model, -1, covariance)
             : fit(sums_without(products, left_out), products, model, left_out, covariance);
}

}  // namespace cavum::explain
