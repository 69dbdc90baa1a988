#include "engine/explain/inference/explain.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>

#include "engine/base/text.h"
#include "engine/explain/inference/heldout.h"
#include "engine/explain/inference/intervals.h"
#include "engine/explain/inference/search.h"
#include "engine/explain/recording/faults.h"
#include "engine/explain/recording/specimens.h"

namespace cavum::explain {
namespace {

constexpr std::size_t k_first_twins = 10;  // enough when the answer is plain
constexpr double k_plain = 6.0;            // z this many times what the twins reach needs no more twins
constexpr double k_alias_chi2 = 10.0;      // a rival this close fits as well
constexpr double k_worth_refining = 0.4;
constexpr std::size_t k_refined = 5;

struct Step {
  View view;
  Scores scores;
  Null null;
  Judgement judgement;
};

double best_p(const Step& s) { return *std::min_element(s.judgement.p_value.begin(), s.judgement.p_value.end()); }
double best_z(const Step& s) { return *std::max_element(s.judgement.z.begin(), s.judgement.z.end()); }

/// Refines the shapes of `causes` first: with a cause in the model, k and c move, and with them who is in contact and clipped.
Step look(const Recording& r, const Motion& motion, std::vector<Term>& causes, const ExplainOptions& o, const std::function<void()>& done) {
  ViewOptions options;
  options.fixed_n = o.fixed_n;
  if (!causes.empty()) {
    options.products = false;
    causes = refine(make_view(r, motion, causes, {}, options), causes, 1);
    options.products = true;
  }
  options.sharp = true;
  Step s{make_view(r, motion, causes, {}, options), {}, {}, {}};
  s.scores = scores_of(s.view);
  const std::uint64_t seed = o.seed * 1000003ULL + causes.size();
  add_twins(s.null, s.view, std::min(k_first_twins, o.twins), seed, o.fixed_n, done);
  s.judgement = judge(s.scores, s.null);
  double reach = 1.0;
  for (const auto& twin : s.null.twins) {
    Scores as_data = twin;
    as_data.structures = s.scores.structures;
    for (auto& structure : as_data.structures) structure.raw_gain = 0.0;
    as_data.blur = s.scores.blur;
    const Judgement j = judge(as_data, s.null);
    reach = std::max(reach, *std::max_element(j.z.begin(), j.z.end()));
  }
  if (best_p(s) < 0.06 && best_z(s) < k_plain * reach) {
    add_twins(s.null, s.view, o.twins, seed, o.fixed_n, done);
    s.judgement = judge(s.scores, s.null);
  }
  return s;
}

struct Rival {
  std::vector<Term> causes;  ///< all, with the rival last (or in place)
  int mechanism = -1;
  double chi2 = 0;  ///< penalised
  Eigen::Index parameters = 0;
};

/// Candidates worth it, refined beside the known causes; best first.
std::vector<Rival> rivals_of(const View& v, const std::vector<Term>& others, std::vector<const Candidate*> candidates) {
  std::sort(candidates.begin(), candidates.end(), [](const Candidate* a, const Candidate* b) { return a->gain > b->gain; });
  std::vector<Rival> out;
  for (const auto* c : candidates) {
    if (out.size() >= k_refined || c->gain < k_worth_refining * candidates.front()->gain) break;
    View beside = v;
    beside.causes = others;
    std::vector<Term> begin{start_of(beside, *c)};
    const Mechanism& m = mechanism_at(c->hypothesis.term.mechanism);
    if (m.simpler)
      if (auto simpler = m.simpler(begin[0].shape); !simpler.empty()) begin.push_back({begin[0].mechanism, std::move(simpler)});
    Rival best;
    best.chi2 = 1e300;
    for (const auto& start : begin) {
      std::vector<Term> causes = others;
      causes.push_back(start);
      causes = refine(v, causes, start.shape.size() > 1 ? 2 : 1, others.size());
      const View own_contact = without_pulling(v, causes);
      causes = refine(own_contact, causes, 1, others.size());
      const FitResult fitted = fit_terms(own_contact, causes);
      const auto own = m.columns(v.scene, causes.back().shape).own.size();
      if (!makes_sense(m, fitted.value.data() + fitted.value.size() - static_cast<Eigen::Index>(own), own)) continue;
      const double chi2 = penalised_chi2(own_contact, causes);
      if (chi2 < best.chi2) best = {causes, start.mechanism, chi2, parameters_of(causes.back(), v.scene)};
    }
    if (!best.causes.empty()) out.push_back(best);
  }
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

void list_not_testable(Explanation& e, const std::vector<Candidate>& candidates, const Scene& scene) {
  for (const auto& c : candidates) {
    if (c.testable) continue;
    const Mechanism& m = mechanism_at(c.hypothesis.term.mechanism);
    const bool lacks = starts(m, scene).empty();
    e.not_testable.push_back({m.name, lacks ? "the recording lacks what it needs" : "k and c can take its place in these data"});
  }
}

bool is_untestable(const Explanation& e, const char* name) {
  return std::any_of(e.not_testable.begin(), e.not_testable.end(), [&](const NotTestable& n) { return n.mechanism == name; });
}

const Mechanism& mechanism_of(const Term& term) { return mechanism_at(term.mechanism); }
bool alias_needs_reversal(const std::string& name) { return needs_reversal(mechanism_at(known_mechanism(name))); }

/// What needs a reversal to be known, as the plain offset that fits best in its place.
Term as_offset(const View& v, std::vector<Term> causes, std::size_t i) {
  Term best = causes[i];
  double least = 1e300;
  for (std::size_t at = 0; at < mechanisms().size(); ++at)
    if (const Mechanism& m = mechanisms()[at]; is_offset(m))
      for (auto& shape : starts(m, v.scene)) {
        causes[i] = {static_cast<int>(at), shape};
        if (const double chi2 = penalised_chi2(v, causes); chi2 < least) least = chi2, best = causes[i];
      }
  return best;
}

/// A lag shorter than the time in which a coarse position leaves open when contact began: a delay and a filter differ in what follows that instant.
bool is_too_short_to_tell(const Term& term, const Motion& m, bool speed_is_measured) {
  if (speed_is_measured || m.quantum_mm <= 1e-5 || mechanism_of(term).like_when_short == nullptr) return false;
  double way = 0.0, moving = 0.0;
  for (const double v : m.v_mm_s)
    if (std::fabs(v) > 0.05 * m.v_mm_s.maxCoeff()) way += std::fabs(v), moving += 1.0;
  return moving > 0.0 && term.shape[0] < 0.5 * m.quantum_mm / (way / moving);
}

/// The verdict and the experiment that would say more.
void conclude(Explanation& e, bool one_way) {
  std::vector<const Mechanism*> offsets;
  for (const auto& m : mechanisms())
    if (is_offset(m)) offsets.push_back(&m);
  const bool aliased = std::any_of(e.causes.begin(), e.causes.end(), [](const Cause& c) { return !c.aliases.empty(); });
  if (!e.causes.empty())
    e.verdict = aliased ? "alias" : "named";
  else if (e.unexplained)
    e.verdict = "unexplained";
  else
    e.verdict = one_way || std::all_of(offsets.begin(), offsets.end(), [&](const Mechanism* m) { return is_untestable(e, m->name); }) ? "not_testable"
                                                                                                                                      : "clean";

  const auto separate = [](const std::string& name) { return std::string(mechanism_at(known_mechanism(name)).separate); };
  std::vector<std::string> wanted;
  for (const auto& c : e.causes)
    if (!c.aliases.empty()) {
      wanted.push_back(separate(mechanism_at(c.term.mechanism).name));
      for (const auto& a : c.aliases) wanted.push_back(separate(a));
    }
  if (e.verdict == "not_testable")
    for (const auto* m : offsets) wanted.emplace_back(m->separate);
  std::string text;
  for (std::size_t i = 0; i < wanted.size(); ++i)
    if (std::find(wanted.begin(), wanted.begin() + static_cast<std::ptrdiff_t>(i), wanted[i]) == wanted.begin() + static_cast<std::ptrdiff_t>(i))
      text += (text.empty() ? "" : "; ") + wanted[i];
  if (text.empty() && e.unexplained) text = "vary " + e.unexplained->variable + " alone, in steps, with everything else held, and record again";
  if (text.empty() && !e.not_testable.empty()) {
    for (const auto& n : e.not_testable)
      if (mechanism_at(known_mechanism(n.mechanism)).in_recordings) {
        text = "to test " + n.mechanism + " too: " + separate(n.mechanism);
        break;
      }
  }
  e.next_experiment = text.empty() ? "repeat the recording at another site, to see whether k, c and the causes stay the same" : text;
}

/// k and c against those of the rig. A wrong clock leaves k as it is and changes c alone, when nothing else is wrong.
void compare_with_rig(Explanation& e, const Rig& rig, bool speed_known) {
  constexpr double k_known = 0.1;  // relative; rigs are calibrated to a few percent
  if (!rig.k_n_per_mm || !rig.c_n_s_per_mm || *rig.c_n_s_per_mm <= 0.0) return;
  const double k = e.base.k_n_per_mm / *rig.k_n_per_mm, c = e.base.c_n_s_per_mm / *rig.c_n_s_per_mm;
  const bool off = std::fabs(c - 1.0) > k_known && (e.c.low > (1.0 + k_known) * *rig.c_n_s_per_mm || e.c.high < (1.0 - k_known) * *rig.c_n_s_per_mm);
  char text[200];
  std::snprintf(text, sizeof text, "fitted k is %.3g times, c is %.3g times that of rig.toml", k, c);
  if (std::fabs(k - 1.0) > k_known || off) e.notes.emplace_back(text);
  if (e.verdict != "clean" || !off || std::fabs(k - 1.0) > 0.5 * k_known) return;
  if (speed_known || c <= 0.0) {  // no clock does that
    e.verdict = "unexplained";
    e.unexplained = Unexplained{"v_mm_s", "c differs from that of rig.toml",
                                std::fabs(c - 1.0) * *rig.c_n_s_per_mm * std::sqrt(e.after->scene.damper_mm_s.square().mean())};
    if (c < 1.0)
      e.notes.push_back("a lag of " + plain_number((1.0 - c) * *rig.c_n_s_per_mm / e.base.k_n_per_mm) +
                        " s of the force (delay or low_pass) takes as much from c: k and c alone cannot tell");
    e.next_experiment = "press and stop suddenly, several times: a lag shows after each stop, a wrong c does not";
  } else {
    e.verdict = "data_fault";
    e.data_faults.push_back(std::string("time base: ") + text + ", as when the clock is off by that factor; check the sampling rate, or c");
    e.next_experiment = "record the speed too, or check the sampling rate against a clock";
  }
}

}  // namespace

Explanation explain(const Recording& given, const ExplainOptions& options) {
  Explanation e;
  e.data_faults = data_faults(given);
  auto scaled = std::make_shared<const Recording>(e.data_faults.empty() && are_specimens(given) ? on_common_scale(given) : given);
  const Recording& recording = *scaled;
  e.recording = scaled;
  e.notes = recording.notes;
  if (options.twins == 0) e.notes.emplace_back("without twins: judged as if independent noise were all that could mislead; causes may be false");
  if (!e.data_faults.empty()) {
    e.verdict = "data_fault";
    e.next_experiment = "correct the recording: " + e.data_faults.front();
    return e;
  }
  // three looks are the most that is usual; the bar never runs backwards
  const double expected = static_cast<double>(options.twins) * 2.0;
  std::atomic<int> finished{0};
  const auto done = [&] {
    const int n = ++finished;
    if (options.progress) options.progress(0.9 * (1.0 - std::exp(-2.0 * n / expected)));
  };

  const Motion motion = estimate_motion(recording);
  std::vector<Term> causes;
  std::vector<double> p_values;
  Step step = look(recording, motion, causes, options, done);
  const Step first = step;
  while (true) {
    const std::size_t mechanisms_n = mechanisms().size();
    std::vector<const Candidate*> found;
    for (std::size_t m = 0; m < mechanisms_n; ++m)
      if (step.scores.candidates[m].testable && step.judgement.p_value[m] < k_alpha) found.push_back(&step.scores.candidates[m]);
    const Structure* structure = nullptr;
    for (std::size_t s = 0; s < step.scores.structures.size(); ++s)
      if (step.judgement.p_value[mechanisms_n + s] < k_alpha && (structure == nullptr || step.scores.structures[s].gain > structure->gain))
        structure = &step.scores.structures[s];
    const bool full = static_cast<int>(causes.size()) >= options.max_causes;
    if (found.empty() || full) {
      if (structure != nullptr) e.unexplained = Unexplained{structure->variable, structure->form, structure->effect_n};
      break;
    }
    const auto rivals = rivals_of(step.view, causes, found);
    if (rivals.empty()) break;
    const double before = penalised_chi2(step.view, causes) + k_parameter_penalty;  // the first parameter of a cause is free of penalty
    const double gain = before - rivals.front().chi2;
    // a curve or a step must beat one mechanism clearly, and any two of them at all
    if (structure != nullptr && structure->gain > 1.15 * gain + 20.0 &&
        structure->gain > 1.02 * best_pair_gain(step.view, step.scores.candidates) + 10.0) {
      e.unexplained = Unexplained{structure->variable, structure->form, structure->effect_n};
      break;
    }
    if (gain < k_alias_chi2) break;
    const auto at = static_cast<std::size_t>(rivals.front().mechanism);
    causes = refine(step.view, rivals.front().causes, 1);
    p_values.push_back(step.judgement.p_value[at]);
    step = look(recording, motion, causes, options, done);
  }

  // does every cause still earn its place, and is there a better one in that place?
  bool changed = false;
  for (std::size_t i = 0; i < causes.size();) {
    View rest = without(step.view, i);
    auto others = causes;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const double with = penalised_chi2(step.view, causes);
    const auto candidates = candidates_of(rest);
    std::vector<const Candidate*> worth;
    for (const auto& c : candidates)
      if (c.testable && c.gain > 0.0) worth.push_back(&c);
    const double earned = penalised_chi2(step.view, others) + k_parameter_penalty - with;
    if (causes.size() > 1 && earned < 2.0 * k_alias_chi2 * step.judgement.inflation) {
      causes = others;
      p_values.erase(p_values.begin() + static_cast<std::ptrdiff_t>(i));
      changed = true;
      step = look(recording, motion, causes, options, done);
      continue;
    }
    Cause cause;
    cause.p_value = p_values[i];
    if (!worth.empty()) {
      const auto rivals = rivals_of(rest, others, worth);
      for (const auto& r : rivals)
        if (r.mechanism != causes[i].mechanism && r.chi2 < with - 1.0 && causes.size() > 1) {  // found when the others were not yet known
          causes[i] = r.causes.back();
          changed = true;
          break;
        }
      const double own = penalised_chi2(step.view, causes);
      for (const auto& r : rivals)
        if (r.mechanism != causes[i].mechanism && r.chi2 - own < k_alias_chi2 * step.judgement.inflation + 0.003 * earned &&
            r.parameters <= parameters_of(causes[i], step.view.scene))
          cause.aliases.emplace_back(mechanism_at(r.mechanism).name);
    }
    cause.term = causes[i];
    e.causes.push_back(cause);
    ++i;
  }
  const bool one_way = moves_one_way(motion);
  for (std::size_t i = 0; one_way && i < causes.size(); ++i)
    if (needs_reversal(mechanism_of(causes[i])) && !is_offset(mechanism_of(causes[i]))) causes[i] = as_offset(step.view, causes, i), changed = true;
  if (changed) step = look(recording, motion, causes, options, done);
  for (std::size_t i = 0; i < causes.size(); ++i) e.causes[i].term = causes[i];
  for (auto& cause : e.causes) {
    const char* other = mechanism_of(cause.term).like_when_short;
    if (is_too_short_to_tell(cause.term, motion, recording.v_mm_s.size() > 0) &&
        std::find(cause.aliases.begin(), cause.aliases.end(), other) == cause.aliases.end())
      cause.aliases.emplace_back(other);
  }
  for (auto& cause : e.causes)  // what is named beside it is no other word for it
    std::erase_if(cause.aliases, [&](const std::string& a) {
      return std::any_of(causes.begin(), causes.end(), [&](const Term& t) { return law_of(t.mechanism) == law_of(known_mechanism(a)); }) &&
             law_of(known_mechanism(a)) != law_of(cause.term.mechanism);
    });
  for (auto& cause : e.causes) {
    const Mechanism& found = mechanism_of(cause.term);
    if (!one_way || (!needs_reversal(found) && std::none_of(cause.aliases.begin(), cause.aliases.end(), alias_needs_reversal))) continue;
    std::erase_if(cause.aliases, alias_needs_reversal);
    for (const auto& other : mechanisms())
      if (is_offset(other) && &other != &found) cause.aliases.emplace_back(other.name);
  }

  set_parameters(e, step.view, step.null, step.judgement.inflation);
  list_not_testable(e, first.scores.candidates, first.view.scene);
  e.base = {step.view.base_fit.value[0], step.view.base_fit.value[1]};
  e.noise = step.view.noise;
  e.gain = heldout_gain(first.view, first.scores, first.null, causes.size(), e.noise.sd_n);
  e.structures = step.scores.structures;
  e.candidates = first.scores.candidates;
  if (e.unexplained && !e.causes.empty()) {
    // something is left over; when it is more than what was found, the causes are not the answer
    double left = 0.0;
    for (const auto& s : e.structures)
      if (s.variable == e.unexplained->variable) left = s.gain;
    const double explained = fit(step.view.products, {}).chi2 - fit(step.view.products, known_of(step.view)).chi2;
    if (left > explained) e.causes.clear();
  }
  e.before = first.view;
  e.after = step.view;
  conclude(e, one_way);
  compare_with_rig(e, recording.rig, recording.v_mm_s.size() > 0);
  if (options.progress) options.progress(1.0);
  return e;
}

}  // namespace cavum::explain
