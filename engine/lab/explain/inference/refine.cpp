#include <algorithm>
#include <cmath>
#include <string>

#include "engine/lab/explain/inference/search.h"

namespace cavum::explain {

Term start_of(TermFits& fits, const std::vector<Term>& others, const Candidate& c) {
  Term term = c.hypothesis.term;
  if (c.hypothesis.scale >= 0.999 || (c.hypothesis.spring < 0 && c.hypothesis.damper < 0))
    return term;
  // the scale stands for a shape between this point and none: try some, keep the best
  const Mechanism& m = mechanism_at(term.mechanism);
  const std::vector<ShapeRange> ranges = ranges_of(m, *fits.view().scene);
  Term best = term;
  double least = 1e300;
  for (const double part : {1.0, 0.5, 0.25, 0.12, 0.06, 0.03, 2.0, 4.0, 8.0}) {
    Term trial = term;
    for (std::size_t i = 0; i < m.shape.size(); ++i) {
      if (!m.shape[i].fitted || term.shape[i] == 0.0) continue;
      const bool power = std::string(m.shape[i].name) == "m" || std::string(m.shape[i].name) == "n";
      trial.shape[i] = std::clamp(power ? 1.0 + (term.shape[i] - 1.0) * part : term.shape[i] * part,
                                  ranges[i].low, ranges[i].high);
    }
    std::vector<Term> causes = others;
    causes.push_back(trial);
    const double chi2 = fits.fit(causes).chi2;
    if (chi2 < least) least = chi2, best = trial;
  }
  return best;
}

std::vector<Term> refine(TermFits& fits, std::vector<Term> causes, int cycles, std::size_t first) {
  double best = fits.fit(causes).chi2;
  std::vector<std::vector<double>> width(causes.size());
  for (std::size_t i = 0; i < causes.size(); ++i)
    for (const auto& s : mechanism_at(causes[i].mechanism).shape)
      width[i].push_back(std::string(s.name) == "frequency_hz" ? 4e-3
                         : std::string(s.name) == "rate_ratio" ? 1e-5
                         : s.logarithmic                       ? 0.35
                                                               : 0.1);
  for (int cycle = 0; cycle < cycles; ++cycle)
    for (std::size_t i = first; i < causes.size(); ++i) {
      const std::vector<ShapeRange> ranges =
          ranges_of(mechanism_at(causes[i].mechanism), *fits.view().scene);
      for (std::size_t s = 0; s < ranges.size(); ++s) {
        if (!ranges[s].fitted || causes[i].shape[s] == 0.0) continue;
        const auto moved = [&](double by) {
          auto trial = causes;
          double& x = trial[i].shape[s];
          x = std::clamp(ranges[s].logarithmic ? x * std::exp(by) : x + by, ranges[s].low,
                         ranges[s].high);
          return trial;
        };
        // a parabola through three points, or a step downhill; the width follows
        double& w = width[i][s];
        for (int step = 0; step < 5; ++step) {
          const auto up = moved(w), down = moved(-w);
          const double a = fits.fit(up).chi2, b = fits.fit(down).chi2;
          const double curve = a + b - 2 * best;
          double by = curve > 0.0 ? std::clamp(0.5 * w * (b - a) / curve, -2.0 * w, 2.0 * w)
                      : a < b     ? 2.0 * w
                                  : -2.0 * w;
          const auto trial = moved(by);
          const double c = fits.fit(trial).chi2;
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
