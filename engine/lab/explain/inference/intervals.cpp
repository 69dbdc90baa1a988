#include "engine/lab/explain/inference/intervals.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace cavum::explain {
namespace {

constexpr double k_same_chi2 = 10.0;   // another variant of the formula this close fits as well
constexpr double k_normal = 1.959964;  // of 95 %

/// Parameters of all causes, then k and c, from shapes and a fit with tangents (or without:
/// tangents 0).
std::vector<std::vector<NamedValue>> named_values(const View& v, const Eigen::VectorXd& value) {
  std::vector<std::vector<NamedValue>> out;
  Eigen::Index own_at = 2, tangent_at = 2;
  for (const auto& h : v.known) tangent_at += h.coefficients();
  const Base base{value[0], value[1]};
  for (const auto& h : v.known) {
    const Mechanism& m = mechanism_at(h.term.mechanism);
    std::vector<double> own(value.data() + own_at, value.data() + own_at + h.coefficients()),
        shape = h.term.shape;
    own_at += h.coefficients();
    for (std::size_t s = 0; s < shape.size(); ++s) {
      if (!m.shape[s].fitted || shape[s] == 0.0 || tangent_at >= value.size()) continue;
      shape[s] = std::clamp(shape[s] + value[tangent_at++], m.shape[s].low, m.shape[s].high);
    }
    out.push_back(m.parameters(shape, own, base));
  }
  out.push_back({{"k_n_per_mm", base.k_n_per_mm}, {"c_n_s_per_mm", base.c_n_s_per_mm}});
  return out;
}

/// 95 % quantile of Student's t (Cornish and Fisher's expansion).
double student(double freedom) {
  const double z = k_normal, z3 = z * z * z;
  return z + (z3 + z) / (4.0 * freedom) +
         (5.0 * z3 * z * z + 16.0 * z3 + 3.0 * z) / (96.0 * freedom * freedom);
}

/// Of one value, from the same value found without each session in turn.
double jackknife_sd(const std::vector<double>& without) {
  const auto n = static_cast<double>(without.size());
  double mean = 0.0, square = 0.0;
  for (const double w : without) mean += w / n;
  for (const double w : without) square += (w - mean) * (w - mean);
  return std::sqrt((n - 1.0) / n * square);
}

/// Other variants of cause `c` (shapes that are tried and not fitted) that fit as well, each with
/// its parameters.
std::vector<std::vector<NamedValue>> other_forms(const View& v, std::size_t c, double inflation) {
  std::vector<std::vector<NamedValue>> out;
  const Term& term = v.causes[c];
  const Mechanism& m = mechanism_at(term.mechanism);
  const auto variant_of = [&](const std::vector<double>& shape) {
    std::vector<double> variant;
    for (std::size_t i = 0; i < shape.size(); ++i)
      variant.push_back(m.shape[i].fitted ? (shape[i] == 0.0 ? 0.0 : 1.0) : shape[i]);
    return variant;
  };
  std::vector<std::vector<double>> tried{variant_of(term.shape)};
  std::vector<Term> causes = v.causes;
  TermFits fits(v);
  const double own = fits.fit(causes).chi2;
  const std::vector<std::vector<double>> grid = starts(m, *v.scene);
  for (const auto& point : grid) {
    if (std::find(tried.begin(), tried.end(), variant_of(point)) != tried.end()) continue;
    tried.push_back(variant_of(point));
    double least = 1e300;
    for (const auto& start : grid) {
      if (variant_of(start) != variant_of(point)) continue;
      std::vector<Term> trial = v.causes;
      trial[c].shape = start;
      if (const double chi2 = fits.fit(trial).chi2; chi2 < least) least = chi2, causes = trial;
    }
    if (least > own + 0.2 * (v.products->force_squares - own)) continue;
    causes = refine(fits, causes, 1, c);
    const FitResult f = fits.fit(causes);
    if (f.chi2 > own + k_same_chi2 * inflation) continue;
    Eigen::Index at = 2;
    for (std::size_t i = 0; i < c; ++i) at += v.known[i].coefficients();
    const auto count = m.columns(*v.scene, causes[c].shape).own.size();
    const std::vector<double> values(f.value.data() + at,
                                     f.value.data() + at + static_cast<std::ptrdiff_t>(count));
    if (makes_sense(m, values.data(), count))
      out.push_back(m.parameters(causes[c].shape, values, {f.value[0], f.value[1]}));
  }
  return out;
}

/// Values of all causes' parameters, then of k and c, as the fit has them and found in other ways.
struct Findings {
  using Values = std::vector<std::vector<NamedValue>>;
  Eigen::VectorXd truth;  ///< what the surrogates were made with: shapes as they are, tangents 0
  Values middle;
  std::vector<Values> without,
      surrogates;  ///< without each session in turn; as each surrogate moves them
};

Findings findings_of(const View& v, const FitResult& f, const std::vector<const Hypothesis*>& known,
                     const Null& null) {
  Findings out;
  out.truth = f.value;
  out.truth.head(v.base_fit.value.size()) = v.base_fit.value;
  out.truth.tail(out.truth.size() - v.base_fit.value.size()).setZero();
  out.middle = named_values(v, out.truth);
  const std::size_t folds = v.products->folds.size();
  for (std::size_t s = 0; s < folds && folds > 1; ++s)
    out.without.push_back(named_values(v, fit(*v.products, known, static_cast<int>(s)).value));
  for (Eigen::Index i = 0; i < null.moved.cols(); ++i)
    if (null.moved.rows() == out.truth.size())
      out.surrogates.push_back(named_values(v, out.truth + null.moved.col(i)));
  return out;
}

/// Variance of parameter `p` of cause `c` by the noise alone.
double noise_variance(const View& v, const FitResult& f, const Findings& found, std::size_t c,
                      std::size_t p) {
  const double value = found.middle[c][p].value;
  Eigen::VectorXd slope(found.truth.size());
  for (Eigen::Index i = 0; i < found.truth.size(); ++i) {
    const double step = 1e-3 * std::sqrt(std::max(1e-30, f.covariance(i, i)));
    Eigen::VectorXd moved = found.truth;
    moved[i] += step;
    slope[i] = (named_values(v, moved)[c][p].value - value) / step;
  }
  return std::max(1.0, f.chi2 / std::max(1.0, v.products->rows)) * slope.dot(f.covariance * slope);
}

/// What surrogates scatter by, with their bias added, where that is more than `variance`.
double with_surrogates(double variance, const Findings& found, std::size_t c, std::size_t p) {
  double bias = 0.0, scatter = 0.0;
  const auto n = static_cast<double>(found.surrogates.size());
  for (const auto& surrogate : found.surrogates) {
    const double d = surrogate[c][p].value - found.middle[c][p].value;
    bias += d / n;
    scatter += d * d / n;
  }
  return n > 3.0 ? std::max(variance, (scatter - bias * bias) * n / (n - 1.0)) + bias * bias
                 : variance;
}

/// Half of the 95 % by variance, or by leaving out sessions where that is more.
double half_width(double variance, const Findings& found, std::size_t c, std::size_t p) {
  const double half = k_normal * std::sqrt(std::max(0.0, variance));
  std::vector<double> left;
  for (const auto& w : found.without) left.push_back(w[c][p].value);
  return left.size() > 2
             ? std::max(half, student(static_cast<double>(left.size()) - 1.0) * jackknife_sd(left))
             : half;
}

/// Force of cause `c`, [rows].
Series force_of_cause(const View& v, std::size_t c) {
  auto others = v.causes;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(c));
  Eigen::VectorXd rest(v.base_fit.value.size() - v.known[c].coefficients());
  Eigen::Index to = 0, from = 2;
  rest[to++] = v.base_fit.value[0];
  rest[to++] = v.base_fit.value[1];
  for (std::size_t k = 0; k < v.known.size(); ++k) {
    for (Eigen::Index i = 0; i < v.known[k].coefficients(); ++i, ++from)
      if (k != c) rest[to++] = v.base_fit.value[from];
  }
  return *v.model_n - force_of(*v.scene, others, rest);
}

}  // namespace

void set_parameters(Explanation& e, const View& v, const Null& null, double inflation) {
  const std::vector<const Hypothesis*> known = known_of(v);
  const FitResult f = fit(*v.products, known, -1, true);
  const Findings found = findings_of(v, f, known, null);
  std::vector<std::vector<Interval>> interval(found.middle.size());
  for (std::size_t c = 0; c < found.middle.size(); ++c) {
    const bool is_cause = c < v.causes.size();
    const auto forms = is_cause ? other_forms(v, c, inflation) : Findings::Values{};
    const double open = is_cause && mechanism_at(v.causes[c].mechanism).open
                            ? mechanism_at(v.causes[c].mechanism).open(*v.scene)
                            : 0.0;
    for (std::size_t p = 0; p < found.middle[c].size(); ++p) {
      const auto& [name, value] = found.middle[c][p];
      const double half =
          half_width(with_surrogates(noise_variance(v, f, found, c, p), found, c, p) + open * open,
                     found, c, p);
      Interval out{value, value - half, value + half};
      for (const auto& form : forms)
        for (const auto& other : form)
          if (other.name == name)
            out.low = std::min(out.low, other.value - half),
            out.high = std::max(out.high, other.value + half);
      interval[c].push_back(out);
    }
  }
  for (std::size_t c = 0; c < e.causes.size(); ++c) {
    e.causes[c].parameters.clear();
    for (std::size_t p = 0; p < found.middle[c].size(); ++p)
      e.causes[c].parameters.emplace_back(found.middle[c][p].name, interval[c][p]);
    e.causes[c].force_n = force_of_cause(v, c);
    e.causes[c].effect_n = std::sqrt(e.causes[c].force_n.square().mean());
  }
  e.k = interval.back()[0];
  e.c = interval.back()[1];
}

}  // namespace cavum::explain
