#include "engine/lab/explain/inference/causes.h"

#include <malloc.h>

#include <algorithm>
#include <cmath>

#include "engine/base/independent_runs.h"

namespace cavum::explain {
namespace {

constexpr double k_worth_saying = 0.14;  // of the noise: less would lower the error by under 1 %,
                                         // and is the motion's own error as likely as not
constexpr double k_worth_adding =
    0.1;  // of the noise: a force that lowers the error by half a percent
constexpr double k_worth_refining = 0.4;
constexpr std::size_t k_refined = 5;
constexpr double k_gone = 0.1;  // of a structure's gain: the rest, when the causes found explain it

Step look(const Recording& r, const Shared<Motion>& motion, std::vector<Term>& causes,
          const ExplainOptions& o) {
  malloc_trim(0);  // the table of columns takes most of the memory, and long
  if (!causes.empty()) {
    const View v = make_view(r, motion, causes, o.fixed_n);
    TermFits fits(v);
    causes = refine(fits, causes, 1);
  }
  Step s{make_view(r, motion, causes, o.fixed_n), {}, {}, {}};
  find_lines(s.view);
  std::optional<Surrogates> surrogates;
  if (o.surrogates > 0)
    surrogates.emplace(
        s.view, o.seed * 1000003ULL + causes.size());  // before the table, for they take memory too
  add_products(s.view);
  malloc_trim(0);
  s.scores = scores_of(s.view);
  if (surrogates) s.null = null_of(s.view, *surrogates, o.surrogates);
  s.judgement = judge(s.view, s.null);
  s.view.white.reset();
  malloc_trim(0);
  return s;
}

/// Where a cause has taken the place of one that was not yet known, its shape is somewhere else
/// once that is: each is tried anew over its grid.
std::vector<Term> restarted(TermFits& fits, std::vector<Term> causes) {
  double least = fits.fit(causes).chi2;
  for (std::size_t i = 0; i + 1 < causes.size(); ++i) {
    const Mechanism& m = mechanism_at(causes[i].mechanism);
    if (m.shape.empty() || m.from_residual) continue;
    for (const auto& shape : starts(m, *fits.view().scene)) {
      auto trial = causes;
      trial[i].shape = shape;
      if (const double chi2 = fits.fit(trial).chi2; chi2 < least) least = chi2, causes = trial;
    }
  }
  return causes;
}

struct Rival {
  std::vector<Term> causes;  ///< all, with the rival last (or in place)
  int mechanism = -1;
  double chi2 = 0;  ///< penalised
  Eigen::Index parameters = 0;
};

/// `c` refined beside the known causes; without causes when it makes no sense there.
Rival refined(const View& v, const std::vector<Term>& others, const Candidate& c) {
  TermFits fits(v);
  std::vector<Term> begin{start_of(fits, others, c)};
  const Mechanism& m = mechanism_at(c.hypothesis.term.mechanism);
  if (m.simpler)
    if (auto simpler = m.simpler(begin[0].shape); !simpler.empty())
      begin.push_back({begin[0].mechanism, std::move(simpler)});
  Rival best;
  best.chi2 = 1e300;
  for (const auto& start : begin) {
    std::vector<Term> causes = others;
    causes.push_back(start);
    causes = refine(fits, causes, start.shape.size() > 1 ? 2 : 1, others.size());
    if (!others.empty())
      causes = refine(fits, restarted(fits, causes),
                      1);  // all together, or the first takes a part of the second
    const View own_contact = without_pulling(v, causes);
    TermFits in_contact(own_contact);
    causes = refine(in_contact, causes, 1, others.size());
    const FitResult fitted = in_contact.fit(causes);
    const auto own = m.columns(*v.scene, causes.back().shape).own.size();
    if (!makes_sense(m, fitted.value.data() + fitted.value.size() - static_cast<Eigen::Index>(own),
                     own))
      continue;
    const double chi2 = penalised_chi2(in_contact, causes);
    if (chi2 < best.chi2)
      best = {causes, start.mechanism, chi2, parameters_of(causes.back(), *v.scene)};
  }
  return best;
}

/// Candidates worth it, refined; best first.
std::vector<Rival> rivals_of(const View& v, const std::vector<Term>& others,
                             std::vector<const Candidate*> candidates) {
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate* a, const Candidate* b) { return a->gain > b->gain; });
  std::size_t worth = 0;
  while (worth < std::min(k_refined, candidates.size()) &&
         (worth == 0 || candidates[worth]->gain >= k_worth_refining * candidates[0]->gain))
    ++worth;
  std::vector<Rival> out(worth);
  independent_runs(worth, [&](std::size_t i) { out[i] = refined(v, others, *candidates[i]); });
  std::erase_if(out, [](const Rival& r) { return r.causes.empty(); });
  std::sort(out.begin(), out.end(), [](const Rival& a, const Rival& b) { return a.chi2 < b.chi2; });
  return out;
}

/// What is left when cause `i` is taken out of a view: its products without it.
View without(const View& v, std::size_t i) {
  View out = v;
  out.causes.erase(out.causes.begin() + static_cast<std::ptrdiff_t>(i));
  out.known.erase(out.known.begin() + static_cast<std::ptrdiff_t>(i));
  return out;
}

bool is_barred(const CauseSearch& search, int mechanism) {
  return std::find(search.barred.begin(), search.barred.end(), mechanism) != search.barred.end();
}

/// Candidates of the last look that are improbable in noise.
std::vector<const Candidate*> improbable(const CauseSearch& search) {
  const Step& step = search.step;
  std::vector<const Candidate*> found;
  for (std::size_t m = 0; m < step.scores.candidates.size(); ++m)
    if (!is_barred(search, static_cast<int>(m)) && step.scores.candidates[m].testable &&
        step.scores.candidates[m].fits() && step.judgement.p_value[m] < k_alpha)
      found.push_back(&step.scores.candidates[m]);
  return found;
}

/// The structure that gains most of those that are; null: none is.
const Structure* improbable_structure(const Step& step) {
  const Structure* best = nullptr;
  const Entries entries = entries_of(step.view);
  const double least_n = k_worth_saying * step.view.noise.sd_n;
  for (std::size_t s = 0; s < step.scores.structures.size(); ++s)
    if (step.scores.structures[s].effect_n > least_n &&
        step.judgement.p_value[entries.of_variable(step.scores.structures[s].variable)] < k_alpha &&
        (best == nullptr || step.scores.structures[s].gain > best->gain))
      best = &step.scores.structures[s];
  return best;
}

/// A curve or a step must beat one mechanism clearly, and any two of them at all.
bool beats_mechanisms(const Structure& structure, double gain, const Step& step) {
  return structure.gain > 1.15 * gain + 20.0 &&
         structure.gain > 1.02 * best_pair_gain(step.view, step.scores.candidates) + 10.0;
}

Unexplained as_unexplained(const Structure& s) { return {s.variable, s.form, s.effect_n}; }

/// A search as it was before a cause that a structure beats: to go back to, unless the causes then
/// found leave nothing of the structure.
struct Doubt {
  std::vector<Term> causes;
  std::vector<double> p_values;
  Step step;
  Structure structure;
};

/// The end of the search: what is left, or what was doubted from the start.
std::optional<Unexplained> ended(CauseSearch& search, std::optional<Doubt> doubt) {
  const Structure* left = improbable_structure(search.step);
  if (doubt && left != nullptr && left->gain > k_gone * doubt->structure.gain) {
    search.causes = std::move(doubt->causes);
    search.p_values = std::move(doubt->p_values);
    search.step = std::move(doubt->step);
    return as_unexplained(doubt->structure);
  }
  return left != nullptr ? std::optional(as_unexplained(*left)) : std::nullopt;
}

/// Candidates that gain anything in the place of cause `i`, each refined beside the others; best
/// first.
std::vector<Rival> rivals_in_place(const CauseSearch& search, std::size_t i,
                                   const std::vector<Term>& others) {
  const View rest = without(search.step.view, i);
  const auto candidates = candidates_of(rest);
  std::vector<const Candidate*> worth;
  for (const auto& c : candidates)
    if (c.testable && c.gain > 0.0 && !is_barred(search, c.hypothesis.term.mechanism))
      worth.push_back(&c);
  return worth.empty() ? std::vector<Rival>{} : rivals_of(rest, others, worth);
}

/// Root mean square of what the force of the model changes by from one set of causes to another.
double effect_n(TermFits& fits, const std::vector<Term>& from, const std::vector<Term>& to) {
  const Scene& scene = *fits.view().scene;
  return std::sqrt(
      (force_of(scene, to, fits.fit(to).value) - force_of(scene, from, fits.fit(from).value))
          .square()
          .mean());
}

/// The rival that fits better in the place of cause `i`; null: none does.
const Rival* better_one(const CauseSearch& search, std::size_t i, const std::vector<Rival>& rivals,
                        double with) {
  for (const auto& r : rivals)
    if (r.mechanism != search.causes[i].mechanism && r.chi2 < with - 1.0 &&
        search.causes.size() > 1)
      return &r;
  return nullptr;
}

}  // namespace

CauseSearch begin_search(const Recording& recording, const ExplainOptions& options,
                         std::function<void()> done) {
  CauseSearch search{recording, options, std::move(done), estimate_motion(recording), {}, {}, {},
                     0.0,       {}};
  look_again(search);
  return search;
}

void look_again(CauseSearch& s) {
  s.step = {};  // before the next takes as much memory
  s.step = look(s.recording, s.motion, s.causes, s.options);
  if (s.done) s.done();
}

std::optional<Unexplained> add_causes(CauseSearch& search) {
  std::optional<Doubt> doubt;
  while (true) {
    const Step& step = search.step;
    const std::vector<const Candidate*> found = improbable(search);
    const Structure* structure = improbable_structure(step);
    const bool full = static_cast<int>(search.causes.size()) >= search.options.max_causes;
    if (found.empty() || full) return ended(search, std::move(doubt));
    std::optional<TermFits> fits(step.view);
    auto rivals = rivals_of(step.view, search.causes, found);
    if (rivals.empty()) return doubt ? ended(search, std::move(doubt)) : std::nullopt;
    std::erase_if(rivals, [&](const Rival& r) {
      return effect_n(*fits, search.causes, r.causes) < k_worth_adding * step.view.noise.sd_n;
    });
    if (rivals.empty()) return ended(search, std::move(doubt));
    const double before = penalised_chi2(*fits, search.causes) +
                          k_parameter_penalty;  // the first parameter of a cause is free of penalty
    const double gain = before - rivals.front().chi2;
    if (gain < k_alias_chi2) return doubt ? ended(search, std::move(doubt)) : std::nullopt;
    if (!doubt && structure != nullptr && beats_mechanisms(*structure, gain, step))
      doubt = Doubt{search.causes, search.p_values, step, *structure};
    const auto at = static_cast<std::size_t>(rivals.front().mechanism);
    search.causes = refine(*fits, rivals.front().causes, 1);
    fits.reset();
    search.p_values.push_back(step.judgement.p_value[at]);
    look_again(search);
  }
}

bool weigh_causes(CauseSearch& search, std::vector<Cause>& weighed) {
  bool changed = false;
  auto& causes = search.causes;
  for (std::size_t i = 0; i < causes.size();) {
    auto others = causes;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    std::optional<TermFits> fits(search.step.view);
    const double with = penalised_chi2(*fits, causes);
    const double earned = penalised_chi2(*fits, others) + k_parameter_penalty - with;
    const double inflation = search.step.judgement.inflation;
    if (causes.size() > 1 && earned < 2.0 * k_alias_chi2 * inflation) {
      causes = others;
      search.p_values.erase(search.p_values.begin() + static_cast<std::ptrdiff_t>(i));
      changed = true;
      fits.reset();
      look_again(search);
      continue;
    }
    Cause cause;
    cause.p_value = search.p_values[i];
    const auto rivals = rivals_in_place(search, i, others);
    if (const Rival* better =
            better_one(search, i, rivals, with)) {  // found when the others were not yet known
      causes[i] = better->causes.back();
      changed = true;
    }
    const double own = penalised_chi2(*fits, causes);
    for (const auto& r : rivals)
      if (law_of(r.mechanism) != law_of(causes[i].mechanism))
        cause.rivals.push_back({mechanism_at(r.mechanism).name, r.chi2 - own});
    for (const auto& r : rivals)
      if (r.mechanism != causes[i].mechanism && r.chi2 - own < within_alias(earned, inflation) &&
          r.parameters <= parameters_of(causes[i], *search.step.view.scene))
        cause.aliases.emplace_back(mechanism_at(r.mechanism).name);
    cause.term = causes[i];
    weighed.push_back(cause);
    ++i;
  }
  return changed;
}

}  // namespace cavum::explain
