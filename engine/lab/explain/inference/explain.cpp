#include "engine/lab/explain/inference/explain.h"

#include <algorithm>
#include <cmath>

#include "engine/base/text.h"
#include "engine/lab/explain/inference/causes.h"
#include "engine/lab/explain/inference/heldout.h"
#include "engine/lab/explain/inference/intervals.h"
#include "engine/lab/explain/inference/take_back.h"
#include "engine/lab/explain/recording/faults.h"
#include "engine/lab/explain/recording/specimens.h"
#include "engine/lab/explain/recording/stamps.h"
#include "engine/lab/explain/recording/stretches.h"

namespace cavum::explain {
namespace {

void list_not_testable(Explanation& e, const std::vector<Candidate>& candidates,
                       const Scene& scene) {
  for (const auto& c : candidates) {
    if (c.testable) continue;
    const Mechanism& m = mechanism_at(c.hypothesis.term.mechanism);
    const bool lacks = starts(m, scene).empty();
    e.not_testable.push_back({m.name, lacks ? msg("the recording lacks what it needs")
                                            : msg("k and c can take its place in these data")});
  }
}

bool is_untestable(const Explanation& e, const char* name) {
  return std::any_of(e.not_testable.begin(), e.not_testable.end(),
                     [&](const NotTestable& n) { return n.mechanism == name; });
}

bool alias_needs_reversal(const std::string& name) {
  return needs_reversal(mechanism_at(known_mechanism(name)));
}

/// What needs a reversal to be known, as the plain offset that fits best in its place.
Term as_offset(const View& v, std::vector<Term> causes, std::size_t i) {
  TermFits fits(v);
  Term best = causes[i];
  double least = 1e300;
  for (std::size_t at = 0; at < mechanisms().size(); ++at)
    if (const Mechanism& m = mechanisms()[at]; is_offset(m))
      for (auto& shape : starts(m, *v.scene)) {
        causes[i] = {static_cast<int>(at), shape};
        if (const double chi2 = penalised_chi2(fits, causes); chi2 < least)
          least = chi2, best = causes[i];
      }
  return best;
}

/// A lag shorter than the time in which a coarse position leaves open when contact began: a delay
/// and a filter differ in what follows that instant.
bool is_too_short_to_tell(const Term& term, const Motion& m, bool speed_is_measured) {
  if (speed_is_measured || m.quantum_mm <= 1e-5 || mechanism_of(term).like_when_short == nullptr)
    return false;
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
  const bool aliased = std::any_of(e.causes.begin(), e.causes.end(),
                                   [](const Cause& c) { return !c.aliases.empty(); });
  if (!e.causes.empty())
    e.verdict = aliased ? Verdict::alias : Verdict::named;
  else if (e.unexplained)
    e.verdict = Verdict::unexplained;
  else
    e.verdict =
        one_way || std::all_of(offsets.begin(), offsets.end(),
                               [&](const Mechanism* m) { return is_untestable(e, m->name); })
            ? Verdict::not_testable
            : Verdict::clean;

  const auto separate = [](const std::string& name) {
    return msg("{}", cavum::Term{mechanism_at(known_mechanism(name)).separate});
  };
  List wanted{{}, true}, apart;
  const auto want = [&](const std::string& mechanism) {
    apart.items.emplace_back(Name{mechanism});
    const Message experiment = separate(mechanism);
    if (std::find(wanted.items.begin(), wanted.items.end(), experiment) == wanted.items.end())
      wanted.items.push_back(experiment);
  };
  for (const auto& c : e.causes)
    if (!c.aliases.empty()) {
      want(mechanism_at(c.term.mechanism).name);
      for (const auto& a : c.aliases) want(a);
    }
  if (e.verdict == Verdict::not_testable)
    for (const auto* m : offsets) want(m->name);
  const auto open =
      std::find_if(e.not_testable.begin(), e.not_testable.end(), [](const NotTestable& n) {
        return mechanism_at(known_mechanism(n.mechanism)).in_recordings;
      });
  if (!wanted.items.empty())
    e.next_experiment =
        Fact("tell_apart", {"experiments"}, msg("{}", wanted)).with("mechanisms", apart);
  else if (e.unexplained)
    e.next_experiment =
        Fact("vary_alone", {"variable"},
             msg("vary {} alone, in steps, with everything else held, and record again",
                 e.unexplained->variable));
  else if (open == e.not_testable.end())
    e.next_experiment = Fact(
        "repeat_elsewhere",
        msg("repeat the recording at another site, to see whether k, c and the causes stay the same"));
  else
    e.next_experiment = Fact("test_too", {"mechanism", "experiment"},
                             msg("to test {} too: {}", open->mechanism, separate(open->mechanism)));
}

/// k and c against those of the rig. A wrong clock leaves k as it is and changes c alone, when
/// nothing else is wrong.
void compare_with_rig(Explanation& e, const Rig& rig, bool speed_known) {
  constexpr double k_told = 0.1,
                   k_known =
                       0.2;  // relative: said, and more than a rig is off by that was calibrated
  constexpr double k_absurd = 5.0;
  if (e.verdict == Verdict::data_fault || e.after->scene->touching.maxCoeff() < 0.5) return;
  if (e.base.k_n_per_mm < 0.0 && e.k.high < 0.0) {
    e.verdict = Verdict::unexplained;
    e.unexplained =
        Unexplained{"x_mm", msg("the force falls as the tool goes deeper"),
                    -e.base.k_n_per_mm * std::sqrt(e.after->scene->spring_mm.square().mean())};
    return;
  }
  if (!rig.k_n_per_mm || !rig.c_n_s_per_mm || *rig.c_n_s_per_mm <= 0.0 ||
      e.recording->relative_k.size() > 0)
    return;
  const double k = e.base.k_n_per_mm / *rig.k_n_per_mm, c = e.base.c_n_s_per_mm / *rig.c_n_s_per_mm;
  const auto off = [&](double ratio, const Interval& i, double given) {
    return std::fabs(ratio - 1.0) > k_known &&
           (i.low > (1.0 + k_known) * given || i.high < (1.0 - k_known) * given);
  };
  const bool k_off = off(k, e.k, *rig.k_n_per_mm), c_off = off(c, e.c, *rig.c_n_s_per_mm);
  const Message text =
      msg("fitted k is {} times, c is {} times that of rig.toml", as_number(k, 2), as_number(c, 2));
  if (e.verdict != Verdict::clean &&
      (k < 1.0 / k_absurd || k > k_absurd)) {  // causes beside it would only say what it lacks
    e.causes.clear();
    e.verdict = Verdict::unexplained;
    e.unexplained = Unexplained{
        "x_mm",
        msg("k is not that of rig.toml by far: does the file count x from the surface, and into the tooth?"),
        std::fabs(k - 1.0) * *rig.k_n_per_mm *
            std::sqrt(e.after->scene->spring_mm.square().mean())};
  }
  if (std::fabs(k - 1.0) > k_told || std::fabs(c - 1.0) > k_told)
    e.notes.emplace_back("rig_differs", std::vector{"k_times", "c_times"}, text);
  if (e.verdict != Verdict::clean) return;
  if (k_off) {
    e.verdict = Verdict::unexplained;
    e.unexplained = Unexplained{"x_mm", msg("k differs from that of rig.toml"),
                                std::fabs(k - 1.0) * *rig.k_n_per_mm *
                                    std::sqrt(e.after->scene->spring_mm.square().mean())};
    e.next_experiment =
        Fact("calibrate_force",
             msg("press a spring of known stiffness, and hang known weights on the load cell"));
    return;
  }
  if (!c_off || std::fabs(k - 1.0) > 0.5 * k_told) return;
  if (speed_known || c <= 0.0) {  // no clock does that
    e.verdict = Verdict::unexplained;
    e.unexplained = Unexplained{"v_mm_s", msg("c differs from that of rig.toml"),
                                std::fabs(c - 1.0) * *rig.c_n_s_per_mm *
                                    std::sqrt(e.after->scene->damper_mm_s.square().mean())};
    if (c < 1.0)
      e.notes.emplace_back(
          "lag_or_c", std::vector{"lag"},
          msg("a lag of {} of the force (delay or low_pass) takes as much from c: k and c alone cannot tell",
              as_s((1.0 - c) * *rig.c_n_s_per_mm / e.base.k_n_per_mm, k_as_needed)));
    e.next_experiment = Fact(
        "stop_suddenly",
        msg("press and stop suddenly, several times: a lag shows after each stop, a wrong c does not"));
  } else {
    e.verdict = Verdict::data_fault;
    e.data_faults.push_back(
        {DataFault::Kind::time_base,
         msg("time base: {}, as when the clock is off by that factor; check the sampling rate, or c",
             text)});
    e.next_experiment = Fact(
        "check_clock", msg("record the speed too, or check the sampling rate against a clock"));
  }
}

/// As it is explained: on a common scale where its sessions are different specimens. With its
/// notes, and its faults.
Explanation opened(const Recording& given, const ExplainOptions& options) {
  Explanation e;
  e.data_faults = data_faults(given);
  const std::optional<Recording> even =
      e.data_faults.empty() && !given.exact_motion ? with_even_stamps(given) : std::nullopt;
  const Recording& stamped = even ? *even : given;
  const std::optional<Recording> cut =
      e.data_faults.empty() && !given.exact_motion ? in_stretches(stamped) : std::nullopt;
  e.recording = std::make_shared<const Recording>(cut ? *cut
                                                  : e.data_faults.empty() && are_specimens(stamped)
                                                      ? on_common_scale(stamped)
                                                      : stamped);
  e.notes = e.recording->notes;
  if (options.surrogates == 0)
    e.notes.emplace_back(
        "no_surrogates",
        msg("without surrogates: judged as if independent noise were all that could mislead; causes may be false"));
  if (!e.data_faults.empty()) {
    e.verdict = Verdict::data_fault;
    e.next_experiment = correct_recording(e.data_faults);
  }
  return e;
}

/// Where the motion goes one way, what needs a reversal to be known becomes a plain offset. True:
/// some did.
bool make_offsets(CauseSearch& search) {
  bool changed = false;
  for (std::size_t i = 0; i < search.causes.size(); ++i) {
    const Mechanism& m = mechanism_of(search.causes[i]);
    if (!needs_reversal(m) || is_offset(m)) continue;
    search.causes[i] = as_offset(search.step.view, search.causes, i);
    changed = true;
  }
  return changed;
}

void alias_by_shape(std::vector<Cause>& causes, const CauseSearch& search) {
  for (auto& cause : causes) {
    if (const auto& same = mechanism_of(cause.term).same_as; same)
      if (const char* name = same(cause.term.shape);
          name != nullptr &&
          std::find(cause.aliases.begin(), cause.aliases.end(), name) == cause.aliases.end())
        cause.aliases.emplace_back(name);
    const char* other = mechanism_of(cause.term).like_when_short;
    if (is_too_short_to_tell(cause.term, *search.motion, search.motion->speed_sd_mm_s > 0.0) &&
        std::find(cause.aliases.begin(), cause.aliases.end(), other) == cause.aliases.end())
      cause.aliases.emplace_back(other);
  }
}

/// What is named beside it is no other word for it.
void drop_named_aliases(std::vector<Cause>& causes) {
  for (auto& cause : causes)
    std::erase_if(cause.aliases, [&](const std::string& a) {
      const int law = law_of(known_mechanism(a));
      return a == mechanism_of(cause.term).name ||
             (law != law_of(cause.term.mechanism) &&
              std::any_of(causes.begin(), causes.end(),
                          [&](const Cause& c) { return law_of(c.term.mechanism) == law; }));
    });
}

/// Where the motion goes one way, an offset is any of them.
void alias_offsets(std::vector<Cause>& causes) {
  for (auto& cause : causes) {
    const Mechanism& found = mechanism_of(cause.term);
    if (!needs_reversal(found) &&
        std::none_of(cause.aliases.begin(), cause.aliases.end(), alias_needs_reversal))
      continue;
    std::erase_if(cause.aliases, alias_needs_reversal);
    for (const auto& other : mechanisms())
      if (is_offset(other) && &other != &found) cause.aliases.emplace_back(other.name);
  }
}

constexpr double k_more_than_noise = 1.5;     // of the floor
constexpr double k_zero_differs = 0.5;        // of the noise
constexpr double k_stiffness_differs = 0.15;  // of k: sites of one tissue differ by a tenth
constexpr int k_rounds = 2;

/// Parameters, gain, noise and what is left. `first`: the look without causes.
void put_figures(Explanation& e, const ExplainOptions& options, const Step& first,
                 const Step& last) {
  set_parameters(e, last.view, last.null, last.judgement.inflation);
  e.not_testable.clear();
  list_not_testable(e, first.scores.candidates, *first.view.scene);
  e.base = {last.view.base_fit.value[0], last.view.base_fit.value[1]};
  e.noise = last.view.noise;
  e.spread = last.view.spread;
  e.gain = heldout_gain(first.view, first.null, options, last.view.spread, e.noise.sd_n);
  const Motion& m = *last.view.scene->motion;
  e.position_error_n = std::sqrt((e.base.k_n_per_mm * m.sd_x_mm).square().mean() +
                                 (e.base.c_n_s_per_mm * m.sd_v_mm_s).square().mean());
  e.structures = last.scores.structures;
  e.candidates = first.scores.candidates;
  e.before = first.view;
  e.after = last.view;
}

/// What the first look saw, and the sessions left out did not confirm.
std::optional<Unexplained> doubtful(const Step& first) {
  const Structure* best = nullptr;
  for (const auto& s : first.scores.structures)
    if (best == nullptr || s.gain > best->gain) best = &s;
  if (best == nullptr) return std::nullopt;
  return Unexplained{best->variable,
                     msg("{}, which does not hold from session to session", best->form),
                     best->effect_n};
}

/// What sessions differ in, and whether the recorded speed was used, as notes.
void report_differences(Explanation& e, const Motion& motion) {
  if ((motion.x_mm <= 0.0).all())
    e.notes.emplace_back("never_touches",
                         msg("the tool never touches: only what acts in air can be found"));
  if (!motion.speed_note.empty()) e.notes.push_back(motion.speed_note);
  if (motion.noise_mm > 0.0)
    e.notes.emplace_back("positions_noisy", std::vector{"noise"},
                         msg("the positions are noisy: {} from row to row",
                             as_unit(1e3 * motion.noise_mm, cavum::Unit::um, 2)));
  const SessionSpread& s = e.spread;
  List differ;
  if (s[k_force_zero] > 0.5 * e.noise.sd_n)
    differ.items.push_back(msg("the zero of the force by {}", as_n(s[k_force_zero], 3)));
  if (s[k_surface_position] > 0.003)
    differ.items.push_back(msg("the place of the surface by {}", as_mm(s[k_surface_position], 3)));
  if (s[k_stiffness] > 0.01)
    differ.items.push_back(msg("stiffness by {}", as_percent(100.0 * s[k_stiffness], 1)));
  if (s[k_lateness] > 5e-4)
    differ.items.push_back(msg("lateness of the force, or c, by {}",
                               as_unit(1e3 * s[k_lateness], cavum::Unit::ms, 1)));
  if (!differ.items.empty())
    e.notes.emplace_back("sessions_differ", std::vector{"by"},
                         msg("sessions differ (standard deviation): {}", differ));
}

/// A zero of the force, a stiffness, or a lateness, that differs between sessions by what no
/// simulation should miss; none where they are alike.
std::optional<Unexplained> sessions_apart(const Explanation& e) {
  if (e.spread[k_force_zero] > k_zero_differs * e.noise.sd_n)
    return Unexplained{"session", msg("a zero of the force that differs from session to session"),
                       e.spread[k_force_zero]};
  if (e.spread[k_stiffness] > k_stiffness_differs)
    return Unexplained{
        "session", msg("a stiffness that differs from session to session"),
        e.spread[k_stiffness] *
            std::sqrt(static_cast<double>(e.after->effects->col(k_stiffness).squaredNorm()) /
                      static_cast<double>(e.after->effects->rows()))};
  const double late_n =
      e.spread[k_lateness] * std::sqrt(e.after->effects->col(k_lateness).squaredNorm() /
                                       static_cast<double>(e.after->effects->rows()));
  if (late_n > k_zero_differs * e.noise.sd_n)
    return Unexplained{"session",
                       msg("a lateness of the force, or c, that differs from session to session"),
                       late_n};
  const double known_n = std::hypot(e.gain.noise_floor_n, e.position_error_n);
  if (e.gain.base_rmse_n > k_more_than_noise * known_n)
    return Unexplained{"session", msg("more than the noise, of no form that is looked for"),
                       std::sqrt(e.gain.base_rmse_n * e.gain.base_rmse_n - known_n * known_n)};
  return std::nullopt;
}

/// What is named, alone or as what fits as well, was testable in the end: the first look had not
/// taken the other causes out yet.
void drop_named_untestable(Explanation& e) {
  std::erase_if(e.not_testable, [&](const NotTestable& n) {
    return std::any_of(e.causes.begin(), e.causes.end(), [&](const Cause& c) {
      return n.mechanism == mechanism_of(c.term).name ||
             std::find(c.aliases.begin(), c.aliases.end(), n.mechanism) != c.aliases.end();
    });
  });
}

/// Something may be left over beside the causes; when it is more than what was found, they are not
/// the answer.
void drop_lesser_causes(Explanation& e, const Step& last) {
  if (!e.unexplained || e.causes.empty()) return;
  double left = 0.0;
  for (const auto& s : e.structures)
    if (s.variable == e.unexplained->variable) left = s.gain;
  const double explained =
      fit(*last.view.products, {}).chi2 - fit(*last.view.products, known_of(last.view)).chi2;
  if (left > explained) e.causes.clear();
}

/// What stays unexplained may belong to a cause's own force in part: its numbers are then no better
/// known than that part of them.
void widen_by_unexplained(Explanation& e) {
  if (!e.unexplained) return;
  for (auto& c : e.causes) {
    const double share =
        c.effect_n > 0.0 ? std::min(1.0, e.unexplained->effect_n / c.effect_n) : 1.0;
    for (auto& [name, interval] : c.parameters) {
      const double more = share * std::fabs(interval.value);
      interval.low = std::min(interval.low, interval.value - more);
      interval.high = std::max(interval.high, interval.value + more);
    }
  }
}

}  // namespace

Explanation explain(const Recording& given, const ExplainOptions& options) {
  Explanation e = opened(given, options);
  if (!e.data_faults.empty()) return e;
  int finished = 0;
  const auto done = [&] {
    const int n = ++finished;
    if (options.progress)
      options.progress(
          0.9 * (1.0 - std::exp(-0.7 * n)));  // two looks are usual; the bar never runs backwards
  };

  CauseSearch search = begin_search(*e.recording, options, done);
  const Step first = search.step;
  const bool one_way = moves_one_way(*search.motion);
  const auto find = [&] {
    for (int again = 0; again <= k_rounds; ++again) {
      e.unexplained = add_causes(search);
      e.causes.clear();
      bool changed = weigh_causes(search, e.causes);
      changed = prefer_plainer(search) || changed;
      if (one_way) changed = make_offsets(search) || changed;
      for (std::size_t i = 0; i < search.causes.size(); ++i) e.causes[i].term = search.causes[i];
      if (!changed) return;
      look_again(search);
      if (search.causes.empty()) return;
    }
  };
  find();
  for (int again = 0; take_back(search, e.causes, first, again < k_rounds);
       ++again) {  // beside a plainer law others may show
    find();
  }
  alias_by_shape(e.causes, search);
  drop_named_aliases(e.causes);
  if (one_way) alias_offsets(e.causes);
  put_figures(e, options, first, search.step);
  while (drop_unlikely(search, e)) {
    take_back(search, e.causes, first, false);
    put_figures(e, options, first, search.step);
  }
  if (!e.causes.empty() && e.gain.percent.low <= k_min_low_percent) {
    search.doubted_percent = std::max(search.doubted_percent, e.gain.percent.value);
    e.causes.clear();
  }
  if (is_doubted(search) && e.causes.empty() && !e.unexplained) e.unexplained = doubtful(first);
  report_differences(e, *search.motion);
  if (e.causes.empty() && !e.unexplained) e.unexplained = sessions_apart(e);
  drop_lesser_causes(e, search.step);
  drop_named_untestable(e);
  widen_by_unexplained(e);
  conclude(e, one_way);
  compare_with_rig(e, e.recording->rig, e.recording->v_mm_s.size() > 0);
  if (options.progress) options.progress(1.0);
  return e;
}

}  // namespace cavum::explain
