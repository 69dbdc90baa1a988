#include "engine/explain/inference/heldout.h"

#include <algorithm>
#include <cmath>

#include "engine/base/random.h"
#include "engine/explain/inference/search.h"
#include "engine/statistics/independent_runs.h"

namespace cavum::explain {
namespace {

constexpr std::size_t k_rivals = 3;  // refined in each fold

/// Causes found without one fold: `view` gives that fold no weight.
std::vector<Term> search_without(const View& view, const Scores& whole, const Null& null, int fold, std::size_t count) {
  std::vector<Term> causes;
  View now = view;
  for (std::size_t step = 0; step < count; ++step) {
    Scores scores = whole;
    scores.candidates = candidates_of(now, fold);
    const Judgement j = judge(scores, null);
    std::vector<std::pair<double, const Candidate*>> found;
    for (std::size_t m = 0; m < scores.candidates.size(); ++m)
      if (scores.candidates[m].testable && j.p_value[m] < k_alpha) found.emplace_back(-scores.candidates[m].gain, &scores.candidates[m]);
    if (found.empty()) break;
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    double least = 1e300;
    std::vector<Term> best;
    for (std::size_t i = 0; i < std::min(k_rivals, found.size()); ++i) {
      std::vector<Term> trial = causes;
      now.causes = causes;
      trial.push_back(start_of(now, *found[i].second));
      trial = refine(now, trial, 1, causes.size());
      const double chi2 = penalised_chi2(now, trial);
      if (chi2 < least) least = chi2, best = trial;
    }
    causes = best;
    if (step + 1 == count) break;
    // further steps see the products with this cause at its point of the grid
    const Candidate* chosen = nullptr;
    for (const auto& f : found)
      if (f.second->hypothesis.term.mechanism == causes.back().mechanism) chosen = f.second;
    now = without_pulling(now, causes);
    now.known.push_back(chosen->hypothesis);
    now.causes = causes;
  }
  return causes;
}

/// A phase is no property of the rig: where a mechanism has one for each session, the others give the amplitude, and the phase comes from the
/// rows [begin, end) that are left out.
void fill_phases(const View& view, const std::vector<Term>& causes, Eigen::Index begin, Eigen::Index end, Eigen::VectorXd& value) {
  Eigen::Index at = 2;
  for (const auto& term : causes) {
    const Mechanism& m = mechanism_at(term.mechanism);
    const Columns c = m.columns(view.scene, term.shape);
    const auto count = static_cast<Eigen::Index>(c.own.size()), first = at;
    at += count;
    if (!m.by_session || count <= 2) continue;
    double amplitude = 0.0, others = 0.0;
    for (Eigen::Index i = 0; i + 1 < count; i += 2)
      if (const double a = std::hypot(value[first + i], value[first + i + 1]); a > 0.0) amplitude += a, others += 1.0;
    const Series left = (view.force_n - force_of(view.scene, causes, value)).segment(begin, end - begin);
    for (Eigen::Index i = 0; i + 1 < count && others > 0.0; i += 2) {
      const Series sine = c.own[static_cast<std::size_t>(i)].segment(begin, end - begin),
                   cosine = c.own[static_cast<std::size_t>(i + 1)].segment(begin, end - begin);
      const double a = (left * sine).sum(), b = (left * cosine).sum(), size = std::hypot(a, b);
      if (!(size > 0.0) || value[first + i] != 0.0) continue;
      value[first + i] = amplitude / others * a / size;
      value[first + i + 1] = amplitude / others * b / size;
    }
  }
}

}  // namespace

Gain heldout_gain(const View& first, const Scores& scores, const Null& null, std::size_t count, double noise_floor_n) {
  const std::size_t folds = first.folds.size();
  std::vector<double> base(folds, 0.0), extended(folds, 0.0), rows(folds, 0.0);
  independent_runs(folds, [&](std::size_t f) {
    View masked = first;
    const auto [begin, end] = first.folds[f];
    masked.robust.segment(begin, end - begin) = 0.0;
    const auto causes = count > 0 ? search_without(masked, scores, null, static_cast<int>(f), count) : std::vector<Term>{};
    const auto error2 = [&](const std::vector<Term>& terms) {
      const View seen = terms.empty() ? masked : without_pulling(masked, terms);
      Eigen::VectorXd value = fit_terms(seen, terms).value;
      fill_phases(seen, terms, begin, end, value);
      const Series model = force_of(seen.scene, terms, value);
      return (first.force_n - model).segment(begin, end - begin).square().sum();
    };
    base[f] = error2({});
    extended[f] = causes.empty() ? base[f] : error2(causes);
    rows[f] = static_cast<double>(end - begin);
  });
  const auto rmse = [&](const std::vector<double>& e, const std::vector<std::size_t>& which) {
    double sum = 0.0, n = 0.0;
    for (const std::size_t f : which) sum += e[f], n += rows[f];
    return std::sqrt(sum / std::max(1.0, n));
  };
  std::vector<std::size_t> all(folds);
  for (std::size_t i = 0; i < folds; ++i) all[i] = i;
  Gain g;
  g.base_rmse_n = rmse(base, all);
  g.extended_rmse_n = rmse(extended, all);
  g.noise_floor_n = noise_floor_n;
  g.percent.value = 100.0 * (1.0 - g.extended_rmse_n / std::max(1e-300, g.base_rmse_n));
  std::vector<double> resampled;
  Random random(1);
  for (int i = 0; i < 500; ++i) {
    std::vector<std::size_t> which;
    for (std::size_t k = 0; k < folds; ++k) which.push_back(random.below(folds));
    resampled.push_back(100.0 * (1.0 - rmse(extended, which) / std::max(1e-300, rmse(base, which))));
  }
  std::sort(resampled.begin(), resampled.end());
  g.percent.low = std::min(g.percent.value, resampled[12]);
  g.percent.high = std::max(g.percent.value, resampled[487]);
  const double could = g.base_rmse_n - noise_floor_n;
  g.share_percent = could > 0.0 ? std::clamp(100.0 * (g.base_rmse_n - g.extended_rmse_n) / could, 0.0, 100.0) : 0.0;
  return g;
}

}  // namespace cavum::explain
