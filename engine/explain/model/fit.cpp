#include "engine/explain/model/fit.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace cavum::explain {
namespace {

constexpr double k_ridge = 1e-10;  // of a column's own norm: dependent columns share their coefficient instead of failing
constexpr Eigen::Index k_max_columns = 80;

/// Which columns of the products a parameter sums up.
struct Parameter {
  Eigen::Index column[9];
  double factor[9];
  int count = 0;
  Eigen::Index session = -1;  ///< the only one in which it acts; -1 = all
  void add(Eigen::Index c, double f = 1.0) {
    if (count == 9) return;  // more than eight causes that change one column: the search stops far earlier
    column[count] = c;
    factor[count++] = f;
  }
};

using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, k_max_columns, k_max_columns>;
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
    for (Eigen::Index i = 0; i < h->tangent_count && n < k_max_columns; ++i) p[n++].add(h->tangents + i);
  return n;
}

/// Left and right side of the normal equations under spread `u`, from the sums of products.
void equations(const Eigen::MatrixXd& sums, const Products& products, std::size_t u, int left_out, const Parameter* p, Small& a, Vector& b) {
  const Eigen::MatrixXd nothing;
  const auto sums_of = [&](Eigen::Index fold) -> const Eigen::MatrixXd& {
    if (fold < 0) return sums;
    return fold == left_out ? nothing : products.folds[static_cast<std::size_t>(fold)][u].all;
  };
  for (Eigen::Index i = 0; i < b.size(); ++i) {
    const Eigen::MatrixXd& own = sums_of(p[i].session);
    b[i] = 0.0;
    for (int at = 0; at < p[i].count && own.size() > 0; ++at) b[i] += p[i].factor[at] * own(0, p[i].column[at]);
    for (Eigen::Index j = 0; j <= i; ++j) {
      const bool apart = p[i].session >= 0 && p[j].session >= 0 && p[i].session != p[j].session;
      const Eigen::MatrixXd& g = p[i].session >= 0 ? own : sums_of(p[j].session);
      double sum = 0.0;
      if (apart || g.size() == 0) {
        a(i, j) = a(j, i) = 0.0;
        continue;
      }
      for (int at = 0; at < p[i].count; ++at)
        for (int v = 0; v < p[j].count; ++v) sum += p[i].factor[at] * p[j].factor[v] * g(p[i].column[at], p[j].column[v]);
      a(i, j) = a(j, i) = sum;
    }
  }
}

FitResult fit_under(const SpreadSums& sums, const Products& products, std::size_t u, const Parameter* p, Eigen::Index n, int left_out,
                    bool covariance) {
  Small a(n, n);
  Vector b(n);
  equations(sums.all, products, u, left_out, p, a, b);
  double yy = sums.all(0, 0);
  for (Eigen::Index i = 0; i < 2; ++i) {
    a(i, i) += products.prior[i];
    b[i] += products.prior[i] * products.prior_at[i];
    yy += products.prior[i] * products.prior_at[i] * products.prior_at[i];
  }
  // scaled to ones on the diagonal: columns differ by many orders of magnitude
  Vector scale(n);
  for (Eigen::Index i = 0; i < n; ++i) scale[i] = a(i, i) > 0.0 ? 1.0 / std::sqrt(a(i, i)) : 0.0;
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) a(i, j) = i == j ? 1.0 + k_ridge : a(i, j) * scale[i] * scale[j];
  const Vector bs = b.cwiseProduct(scale);
  const Eigen::LDLT<Small> solver(a);
  FitResult out;
  const Vector xs = solver.solve(bs);
  out.solved = solver.info() == Eigen::Success && xs.allFinite();
  out.value = xs.cwiseProduct(scale);
  out.chi2 = (out.solved ? yy - bs.dot(xs) : yy) + sums.log_det;
  if (covariance) out.covariance = scale.asDiagonal() * solver.solve(Small::Identity(n, n)) * scale.asDiagonal();
  return out;
}

}  // namespace

Eigen::Index Hypothesis::parameters() const {
  Eigen::Index fitted = 0;
  const auto& ranges = mechanism_at(term.mechanism).shape;
  for (std::size_t i = 0; i < ranges.size(); ++i) fitted += ranges[i].fitted && term.shape[i] != 0.0;
  return own + repeats - 1 + fitted;
}

std::vector<SpreadSums> sums_without(const Products& products, int left_out) {
  std::vector<SpreadSums> out = products.spreads;
  if (left_out < 0) return out;
  for (std::size_t u = 0; u < out.size(); ++u) {
    const SpreadSums& fold = products.folds[static_cast<std::size_t>(left_out)][u];
    out[u].all -= fold.all;
    out[u].log_det -= fold.log_det;
  }
  return out;
}

FitResult fit(const std::vector<SpreadSums>& sums, const Products& products, const std::vector<const Hypothesis*>& model, int left_out,
              bool covariance) {
  Parameter p[k_max_columns];
  const Eigen::Index n = lay_out(model, p);
  FitResult best;
  for (std::size_t u = 0; u < sums.size(); ++u) {
    FitResult one = fit_under(sums[u], products, u, p, n, left_out, covariance);
    if (u == 0 || one.chi2 < best.chi2) best = std::move(one);
  }
  return best;
}

FitResult fit(const Products& products, const std::vector<const Hypothesis*>& model, int left_out, bool covariance) {
  return left_out < 0 ? fit(products.spreads, products, model, -1, covariance)
                      : fit(sums_without(products, left_out), products, model, left_out, covariance);
}

}  // namespace cavum::explain
