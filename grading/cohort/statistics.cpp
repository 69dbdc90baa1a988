#include "grading/cohort/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/base/error.h"
#include "engine/base/random.h"

namespace cavum::cohort {
namespace {

void require(bool enough, const Message& what) {
  if (!enough) throw Error(msg("statistics"), what, msg("wait for more results"));
}

void require_table(const Matrix& m) {
  require(m.size() >= 2 && m[0].size() >= 2, msg("needs two rows and two columns at least"));
  for (const auto& row : m) require(row.size() == m[0].size(), msg("needs rows of equal length"));
}

std::vector<double> column(const Matrix& m, std::size_t c) {
  std::vector<double> out;
  for (const auto& row : m) out.push_back(row[c]);
  return out;
}

std::vector<double> sums(const Matrix& m) {
  std::vector<double> out;
  for (const auto& row : m) out.push_back(std::accumulate(row.begin(), row.end(), 0.0));
  return out;
}

double f_of(const std::vector<std::vector<double>>& groups, double& share) {
  double n = 0, all = 0, between = 0, within = 0;
  for (const auto& g : groups)
    for (const double v : g) n += 1, all += v;
  const double grand = all / n;
  for (const auto& g : groups) {
    const double m = mean(g);
    between += static_cast<double>(g.size()) * (m - grand) * (m - grand);
    for (const double v : g) within += (v - m) * (v - m);
  }
  const auto k = static_cast<double>(groups.size());
  share = between + within > 0 ? between / (between + within) : 0.0;
  return within > 0 ? (between / (k - 1)) / (within / (n - k)) : (between > 0 ? 1e300 : 0.0);
}

}  // namespace

double cronbach_alpha(std::size_t criteria, double sum_of_variances, double variance_of_sum) {
  require(criteria >= 2, msg("needs two criteria at least"));
  require(variance_of_sum > 0, msg("needs sums that differ"));
  const auto k = static_cast<double>(criteria);
  return k / (k - 1) * (1 - sum_of_variances / variance_of_sum);
}

double cronbach_alpha(const Matrix& m) {
  require_table(m);
  double parts = 0;
  for (std::size_t c = 0; c < m[0].size(); ++c) parts += variance(column(m, c));
  return cronbach_alpha(m[0].size(), parts, variance(sums(m)));
}

double standard_error(double sd_of_sum, double alpha) {
  return sd_of_sum * std::sqrt(std::max(0.0, 1 - alpha));
}

std::vector<double> discrimination(const Matrix& m) {
  require_table(m);
  const auto total = sums(m);
  std::vector<double> out;
  for (std::size_t c = 0; c < m[0].size(); ++c) {
    const auto item = column(m, c);
    auto rest = total;
    for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= item[i];
    out.push_back(correlation(item, rest));
  }
  return out;
}

Icc intraclass_correlation(const Matrix& m) {
  require_table(m);
  const auto n = static_cast<double>(m.size()), k = static_cast<double>(m[0].size());
  double grand = 0;
  for (const auto& row : m) grand += mean(row) / n;
  double rows = 0, judges = 0, all = 0;
  for (const auto& row : m) {
    rows += k * (mean(row) - grand) * (mean(row) - grand);
    for (const double v : row) all += (v - grand) * (v - grand);
  }
  for (std::size_t c = 0; c < m[0].size(); ++c) {
    const double d = mean(column(m, c)) - grand;
    judges += n * d * d;
  }
  const double bms = rows / (n - 1), jms = judges / (k - 1),
               ems = (all - rows - judges) / ((n - 1) * (k - 1));
  require(bms > 0, msg("needs objects that differ"));
  Icc out;
  out.single_random = (bms - ems) / (bms + (k - 1) * ems + k * (jms - ems) / n);
  out.single_fixed = (bms - ems) / (bms + (k - 1) * ems);
  out.average_random = (bms - ems) / (bms + (jms - ems) / n);
  out.average_fixed = (bms - ems) / bms;
  return out;
}

double weighted_kappa(const Matrix& counts, const Matrix& weights) {
  require_table(counts);
  require_table(weights);
  require(counts.size() == counts[0].size() && weights.size() == counts.size() &&
              weights[0].size() == counts.size(),
          msg("needs square tables of one size"));
  const auto by_first = sums(counts);
  const double n = std::accumulate(by_first.begin(), by_first.end(), 0.0);
  require(n > 0, msg("needs one object at least"));
  double observed = 0, expected = 0;
  for (std::size_t i = 0; i < counts.size(); ++i)
    for (std::size_t j = 0; j < counts.size(); ++j) {
      const auto by_second = column(counts, j);
      observed += weights[i][j] * counts[i][j] / n;
      expected += weights[i][j] * by_first[i] *
                  std::accumulate(by_second.begin(), by_second.end(), 0.0) / (n * n);
    }
  require(expected > 0, msg("needs judges who use two categories at least"));
  return 1 - observed / expected;
}

Matrix quadratic_weights(std::size_t n) {
  Matrix w(n, std::vector<double>(n));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      const double d = static_cast<double>(i) - static_cast<double>(j);
      w[i][j] = d * d;
    }
  return w;
}

LimitsOfAgreement limits_of_agreement(std::span<const double> a, std::span<const double> b) {
  require(a.size() == b.size() && a.size() >= 2, msg("needs both marks of two at least"));
  std::vector<double> difference;
  for (std::size_t i = 0; i < a.size(); ++i) difference.push_back(a[i] - b[i]);
  LimitsOfAgreement out;
  out.bias = mean(difference);
  out.sd = std::sqrt(variance(difference));
  out.low = out.bias - 2 * out.sd;
  out.high = out.bias + 2 * out.sd;
  return out;
}

Line fit_line(std::span<const double> x, std::span<const double> y) {
  require(x.size() == y.size() && x.size() >= 2, msg("needs two points at least"));
  const double mx = mean(x), my = mean(y), vx = variance(x);
  require(vx > 0, msg("needs two different places on the line at least"));
  double xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) xy += (x[i] - mx) * (y[i] - my);
  Line out;
  out.slope = xy / (vx * static_cast<double>(x.size() - 1));
  out.intercept = my - out.slope * mx;
  out.r = correlation(x, y);
  return out;
}

double borderline_cut(std::span<const double> rating, std::span<const double> score,
                      double borderline) {
  const Line line = fit_line(rating, score);
  return line.intercept + line.slope * borderline;
}

GroupEffect group_effect(const std::vector<std::vector<double>>& groups, int shuffles,
                         std::uint64_t seed) {
  std::vector<std::vector<double>> shuffled = groups;
  std::vector<double> all;
  for (const auto& g : groups) {
    require(!g.empty(), msg("needs one score in each group at least"));
    all.insert(all.end(), g.begin(), g.end());
  }
  require(groups.size() >= 2 && all.size() > groups.size(),
          msg("needs two groups, and more scores than groups"));
  GroupEffect out;
  out.f = f_of(groups, out.share);
  Random random(seed);
  int as_much = 0;
  for (int s = 0; s < shuffles; ++s) {
    for (std::size_t i = all.size() - 1; i > 0; --i) std::swap(all[i], all[random.below(i + 1)]);
    std::size_t next = 0;
    for (auto& g : shuffled)
      for (double& v : g) v = all[next++];
    double ignored = 0;
    as_much += f_of(shuffled, ignored) >= out.f * (1 - 1e-12) ? 1 : 0;
  }
  out.chance = (as_much + 1.0) / (shuffles + 1.0);
  return out;
}

}  // namespace cavum::cohort
