#include "engine/explain/inference/search.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <string>

#include "engine/explain/inference/twin.h"
#include "engine/statistics/independent_runs.h"

namespace cavum::explain {
namespace {

constexpr double k_testable = 0.05;  // of a column's norm left beside k and c, docs/physics.md section 13
constexpr double k_scales[] = {0.04, 0.12, 0.3, 0.55, 0.8, 1.0, 1.3};
constexpr double k_twin_doubt = 2.0;
constexpr double k_expected_gain = 12.0;  // of the best of a grid, or of a curve of five parameters, in noise alone
constexpr double k_least_width = 0.35, k_least_top = 1.5;
constexpr double k_blur_gain = 12.0;
constexpr double k_plain_trials = 200.0;  // hypotheses of the grids and curves, about
constexpr double k_noise_gain = 3.0;      // what the best of a mechanism's grid gains in noise alone, about

/// Share of the norm of `h`'s force that k and c cannot take over.
double share_left(const View& v, const Hypothesis& h) {
  const Eigen::MatrixXd& g = v.products.all;
  const auto share = [&](auto product, double norm2) {
    // residual of a column on columns 1 and 2
    const double a = g(1, 1), b = g(1, 2), c = g(2, 2), p = product(1), q = product(2);
    const double det = a * c - b * b;
    const double taken = det > 1e-9 * a * c ? (c * p * p - 2 * b * p * q + a * q * q) / det : a > 0.0 ? p * p / a : 0.0;
    return norm2 > 0.0 ? std::sqrt(std::max(0.0, norm2 - taken) / norm2) : 0.0;
  };
  double best = 0.0;
  for (Eigen::Index i = 0; i < h.own; ++i) {
    const Eigen::Index c = h.first + i;
    best = std::max(best, share([&](Eigen::Index r) { return g(r, c); }, g(c, c)));
  }
  if (h.spring >= 0 || h.damper >= 0) {
    const double k = v.base_fit.value[0], cc = v.base_fit.value[1];
    const auto product = [&](Eigen::Index r) { return (h.spring >= 0 ? k * g(r, h.spring) : 0.0) + (h.damper >= 0 ? cc * g(r, h.damper) : 0.0); };
    const double norm2 = (h.spring >= 0 ? k * product(h.spring) : 0.0) + (h.damper >= 0 ? cc * product(h.damper) : 0.0);
    best = std::max(best, share(product, norm2));
  }
  return best;
}

struct Spread {
  double mean = 0, sd = 0;
};

Spread spread_of(const std::vector<double>& v, std::size_t without) {
  double sum = 0, square = 0, n = 0;
  for (std::size_t i = 0; i < v.size(); ++i)
    if (i != without) sum += v[i], square += v[i] * v[i], n += 1;
  if (n < 1) return {};
  const double mean = sum / n;
  return {mean, n > 1 ? std::sqrt(std::max(0.0, square / n - mean * mean) * n / (n - 1)) : 0.0};
}

double z_of(double gain, const Spread& s, double blur) {
  // Twins are like the data, but not the same: their motion is an estimate, so they show less of what a coarse encoder does at
  // sharp stops. What they gain on average beyond noise may be off by k_twin_doubt, and a blurred recording gains k_blur_gain more.
  return (gain - s.mean) / (s.sd + k_noise_gain + k_blur_gain * blur + k_twin_doubt * std::max(0.0, s.mean - k_expected_gain));
}

}  // namespace

Eigen::Index parameters_of(const Term& term, const Scene& scene) {
  const Mechanism& m = mechanism_at(term.mechanism);
  auto n = static_cast<Eigen::Index>(m.columns(scene, term.shape).own.size());
  if (const auto groups = static_cast<Eigen::Index>(session_groups(*scene.recording)); m.by_session) n = n / groups + groups - 1;
  for (std::size_t i = 0; i < m.shape.size(); ++i) n += m.shape[i].fitted && term.shape[i] != 0.0;
  return n;
}

std::vector<Candidate> candidates_of(const View& v, int left_out) {
  std::vector<Candidate> out(mechanisms().size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i].hypothesis.term.mechanism = static_cast<int>(i), out[i].testable = false;
  const Eigen::MatrixXd sums =
      left_out < 0 ? v.products.all : Eigen::MatrixXd(v.products.all - v.products.by_session[static_cast<std::size_t>(left_out)]);
  std::vector<const Hypothesis*> model = known_of(v);
  const bool one_way = moves_one_way(v.scene.motion);
  const double before = fit(sums, v.products, model, left_out).chi2;
  Eigen::Index own_at = 2;  // of the candidate, after the causes' own coefficients
  for (const auto* h : model) own_at += h->coefficients();
  model.push_back(nullptr);
  for (const auto& h : v.grid) {
    Candidate& c = out[static_cast<std::size_t>(h.term.mechanism)];
    // an offset in one direction is c in other words, but no other cause may be named for want of it
    const bool offset = one_way && mechanism_at(h.term.mechanism).one_way == OneWay::is_offset;
    if (!offset && share_left(v, h) < k_testable) continue;
    c.testable = true;
    if (std::any_of(v.causes.begin(), v.causes.end(), [&](const Term& t) { return law_of(t.mechanism) == law_of(h.term.mechanism); })) continue;
    const bool changes = h.spring >= 0 || h.damper >= 0;
    for (const double scale : k_scales) {
      if (!changes && scale != 1.0) continue;
      Hypothesis trial = h;
      trial.scale = scale;
      model.back() = &trial;
      const FitResult f = fit(sums, v.products, model, left_out);
      if (!makes_sense(mechanism_at(h.term.mechanism), f.value.data() + own_at, static_cast<std::size_t>(h.coefficients()))) continue;
      const double gain = before - f.chi2 - k_parameter_penalty * static_cast<double>(h.parameters() - 1);
      if (gain > c.gain) {
        c.gain = gain;
        c.raw_gain = before - f.chi2;
        c.hypothesis = trial;
      }
    }
  }
  return out;
}

Scores scores_of(const View& view) { return {candidates_of(view), structures(view), 1.0 - view.scene.weight.mean()}; }

double best_pair_gain(const View& v, const std::vector<Candidate>& candidates) {
  std::vector<const Hypothesis*> model = known_of(v);
  const double before = fit(v.products, model).chi2;
  const std::size_t n = model.size();
  model.resize(n + 2);
  double best = -1e300;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      if (candidates[i].gain < 0.0 || candidates[j].gain < 0.0) continue;
      model[n] = &candidates[i].hypothesis;
      model[n + 1] = &candidates[j].hypothesis;
      const auto extra = static_cast<double>(model[n]->parameters() + model[n + 1]->parameters() - 1);
      best = std::max(best, before - fit(v.products, model).chi2 - k_parameter_penalty * extra);
    }
  return best;
}

void add_twins(Null& null, const View& view, std::size_t count, std::uint64_t seed, const Series* fixed_n, const std::function<void()>& done) {
  const std::size_t first = null.twins.size();
  if (count <= first) return;
  null.twins.resize(count);
  null.values.resize(count);
  independent_runs(count - first, [&](std::size_t i) {
    const Recording twin = make_twin(view, seed + 0x9e3779b97f4a7c15ULL * (first + i + 1));
    ViewOptions options;
    options.fixed_n = fixed_n;
    const View seen = make_view(twin, estimate_motion(twin), view.causes, {}, options);
    null.twins[first + i] = scores_of(seen);
    null.values[first + i] = fit(seen.products, known_of(seen)).value;
    if (done) done();
  });
}

Judgement judge(const Scores& data, const Null& null) {
  const std::size_t mechanisms_n = data.candidates.size(), entries = mechanisms_n + data.structures.size();
  const std::size_t n = null.twins.size();
  const auto gain_in = [&](const Scores& s, std::size_t e) {
    if (e < mechanisms_n) return std::max(0.0, s.candidates[e].raw_gain);
    const std::string& name = data.structures[e - mechanisms_n].variable;
    for (const auto& structure : s.structures)
      if (structure.variable == name) return std::max(0.0, structure.raw_gain);
    return 0.0;
  };
  std::vector<double> largest(n, -1e300);
  Judgement j;
  double gained = 0.0;
  if (n == 0) {  // the plain rule: as if noise alone could gain anything, times the number of things that are tried
    for (std::size_t e = 0; e < entries; ++e) {
      const double gain = e < mechanisms_n ? data.candidates[e].raw_gain : data.structures[e - mechanisms_n].raw_gain;
      j.z.push_back(gain / k_noise_gain);
      j.p_value.push_back(std::min(1.0, k_plain_trials * std::exp(-0.5 * std::max(0.0, gain))));
    }
    return j;
  }
  for (std::size_t e = 0; e < entries; ++e) {
    std::vector<double> twins(n);
    for (std::size_t t = 0; t < n; ++t) twins[t] = gain_in(null.twins[t], e);
    // a twin is judged by the others, as the data are
    for (std::size_t t = 0; t < n; ++t) largest[t] = std::max(largest[t], z_of(twins[t], spread_of(twins, t), data.blur));
    const Spread all = spread_of(twins, n);
    j.z.push_back(z_of(gain_in(data, e), all, data.blur));
    if (e < mechanisms_n) gained += all.mean;
  }
  j.inflation = std::max(1.0, gained / static_cast<double>(mechanisms_n) / k_noise_gain);
  const Spread top = spread_of(largest, n);
  // Gumbel by moments; never less than what z in honest units would be, for the doubt in z's denominator shrinks the twins' z too
  const double width = std::max(k_least_width, top.sd * std::sqrt(6.0) / 3.14159265358979), at = std::max(k_least_top, top.mean - 0.5772 * width);
  for (const double z : j.z) j.p_value.push_back(-std::expm1(-std::exp(-(z - at) / width)));
  return j;
}

Term start_of(const View& v, const Candidate& c) {
  Term term = c.hypothesis.term;
  if (c.hypothesis.scale >= 0.999 || (c.hypothesis.spring < 0 && c.hypothesis.damper < 0)) return term;
  // the scale stands for a shape between this point and none: try some, keep the best
  const Mechanism& m = mechanism_at(term.mechanism);
  Term best = term;
  double least = 1e300;
  for (const double part : {1.0, 0.5, 0.25, 0.12, 0.06, 0.03, 2.0, 4.0, 8.0}) {
    Term trial = term;
    for (std::size_t i = 0; i < m.shape.size(); ++i) {
      if (!m.shape[i].fitted || term.shape[i] == 0.0) continue;
      const bool power = std::string(m.shape[i].name) == "m" || std::string(m.shape[i].name) == "n";
      trial.shape[i] = std::clamp(power ? 1.0 + (term.shape[i] - 1.0) * part : term.shape[i] * part, m.shape[i].low, m.shape[i].high);
    }
    std::vector<Term> causes = v.causes;
    causes.push_back(trial);
    const double chi2 = fit_terms(v, causes).chi2;
    if (chi2 < least) least = chi2, best = trial;
  }
  return best;
}

double penalised_chi2(const View& v, const std::vector<Term>& causes) {
  double penalty = 0.0;
  for (const auto& t : causes) penalty += k_parameter_penalty * static_cast<double>(parameters_of(t, v.scene));
  return fit_terms(v, causes).chi2 + penalty;
}

std::vector<Term> refine(const View& v, std::vector<Term> causes, int cycles, std::size_t first) {
  double best = fit_terms(v, causes).chi2;
  std::vector<std::vector<double>> width(causes.size());
  for (std::size_t i = 0; i < causes.size(); ++i)
    for (const auto& s : mechanism_at(causes[i].mechanism).shape)
      width[i].push_back(std::string(s.name) == "frequency_hz" ? 4e-3 : std::string(s.name) == "rate_ratio" ? 1e-5 : s.logarithmic ? 0.35 : 0.1);
  for (int cycle = 0; cycle < cycles; ++cycle)
    for (std::size_t i = first; i < causes.size(); ++i) {
      const auto& ranges = mechanism_at(causes[i].mechanism).shape;
      for (std::size_t s = 0; s < ranges.size(); ++s) {
        if (!ranges[s].fitted || causes[i].shape[s] == 0.0) continue;
        const auto moved = [&](double by) {
          auto trial = causes;
          double& x = trial[i].shape[s];
          x = std::clamp(ranges[s].logarithmic ? x * std::exp(by) : x + by, ranges[s].low, ranges[s].high);
          return trial;
        };
        // a parabola through three points, or a step downhill; the width follows
        double& w = width[i][s];
        for (int step = 0; step < 5; ++step) {
          const auto up = moved(w), down = moved(-w);
          const double a = fit_terms(v, up).chi2, b = fit_terms(v, down).chi2;
          const double curve = a + b - 2 * best;
          double by = curve > 0.0 ? std::clamp(0.5 * w * (b - a) / curve, -2.0 * w, 2.0 * w) : a < b ? 2.0 * w : -2.0 * w;
          const auto trial = moved(by);
          const double c = fit_terms(v, trial).chi2;
          double least = best;
          std::vector<Term> next = causes;
          if (a < least) least = a, next = up;
          if (b < least) least = b, next = down;
          if (c < least) least = c, next = trial;
          const double fell = best - least;
          causes = next;
          best = least;
          w = std::fabs(by) < w ? std::max(0.25 * w, 2.0 * std::fabs(by)) : w;
          if (fell < 0.02 && w < 0.1) break;
          if (fell <= 0.0) w *= 0.4;
        }
      }
    }
  return causes;
}

}  // namespace cavum::explain
