#include "grading/cohort/variance_components.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/random.h"
#include "engine/statistics/order.h"
#include "engine/statistics/statistics.h"
#include "grading/cohort/square_matrix.h"

namespace cavum::cohort {
namespace {

constexpr std::size_t k_most_facets = 5;

/// The group of each mark under an effect, numbered as they come.
std::vector<std::uint32_t> groups_under(std::uint32_t effect, std::span<const StudyMark> marks) {
  std::map<std::vector<std::uint32_t>, std::uint32_t> number;
  std::vector<std::uint32_t> group;
  for (const StudyMark& m : marks) {
    std::vector<std::uint32_t> key;
    for (std::size_t f = 0; f < m.level.size(); ++f)
      if ((effect >> f & 1U) != 0) key.push_back(m.level[f]);
    group.push_back(number.try_emplace(std::move(key), static_cast<std::uint32_t>(number.size())).first->second);
  }
  return group;
}

/// Sum over groups of the square of their sum by their size.
double sum_of_squares(const std::vector<std::uint32_t>& group, const std::vector<double>& size, std::span<const double> values) {
  std::vector<double> sum(size.size());
  for (std::size_t i = 0; i < group.size(); ++i) sum[group[i]] += values[i];
  double total = 0;
  for (std::size_t g = 0; g < sum.size(); ++g) total += sum[g] * sum[g] / size[g];
  return total;
}

/// How much of an effect of variance 1 stands in the sum of squares over these groups.
double expected(const std::vector<std::uint32_t>& group, const std::vector<double>& size, const std::vector<std::uint32_t>& effect) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> both;
  for (std::size_t i = 0; i < group.size(); ++i) both[{group[i], effect[i]}] += 1;
  double total = 0;
  for (const auto& [at, n] : both) total += n * n / size[at.first];
  return total;
}

}  // namespace

std::string StudyDesign::effect_name(std::size_t effect) const {
  // A facet that never stands without another one is nested in it.
  const auto always_with = [&](std::size_t inner, std::size_t outer) {
    return std::all_of(effects.begin(), effects.end(), [&](std::uint32_t e) { return (e >> inner & 1U) == 0 || (e >> outer & 1U) != 0; });
  };
  std::string name;
  const std::uint32_t e = effects[effect];
  for (std::size_t f = 0; f < facets.size(); ++f) {
    if ((e >> f & 1U) == 0) continue;
    std::string part = facets[f];
    bool holds_inner = false;
    for (std::size_t o = 1; o < facets.size(); ++o) {
      if (o == f) continue;
      if (always_with(f, o)) part += ":" + facets[o];
      holds_inner = holds_inner || ((e >> o & 1U) != 0 && always_with(o, f));
    }
    if (!holds_inner) name += (name.empty() ? "" : " x ") + part;
  }
  return name;
}

StudyDesign crossed_design(std::vector<std::string> facets) {
  if (facets.size() < 2 || facets.size() > k_most_facets)
    throw Error("a study", "needs one to four facets beside the candidates", "name tasks, raters, stations");
  StudyDesign design{std::move(facets), {}};
  const auto sets = static_cast<std::uint32_t>(1U << design.facets.size());
  for (std::uint32_t e = 1; e < sets; ++e) design.effects.push_back(e);
  std::stable_sort(design.effects.begin(), design.effects.end(),
                   [](std::uint32_t a, std::uint32_t b) { return std::popcount(a) < std::popcount(b); });
  return design;
}

StudyDesign nested_design(const std::string& persons, const std::string& outer, const std::string& inner) {
  return {{persons, outer, inner}, {0b001, 0b010, 0b110, 0b011, 0b111}};
}

VarianceStudy::VarianceStudy(StudyDesign design, std::span<const StudyMark> marks) : design_(std::move(design)), marks_(marks.size()) {
  for (const StudyMark& m : marks)
    if (m.level.size() != design_.facets.size()) throw Error("a mark", "has another number of conditions than the study has facets", "");
  for (const std::uint32_t e : design_.effects) {
    group_.push_back(groups_under(e, marks));
    std::vector<double> size;
    for (const std::uint32_t g : group_.back()) {
      if (g >= size.size()) size.resize(g + 1);
      size[g] += 1;
    }
    size_.push_back(std::move(size));
  }
  if (!size_.empty() && size_.back().size() != marks_)
    throw Error("two marks", "stand for the same candidate under the same conditions", "keep one of them");
  const std::size_t n = design_.effects.size();
  const std::vector<std::uint32_t> all(marks_, 0);
  const std::vector<double> all_size{static_cast<double>(marks_)};
  std::vector<std::vector<double>> a(n + 1, std::vector<double>(n + 1, static_cast<double>(marks_)));
  for (std::size_t i = 0; i <= n; ++i)
    for (std::size_t k = 0; k < n; ++k) a[i][k] = i < n ? expected(group_[i], size_[i], group_[k]) : expected(all, all_size, group_[k]);
  auto inverse = inverted(std::move(a));
  if (!inverse)
    throw Error("these marks", "cannot tell all effects apart", "a study needs two conditions of each facet, and candidates who share them");
  inverse_ = std::move(*inverse);
}

VarianceComponents VarianceStudy::estimate(std::span<const double> values) const {
  const double middle = mean(values);
  std::vector<double> from_middle(values.begin(), values.end());  // the sums of squares then lose no digits
  for (double& v : from_middle) v -= middle;
  double mean_square = 0;
  for (const double v : from_middle) mean_square += v * v / static_cast<double>(marks_);
  const double rounding = 1e-12 * mean_square + 1e-24 * middle * middle;
  const std::size_t n = design_.effects.size();
  std::vector<double> t(n + 1);
  for (std::size_t i = 0; i < n; ++i) t[i] = sum_of_squares(group_[i], size_[i], from_middle);
  VarianceComponents found{std::vector<double>(n), middle};
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = 0; i <= n; ++i) found.variance[k] += inverse_[k][i] * t[i];
    if (std::fabs(found.variance[k]) <= rounding) found.variance[k] = 0;
  }
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

Dependability dependability(const StudyDesign& design, const VarianceComponents& components, const CircuitPlan& plan, double persons) {
  if (plan.conditions.size() + 1 != design.facets.size()) throw Error("the plan of a circuit", "has another number of facets than the study", "");
  for (const double n : plan.conditions)
    if (!(n >= 1)) throw Error("the plan of a circuit", "has fewer than one condition of a facet", "plan at least one");
  Dependability d;
  for (std::size_t k = 0; k < design.effects.size(); ++k) {
    const std::uint32_t e = design.effects[k];
    double share = std::max(0.0, components.variance[k]);
    bool random = false;
    for (std::size_t f = 1; f < design.facets.size(); ++f) {
      if ((e >> f & 1U) == 0) continue;
      share /= plan.conditions[f - 1];
      random = random || plan.fixed.empty() || !plan.fixed[f - 1];
    }
    const bool of_persons = (e & 1U) != 0;
    if (of_persons && !random) d.universe += share;
    if (of_persons && random) d.relative += share;
    if (random) d.absolute += share;
    if (of_persons || random) d.of_the_mean += of_persons ? share / persons : share;
  }
  const auto ratio = [&](double error) { return d.universe + error > 0 ? d.universe / (d.universe + error) : 0.0; };
  d.g = ratio(d.relative);
  d.phi = ratio(d.absolute);
  d.relative_sem = std::sqrt(d.relative);
  d.absolute_sem = std::sqrt(d.absolute);
  return d;
}

void require_differences(const StudyDesign& design, const VarianceComponents& components) {
  const auto there = [&](bool of_persons) {
    for (std::size_t k = 0; k < design.effects.size(); ++k)
      if (((design.effects[k] & 1U) != 0) == of_persons && components.variance[k] > 0) return true;
    return false;
  };
  if (there(true)) return;
  if (!there(false))
    throw Error("these marks", "are all alike: nothing varies, and nothing tells how dependable they are", "study marks that differ");
  throw Error("these marks", "differ by their conditions alone: no variance is of the candidates, and nothing tells how dependable theirs are",
              "study candidates who differ");
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

DependabilityRange dependability_range(const VarianceStudy& study, const VarianceComponents& estimate, const CircuitPlan& plan, double persons,
                                       int draws, std::uint64_t seed) {
  VarianceComponents drawn_from = estimate;
  for (double& v : drawn_from.variance) v = std::max(0.0, v);
  const Dependability d = dependability(study.design(), drawn_from, plan, persons);
  Random seeds(seed);
  std::vector<double> g, phi;
  std::vector<std::vector<double>> variance(study.design().effects.size());
  for (int i = 0; i < draws; ++i) {
    const VarianceComponents again = study.estimate(study.draw(drawn_from, seeds.next()));
    for (std::size_t k = 0; k < variance.size(); ++k) variance[k].push_back(again.variance[k]);
    const Dependability a = dependability(study.design(), again, plan, persons);
    // As estimated, the candidates' variance below 0 too: 1 - g is then above 1, as the analysis of variance has it.
    double universe = a.universe;
    for (std::size_t k = 0; k < variance.size(); ++k)
      if (study.design().effects[k] == 1U) universe += std::min(0.0, again.variance[k]);
    const auto unsure = [&](double error) { return universe + error > 0 ? error / (universe + error) : 1e9; };
    g.push_back(unsure(a.relative) / std::max(1e-12, 1 - d.g));
    phi.push_back(unsure(a.absolute) / std::max(1e-12, 1 - d.phi));
  }
  constexpr double k_tail = 0.025;
  const auto bound = [&](const std::vector<double>& ratios, double coefficient, double share) {
    return std::clamp(1 - (1 - coefficient) / std::max(1e-12, quantile(ratios, share)), 0.0, 1.0);
  };
  DependabilityRange range{bound(g, d.g, k_tail), bound(g, d.g, 1 - k_tail), bound(phi, d.phi, k_tail), bound(phi, d.phi, 1 - k_tail), {}};
  for (const auto& v : variance) range.error.push_back(std::sqrt(cavum::variance(v)));
  return range;
}

}  // namespace cavum::cohort
