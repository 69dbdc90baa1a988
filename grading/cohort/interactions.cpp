#include "grading/cohort/interactions.h"

#include <algorithm>
#include <bit>
#include <map>
#include <numeric>
#include <set>

#include "grading/cohort/square_matrix.h"

namespace cavum::cohort {
namespace {

std::size_t levels_of(std::span<const StudyMark> marks, std::size_t facet) {
  std::set<std::uint32_t> seen;
  for (const StudyMark& m : marks) seen.insert(m.level[facet]);
  return seen.size();
}

std::vector<double> sums_by(const std::vector<std::uint32_t>& group,
                            std::span<const double> values) {
  std::vector<double> sum(1 + *std::max_element(group.begin(), group.end()));
  for (std::size_t i = 0; i < group.size(); ++i) sum[group[i]] += values[i];
  return sum;
}

double squares_by(const Interaction& of, std::span<const double> values) {
  std::vector<double> size(sums_by(of.group, std::vector<double>(values.size(), 1.0)));
  const std::vector<double> sum = sums_by(of.group, values);
  double total = 0;
  for (std::size_t g = 0; g < sum.size(); ++g) total += sum[g] * sum[g] / size[g];
  return total;
}

/// Pairs of facets that part the marks in a way of their own and leave freedom, and the rest.
Interactions interactions_of(std::span<const StudyMark> marks) {
  Interactions out;
  const std::size_t facets = marks[0].level.size();
  Interaction rest;
  rest.effect = (1U << facets) - 1;
  rest.group = groups_under(rest.effect, marks);
  for (std::size_t a = 0; a < facets; ++a)
    for (std::size_t b = a + 1; b < facets && facets > 2; ++b) {
      Interaction pair;
      pair.effect = 1U << a | 1U << b;
      pair.group = groups_under(pair.effect, marks);
      if (pair.group == rest.group) continue;
      const auto groups =
          static_cast<double>(1 + *std::max_element(pair.group.begin(), pair.group.end()));
      pair.marks_each = static_cast<double>(marks.size()) / groups;
      pair.freedom = groups - static_cast<double>(levels_of(marks, a) + levels_of(marks, b)) + 1;
      if (pair.freedom >= 1)
        out.list.push_back(std::move(pair));
      else if (levels_of(marks, a) > 1 || levels_of(marks, b) > 1)
        out.untold.push_back(pair.effect);
    }
  out.list.push_back(std::move(rest));
  return out;
}

}  // namespace

Interactions estimate_interactions(std::span<const StudyMark> marks, double free,
                                   const Residuals& residuals) {
  Interactions out = interactions_of(marks);
  std::vector<double> values;
  for (const StudyMark& m : marks) values.push_back(m.value);
  const std::vector<double> left = residuals(values);
  const std::size_t n = out.list.size();
  double rest_freedom = free;
  for (std::size_t k = 0; k + 1 < n; ++k) rest_freedom -= out.list[k].freedom;
  out.list[n - 1].freedom = std::max(1.0, rest_freedom);

  // expected[i][k]: how much of interaction k of variance 1 stands in the residuals' squares by the
  // groups of i.
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd squares(n);
  for (std::size_t i = 0; i < n; ++i) squares[i] = squares_by(out.list[i], left);
  expected(n - 1, n - 1) = free;
  for (std::size_t k = 0; k + 1 < n; ++k) {
    const auto& group = out.list[k].group;
    const std::uint32_t groups = 1 + *std::max_element(group.begin(), group.end());
    for (std::uint32_t g = 0; g < groups; ++g) {
      std::vector<double> one(marks.size());
      double size = 0;
      for (std::size_t i = 0; i < group.size(); ++i)
        if (group[i] == g) one[i] = 1, size += 1;
      const std::vector<double> seen = residuals(one);
      for (std::size_t i = 0; i < n; ++i) expected(i, k) += squares_by(out.list[i], seen);
      for (std::size_t i = 0; i < group.size(); ++i)
        if (group[i] == g) expected(k, n - 1) += seen[i] / size;
    }
  }
  // Those below 0 leave, the lowest first; what is left of them is the rest's.
  std::vector<std::size_t> in(n);
  std::iota(in.begin(), in.end(), 0U);
  while (true) {
    const auto inverse = ScaledRows(expected(in, in)).inverse();
    std::size_t worst = in.size() - 1;
    Eigen::VectorXd variance;
    if (inverse) variance = *inverse * squares(in);
    for (std::size_t k = 0; inverse && k + 1 < in.size(); ++k)
      if (variance[k] < std::min(0.0, worst + 1 == in.size() ? 0.0 : variance[worst])) worst = k;
    if (!inverse) worst = in.size() > 1 ? in.size() - 2 : 0;
    if (inverse && worst + 1 == in.size()) {
      for (std::size_t k = 0; k < in.size(); ++k)
        out.list[in[k]].variance = std::max(0.0, variance[k]);
      return out;
    }
    if (in.size() == 1) return out;
    in.erase(in.begin() + static_cast<std::ptrdiff_t>(worst));
  }
}

ErrorOfSum error_of_sum(const Interactions& interactions, std::span<const double> weights) {
  const Interaction& rest = interactions.list.back();
  ErrorOfSum out;
  double left = 0, uncertainty = 0;
  for (const double w : weights) left += w * w;
  for (std::size_t k = 0; k + 1 < interactions.list.size(); ++k) {
    const Interaction& of = interactions.list[k];
    double squares = 0;
    for (const double sum : sums_by(of.group, weights)) squares += sum * sum;
    out.variance += squares * of.variance;
    // A mean square of its groups tells it: the rest, and as many of it as a group has marks.
    const double share = squares / of.marks_each,
                 mean_square = rest.variance + of.marks_each * of.variance;
    uncertainty += share * share * mean_square * mean_square / of.freedom;
    left -= share;
  }
  double all = 0;
  for (const double w : weights) all += w * w;
  out.variance += all * rest.variance;
  uncertainty += left * left * rest.variance * rest.variance / rest.freedom;
  out.freedom = uncertainty > 0 ? out.variance * out.variance / uncertainty : rest.freedom;
  return out;
}

}  // namespace cavum::cohort
