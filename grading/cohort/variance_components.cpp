#include "grading/cohort/variance_components.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/order.h"
#include "engine/base/random.h"
#include "engine/base/statistics.h"
#include "grading/cohort/square_matrix.h"

namespace cavum::cohort {
namespace {

constexpr std::size_t k_max_facets = 5;

/// Sum over groups of the square of their sum by their size.
double sum_of_squares(const std::vector<std::uint32_t>& group, const std::vector<double>& size,
                      std::span<const double> values) {
  std::vector<double> sum(size.size());
  for (std::size_t i = 0; i < group.size(); ++i) sum[group[i]] += values[i];
  double total = 0;
  for (std::size_t g = 0; g < sum.size(); ++g) total += sum[g] * sum[g] / size[g];
  return total;
}

/// How much of an effect of variance 1 stands in the sum of squares over these groups.
double expected(const std::vector<std::uint32_t>& group, const std::vector<double>& size,
                const std::vector<std::uint32_t>& effect) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> both;
  for (std::size_t i = 0; i < group.size(); ++i) both[{group[i], effect[i]}] += 1;
  double total = 0;
  for (const auto& [at, n] : both) total += n * n / size[at.first];
  return total;
}

/// Of effect `e` beside the others: "candidate x task", "rater:task".
std::string name_of(const StudyDesign& design, std::uint32_t e) {
  // A facet that never stands without another one is nested in it.
  const auto always_with = [&](std::size_t inner, std::size_t outer) {
    return std::all_of(design.effects.begin(), design.effects.end(), [&](std::uint32_t other) {
      return (other >> inner & 1U) == 0 || (other >> outer & 1U) != 0;
    });
  };
  std::string name;
  for (std::size_t f = 0; f < design.facets.size(); ++f) {
    if ((e >> f & 1U) == 0) continue;
    std::string part = design.facets[f];
    bool holds_inner = false;
    for (std::size_t o = 1; o < design.facets.size(); ++o) {
      if (o == f) continue;
      if (always_with(f, o)) part += ":" + design.facets[o];
      holds_inner = holds_inner || ((e >> o & 1U) != 0 && always_with(o, f));
    }
    if (!holds_inner) name += (name.empty() ? "" : " x ") + part;
  }
  return name;
}

StudyDesign with_names(StudyDesign design) {
  for (const std::uint32_t e : design.effects) design.names.push_back(name_of(design, e));
  return design;
}

/// The names of effects whose sums of squares depend on one another. Column k stands for effect k,
/// the last for the mean.
List dependent_effects(const Eigen::MatrixXd& a, const std::vector<std::string>& names) {
  List list;
  for (std::size_t k = 0; k < names.size(); ++k) {
    std::vector<Eigen::Index> others;
    for (Eigen::Index other = 0; other < a.cols(); ++other)
      if (other != static_cast<Eigen::Index>(k)) others.push_back(other);
    if (ScaledRows(a(Eigen::all, others)).rank() == ScaledRows(a).rank())
      list.items.push_back(msg("{}", Term{names[k]}));
  }
  return list;
}

}  // namespace

StudyDesign crossed_design(std::vector<std::string> facets) {
  if (facets.size() < 2 || facets.size() > k_max_facets)
    throw Error(msg("a study"), msg("needs one to four facets beside the candidates"),
                msg("name tasks, raters, stations"));
  StudyDesign design{std::move(facets), {}, {}};
  const auto sets = static_cast<std::uint32_t>(1U << design.facets.size());
  for (std::uint32_t e = 1; e < sets; ++e) design.effects.push_back(e);
  std::stable_sort(
      design.effects.begin(), design.effects.end(),
      [](std::uint32_t a, std::uint32_t b) { return std::popcount(a) < std::popcount(b); });
  return with_names(std::move(design));
}

StudyDesign nested_design(const std::string& persons, const std::string& outer,
                          const std::string& inner) {
  return with_names({{persons, outer, inner}, {0b001, 0b010, 0b110, 0b011, 0b111}, {}});
}

namespace {

std::vector<double> times(const Eigen::MatrixXd& matrix, std::span<const double> column) {
  const Eigen::VectorXd out =
      matrix * Eigen::Map<const Eigen::VectorXd>(column.data(), matrix.cols());
  return {out.begin(), out.end()};
}

StudyDesign fitting(StudyDesign design, std::span<const StudyMark> marks) {
  for (const StudyMark& m : marks)
    if (m.level.size() != design.facets.size())
      throw Error(msg("a mark"), msg("has another number of conditions than the study has facets"),
                  {});
  return design;
}

}  // namespace

void VarianceStudy::merge(std::span<const StudyMark> marks) {
  for (const std::uint32_t e : design_.effects) group_.push_back(groups_under(e, marks));
  const auto of_error = [&](std::size_t k) { return design_.effects[k] != 1U; };
  for (std::size_t k = 0; k + 1 < design_.effects.size();) {
    std::size_t larger = design_.effects.size() - 1;
    const auto holds = [&](std::size_t other) {
      const std::uint32_t e = design_.effects[k], o = design_.effects[other];
      return other != k && (o & e) == e && (o & 1U) == (e & 1U) && group_[other] == group_[k];
    };
    while (larger > k && !holds(larger)) --larger;
    if (larger == k || !of_error(k)) {
      ++k;
      continue;
    }
    merged_.emplace_back(design_.names[k], design_.names[larger]);
    const auto at = static_cast<std::ptrdiff_t>(k);
    design_.effects.erase(design_.effects.begin() + at);
    design_.names.erase(design_.names.begin() + at);
    group_.erase(group_.begin() + at);
  }
}

VarianceStudy::VarianceStudy(StudyDesign design, std::span<const StudyMark> marks)
    : design_(fitting(std::move(design), marks)), marks_(marks.size()) {
  merge(marks);
  for (const auto& group : group_) {
    std::vector<double> size;
    for (const std::uint32_t g : group) {
      if (g >= size.size()) size.resize(g + 1);
      size[g] += 1;
    }
    size_.push_back(std::move(size));
  }
  if (!size_.empty() && size_.back().size() != marks_)
    throw Error(msg("two marks"), msg("stand for the same candidate under the same conditions"),
                msg("keep one of them"));
  const std::size_t n = design_.effects.size();
  const std::vector<std::uint32_t> all(marks_, 0);
  const std::vector<double> all_size{static_cast<double>(marks_)};
  Eigen::MatrixXd a = Eigen::MatrixXd::Constant(n + 1, n + 1, static_cast<double>(marks_));
  for (std::size_t i = 0; i <= n; ++i)
    for (std::size_t k = 0; k < n; ++k)
      a(i, k) =
          i < n ? expected(group_[i], size_[i], group_[k]) : expected(all, all_size, group_[k]);
  expected_.resize(n, n);
  for (std::size_t k = 0; k < n; ++k) {
    const std::vector<double> own = own_squares({a.col(k).begin(), a.col(k).end()});
    expected_.col(k) = Eigen::Map<const Eigen::VectorXd>(own.data(), expected_.rows());
  }
  auto inverse = ScaledRows(expected_).inverse();
  if (!inverse)
    throw Error(StudyError::effects_not_apart, msg("these marks"),
                msg("cannot tell these effects apart: {}", dependent_effects(a, design_.names)),
                msg("a study needs two conditions of each facet, and candidates who share them"));
  of_squares_ = std::move(*inverse);
  marking_ = Marking(design_, marks);
}

std::vector<double> VarianceStudy::own_squares(std::vector<double> sums) const {
  std::vector<double> own(design_.effects.size());
  std::vector<std::size_t> order(own.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::popcount(design_.effects[a]) < std::popcount(design_.effects[b]);
  });
  for (const std::size_t i : order) {
    own[i] = sums[i] - sums.back();
    for (const std::size_t k : order)
      if (k != i && (design_.effects[i] & design_.effects[k]) == design_.effects[k])
        own[i] -= own[k];
  }
  return own;
}

std::vector<double> VarianceStudy::squares(std::span<const double> values) const {
  const double middle = mean(values);
  std::vector<double> from_middle(values.begin(),
                                  values.end());  // the sums of squares then lose no digits
  for (double& v : from_middle) v -= middle;
  std::vector<double> sums;
  for (std::size_t i = 0; i < group_.size(); ++i)
    sums.push_back(sum_of_squares(group_[i], size_[i], from_middle));
  sums.push_back(0);
  return own_squares(std::move(sums));
}

std::vector<double> VarianceStudy::expected_squares(std::span<const double> variance) const {
  return times(expected_, variance);
}
std::vector<double> VarianceStudy::variances_of(std::span<const double> squares) const {
  return times(of_squares_, squares);
}

VarianceComponents VarianceStudy::estimate(std::span<const double> values) const {
  const double middle = mean(values);
  double mean_square = 0;
  for (const double v : values)
    mean_square += (v - middle) * (v - middle) / static_cast<double>(marks_);
  const double rounding = 1e-12 * mean_square + 1e-24 * middle * middle;
  VarianceComponents found{variances_of(squares(values)), middle};
  for (double& v : found.variance)
    if (std::fabs(v) <= rounding) v = 0;
  return found;
}

std::vector<double> VarianceStudy::draw(const VarianceComponents& from, std::uint64_t seed) const {
  Random random(seed);
  std::vector<double> values(marks_, from.mean);
  for (std::size_t k = 0; k < group_.size(); ++k) {
    const double sd = std::sqrt(std::max(0.0, from.variance[k]));
    std::vector<double> of_group(size_[k].size());
    for (double& v : of_group) v = sd * random.normal();
    for (std::size_t i = 0; i < marks_; ++i) values[i] += of_group[group_[k][i]];
  }
  return values;
}

namespace {

/// `fixed`: effects that are the same in every circuit.
Dependability dependable(const StudyDesign& design, const VarianceComponents& components,
                         const MarkShares& shares, const std::vector<bool>& fixed, double persons) {
  Dependability d;
  for (std::size_t k = 0; k < design.effects.size(); ++k) {
    const double variance = std::max(0.0, components.variance[k]);
    const double own = variance * shares.own[k], common = variance * shares.common[k];
    const bool of_persons = (design.effects[k] & 1U) != 0;
    if (fixed[k] && !of_persons) continue;
    (fixed[k] ? d.universe : d.absolute) += own;
    if (!fixed[k]) d.relative += std::max(0.0, own - common);
    d.of_the_mean += common + (own - common) / persons;
  }
  const auto ratio = [&](double error) {
    return d.universe + error > 0 ? d.universe / (d.universe + error) : 0.0;
  };
  d.g = ratio(d.relative);
  d.phi = ratio(d.absolute);
  d.relative_sem = std::sqrt(d.relative);
  d.absolute_sem = std::sqrt(d.absolute);
  return d;
}

}  // namespace

Dependability dependability(const StudyDesign& design, const VarianceComponents& components,
                            const CircuitPlan& plan, double persons) {
  if (plan.conditions.size() + 1 != design.facets.size())
    throw Error(msg("the plan of a circuit"), msg("has another number of facets than the study"),
                {});
  for (const double n : plan.conditions)
    if (!(n >= 1))
      throw Error(msg("the plan of a circuit"), msg("has fewer than one condition of a facet"),
                  msg("plan at least one"));
  MarkShares shares;
  std::vector<bool> fixed;
  for (const std::uint32_t e : design.effects) {
    double share = 1;
    bool random = false;
    for (std::size_t f = 1; f < design.facets.size(); ++f) {
      if ((e >> f & 1U) == 0) continue;
      share /= plan.conditions[f - 1];
      random = random || plan.fixed.empty() || !plan.fixed[f - 1];
    }
    shares.own.push_back(share);
    shares.common.push_back((e & 1U) != 0 ? 0.0 : share);
    fixed.push_back(!random);
  }
  return dependable(design, components, shares, fixed, persons);
}

Dependability dependability(const StudyDesign& design, const VarianceComponents& components,
                            const MarkShares& shares, double persons) {
  std::vector<bool> fixed;
  for (const std::uint32_t e : design.effects) fixed.push_back(e == 1U);
  return dependable(design, components, shares, fixed, persons);
}

void require_differences(const StudyDesign& design, const VarianceComponents& components) {
  const auto there = [&](bool of_persons) {
    for (std::size_t k = 0; k < design.effects.size(); ++k)
      if (((design.effects[k] & 1U) != 0) == of_persons && components.variance[k] > 0) return true;
    return false;
  };
  if (there(true)) return;
  if (!there(false))
    throw Error(StudyError::all_alike, msg("these marks"),
                msg("are all alike: nothing varies, and nothing tells how dependable they are"),
                msg("study marks that differ"));
  throw Error(
      StudyError::conditions_alone, msg("these marks"),
      msg("differ by their conditions alone: no variance is of the candidates, and nothing tells how dependable theirs are"),
      msg("study candidates who differ"));
}

CutDecision cut_decision(const Dependability& d, double mean_mark, double cut) {
  CutDecision c;
  const double away = mean_mark - cut;
  const double signal = d.universe + std::max(0.0, away * away - d.of_the_mean);
  c.phi_at_cut = signal + d.absolute > 0 ? signal / (signal + d.absolute) : 0.0;
  constexpr int k_steps = 2000;
  constexpr double k_tails = 8;
  const double sd = std::sqrt(d.universe), error = d.absolute_sem;
  double weights = 0;
  for (int i = 0; i <= k_steps; ++i) {  // over the candidates' true marks
    const double z = k_tails * (2.0 * i / k_steps - 1);
    const double weight = std::exp(-0.5 * z * z), truth = away + sd * z;
    const double above = error > 0 ? normal_cdf(truth / error) : truth >= 0 ? 1.0 : 0.0;
    weights += weight;
    c.consistency += weight * (above * above + (1 - above) * (1 - above));
    c.accuracy += weight * (truth >= 0 ? above : 1 - above);
  }
  c.consistency /= weights;
  c.accuracy /= weights;
  return c;
}

namespace {

/// The middle 95 of 100 of what was found, and what was estimated.
std::pair<double, double> middle_of(const std::vector<double>& found, double estimate) {
  constexpr double k_tail = 0.025;
  return {std::min(estimate, quantile(found, k_tail)),
          std::max(estimate, quantile(found, 1 - k_tail))};
}

}  // namespace

StudyRanges study_ranges(const VarianceStudy& study, const VarianceComponents& estimate,
                         std::span<const MarkShares> circuits, int draws, std::uint64_t seed) {
  VarianceComponents drawn_from = estimate;
  for (double& v : drawn_from.variance) v = std::max(0.0, v);
  const StudyDesign& design = study.design();
  const double persons = study.marking().persons();
  const std::vector<double> seen = study.expected_squares(estimate.variance),
                            expected = study.expected_squares(drawn_from.variance);
  const std::size_t effects = design.effects.size();
  std::vector<std::vector<double>> variance(effects), g(circuits.size()), phi(circuits.size());
  Random seeds(seed);
  for (int i = 0; i < draws; ++i) {
    const std::vector<double> again = study.squares(study.draw(drawn_from, seeds.next()));
    const std::vector<double> estimated = study.variances_of(again);
    std::vector<double> likely(effects);
    for (std::size_t k = 0; k < effects; ++k) {
      variance[k].push_back(estimated[k]);
      // A chi square by its freedom where marks are balanced; else the squares may come out below
      // 0, and their distance counts.
      const bool ratio = seen[k] >= 0 && expected[k] > 0 && again[k] > 0;
      likely[k] = ratio ? seen[k] * expected[k] / again[k] : seen[k] - (again[k] - expected[k]);
    }
    VarianceComponents truth{study.variances_of(likely), 0};
    double largest = 0;
    for (const double v : truth.variance) largest = std::max(largest, std::fabs(v));
    for (double& v : truth.variance)
      if (std::fabs(v) <= 1e-12 * largest) v = 0;  // what rounding left
    for (std::size_t c = 0; c < circuits.size(); ++c) {
      const Dependability d = dependability(design, truth, circuits[c], persons);
      g[c].push_back(d.g);
      phi[c].push_back(d.phi);
    }
  }
  StudyRanges ranges;
  for (std::size_t c = 0; c < circuits.size(); ++c) {
    const Dependability d = dependability(design, drawn_from, circuits[c], persons);
    const auto of_g = middle_of(g[c], d.g), of_phi = middle_of(phi[c], d.phi);
    ranges.circuits.push_back({of_g.first, of_g.second, of_phi.first, of_phi.second});
  }
  for (const auto& v : variance) ranges.error.push_back(std::sqrt(cavum::variance(v)));
  return ranges;
}

}  // namespace cavum::cohort
