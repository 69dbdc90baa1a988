#include "engine/lab/explain/inference/structure.h"

#include <algorithm>
#include <cmath>

namespace cavum::explain {
namespace {

/// Force that the columns of a curve add when they are fitted beside the model: coefficients by the
/// products, columns unwhitened again.
struct Fitted {
  double gain = 0;
  Eigen::VectorXd value;
};

Fitted fit_adjacent(const View& v, const std::vector<const Hypothesis*>& known,
                    const CurveHypothesis& c) {
  Hypothesis h;
  h.term.mechanism = 0;
  h.first = c.first;
  h.own = c.count;
  std::vector<const Hypothesis*> model = known;
  const double before = fit(*v.products, model).chi2;
  model.push_back(&h);
  const FitResult f = fit(*v.products, model);
  Eigen::Index at = 2;
  for (const auto* k : known) at += k->coefficients();
  return {before - f.chi2, f.value.segment(at, c.count)};
}

/// Root mean square of a curve's force.
double effect_n(const CurveHypothesis& c, const Eigen::VectorXd& value) {
  return std::sqrt(std::max(0.0, value.dot(c.mean_products * value)));
}

}  // namespace

std::vector<Structure> structures(const View& v) {
  const std::vector<const Hypothesis*> known = known_of(v);
  std::vector<Structure> out;
  for (const auto& c : v.curves) {
    const Fitted f = fit_adjacent(v, known, c);
    const double gain = f.gain - k_parameter_penalty * static_cast<double>(c.count - 1);
    if (out.empty() || out.back().variable != c.variable)
      out.push_back({c.variable, {}, -1e300, 0, 0});
    if (gain > out.back().gain)
      out.back() = {c.variable, c.form, gain, f.gain, effect_n(c, f.value)};
  }
  return out;
}

}  // namespace cavum::explain
