#include "engine/lab/explain/inference/heldout.h"

#include <algorithm>
#include <cmath>

#include "engine/base/independent_runs.h"
#include "engine/base/random.h"
#include "engine/lab/explain/inference/search.h"

namespace cavum::explain {
namespace {

constexpr std::size_t k_rivals = 3;    // refined in each fold
constexpr double k_min_earned = 10.0;  // chi² that a cause must earn

/// Causes found without one fold: `view` gives that fold no weight.
std::vector<Term> search_without(const View& view, const Null& null, int fold, int most) {
  std::vector<Term> causes;
  View now = view;
  for (int step = 0; step < most; ++step) {
    const std::vector<Candidate> candidates = candidates_of(now, fold);
    const Judgement j = judge(now, null, fold);
    std::vector<std::pair<double, const Candidate*>> found;
    for (std::size_t m = 0; m < candidates.size(); ++m)
      if (candidates[m].testable && j.p_value[m] < k_alpha && candidates[m].gain > 0.0)
        found.emplace_back(-candidates[m].gain, &candidates[m]);
    if (found.empty()) break;
    std::sort(found.begin(), found.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    TermFits fits(now);
    double least = penalised_chi2(fits, causes) -
                   k_min_earned * (step > 0 ? 2.0 * j.inflation
                                            : 1.0);  // as the search with all sessions asks
    std::vector<Term> best;
    for (std::size_t i = 0; i < std::min(k_rivals, found.size()); ++i) {
      std::vector<Term> trial = causes;
      trial.push_back(start_of(fits, causes, *found[i].second));
      trial = refine(fits, trial, 1);
      const double chi2 = penalised_chi2(fits, trial);
      if (chi2 < least) least = chi2, best = trial;
    }
    if (best.empty()) break;
    causes = best;
    if (step + 1 == most) break;
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

/// A phase is no property of the rig: where a mechanism has one for each session, the others give
/// the amplitude, and the phase comes from the rows [begin, end) that are left out.
void fill_phases(const View& view, const std::vector<Term>& causes, Eigen::Index begin,
                 Eigen::Index end, Eigen::VectorXd& value) {
  Eigen::Index at = 2;
  for (const auto& term : causes) {
    const Mechanism& m = mechanism_at(term.mechanism);
    const Columns c = m.columns(*view.scene, term.shape);
    const auto count = static_cast<Eigen::Index>(c.own.size()), first = at;
    at += count;
    if (!m.by_session || count <= 2) continue;
    double amplitude = 0.0, others = 0.0;
    for (Eigen::Index i = 0; i + 1 < count; i += 2)
      if (const double a = std::hypot(value[first + i], value[first + i + 1]); a > 0.0)
        amplitude += a, others += 1.0;
    const Series left =
        (*view.force_n - force_of(*view.scene, causes, value)).segment(begin, end - begin);
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

/// Sum of the squares of what `terms`, fitted without the fold, leave in it.
class Folds {
 public:
  Folds(const View& first, const SessionSpread& spread)
      : first_(first), spread_(spread), white_(whitening_of(first)) {}

  [[nodiscard]] View without(std::size_t fold) const {
    View out = first_;
    const auto [begin, end] = first_.folds[fold];
    out.robust.change().segment(begin, end - begin) = 0.0;
    return out;
  }
  [[nodiscard]] double error2(const View& masked, std::size_t fold,
                              const std::vector<Term>& terms) const {
    const auto [begin, end] = first_.folds[fold];
    const View seen = terms.empty() ? masked : without_pulling(masked, terms);
    Eigen::VectorXd value = TermFits(seen).fit(terms).value;
    fill_phases(seen, terms, begin, end, value);
    Series left = *first_.force_n - force_of(*seen.scene, terms, value);
    Series z = left;
    white_.apply(z);
    left -= session_force_n(*first_.scene->recording, *first_.effects, *first_.white_effects, z,
                            spread_);
    return left.segment(begin, end - begin).square().sum();
  }

 private:
  const View& first_;
  SessionSpread spread_;
  Whitening white_;
};

double rmse(const std::vector<double>& error2, const std::vector<double>& rows,
            const std::vector<std::size_t>& which) {
  double sum = 0.0, n = 0.0;
  for (const std::size_t f : which) sum += error2[f], n += rows[f];
  return std::sqrt(sum / std::max(1.0, n));
}

/// 100 (1 - with/without), with the percentiles of 500 resamplings of the folds.
Interval percent_of(const std::vector<double>& without, const std::vector<double>& with,
                    const std::vector<double>& rows) {
  const std::size_t folds = rows.size();
  std::vector<std::size_t> which(folds);
  const auto percent = [&] {
    return 100.0 * (1.0 - rmse(with, rows, which) / std::max(1e-300, rmse(without, rows, which)));
  };
  for (std::size_t i = 0; i < folds; ++i) which[i] = i;
  Interval out{percent(), 0, 0};
  std::vector<double> resampled;
  Random random(1);
  for (int i = 0; i < 500; ++i) {
    for (std::size_t k = 0; k < folds; ++k) which[k] = random.below(folds);
    resampled.push_back(percent());
  }
  std::sort(resampled.begin(), resampled.end());
  out.low = std::min(out.value, resampled[12]);
  out.high = std::max(out.value, resampled[487]);
  return out;
}

std::vector<double> by_fold(const std::vector<double>& without, const std::vector<double>& with) {
  std::vector<double> out;
  for (std::size_t f = 0; f < without.size(); ++f)
    out.push_back(100.0 * (1.0 - std::sqrt(with[f] / std::max(1e-300, without[f]))));
  return out;
}

std::vector<double> rows_of(const View& v) {
  std::vector<double> out;
  for (const auto& [begin, end] : v.folds) out.push_back(static_cast<double>(end - begin));
  return out;
}

}  // namespace

Gain heldout_gain(const View& first, const Null& null, const ExplainOptions& options,
                  const SessionSpread& spread, double noise_floor_n) {
  const std::size_t folds = first.folds.size();
  std::vector<double> base(folds, 0.0), extended(folds, 0.0);
  const Folds left_out(first, spread);
  independent_runs(folds, [&](std::size_t f) {
    const View masked = left_out.without(f);
    const auto causes = search_without(masked, null, static_cast<int>(f), options.max_causes);
    base[f] = left_out.error2(masked, f, {});
    extended[f] = causes.empty() ? base[f] : left_out.error2(masked, f, causes);
  });
  const std::vector<double> rows = rows_of(first);
  std::vector<std::size_t> all(folds);
  for (std::size_t i = 0; i < folds; ++i) all[i] = i;
  Gain g;
  g.base_rmse_n = rmse(base, rows, all);
  g.extended_rmse_n = rmse(extended, rows, all);
  g.noise_floor_n = noise_floor_n;
  g.percent = percent_of(base, extended, rows);
  g.by_fold_percent = by_fold(base, extended);
  const double could = g.base_rmse_n - noise_floor_n;
  g.share_percent =
      could > 0.0 ? std::clamp(100.0 * (g.base_rmse_n - g.extended_rmse_n) / could, 0.0, 100.0)
                  : 0.0;
  return g;
}

std::vector<OwnGain> gain_of_each(const View& first, const std::vector<Term>& causes,
                                  const SessionSpread& spread) {
  const std::size_t folds = first.folds.size();
  const Folds left_out(first, spread);
  std::vector<std::vector<double>> without(causes.size(), std::vector<double>(folds, 0.0));
  std::vector<double> with(folds, 0.0);
  independent_runs(folds, [&](std::size_t f) {
    const View masked = left_out.without(f);
    with[f] = left_out.error2(masked, f, causes);
    for (std::size_t c = 0; c < causes.size(); ++c) {
      auto others = causes;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(c));
      without[c][f] = left_out.error2(masked, f, others);
    }
  });
  std::vector<OwnGain> out;
  for (std::size_t c = 0; c < causes.size(); ++c)
    out.push_back({percent_of(without[c], with, rows_of(first)), by_fold(without[c], with)});
  return out;
}

}  // namespace cavum::explain
