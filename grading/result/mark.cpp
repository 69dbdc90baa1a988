#include "grading/result/mark.h"

#include <algorithm>
#include <cmath>

#include "engine/base/text.h"
#include "grading/result/bands.h"
#include "grading/result/loss.h"
#include "grading/result/measure_marking.h"

namespace cavum::grading {
namespace {

using Kind = FindingKind;

constexpr char k_exam_time[] = "time_s";

struct Work {
  double percent = 100.0;  ///< of the target, or of what of it lies towards the walls in question
  std::optional<Term> towards;  ///< those walls; none: all of the target
  double bound_percent = 0.0;
  std::string wall = {};  ///< the identifier of the one wall, or "sides"
  [[nodiscard]] double share(double off = 0) const {
    return std::clamp((percent + off * bound_percent) / k_care_counts_percent, 0.0, 1.0);
  }
};

/// How much of the work was done that a criterion judges the care of.
Work work_done(const Result& r, const scenarios::Measure& measure) {
  const auto towards = [&](std::size_t first, std::size_t end,
                           const std::optional<Term>& where) -> Work {
    double all = 0, missed = 0, bound = 0;
    for (std::size_t w = first; w < end; ++w) {
      all += r.volumes.target_by_wall_mm3[w];
      missed += r.volumes.missed_by_wall_mm3[w];
      bound += r.volumes.missed_bound_by_wall_mm3[w];
    }
    if (all > 0) return {100 * (1 - missed / all), where, 100 * bound / all};
    if (!(r.volumes.target.mm3 > 0)) return {};
    return {r.volumes.target_removed_percent, {}, r.volumes.target_removed_bound_percent};
  };
  if (measure.judges == scenarios::Judges::work) return {};
  // a distance at some of the walls; volumes, also of what lies below the floor, ask for all of the
  // work
  if (measure.walls > 0 && measure.walls < scenarios::k_walls) {
    const bool one = measure.walls == 1;
    Work work = towards(measure.first_wall, measure.first_wall + measure.walls,
                        one ? scenarios::wall_text(measure.first_wall, r.shape.facing)
                            : Term{noop("the side walls")});
    work.wall =
        one ? scenarios::wall_name(static_cast<scenarios::Wall>(measure.first_wall)) : "sides";
    return work;
  }
  return towards(0, scenarios::k_walls + 1, {});
}

/// Of how many of its points remain for the work that was done.
Finding work_counts(const Work& work) {
  const Number done = as_percent(work.percent, 1, work.bound_percent),
               counts = as_percent(100 * work.share()),
               all_from = as_percent(k_care_counts_percent);
  return !work.towards
             ? finding<Kind::part_counts>(done, counts, all_from)
             : finding<Kind::part_towards_counts>(done, *work.towards, counts, all_from, work.wall);
}

/// Digits that it takes to tell a value from another one and from nothing.
int digits_for(double value, double other) {
  constexpr int k_most = 6;
  int digits = 2;
  while (digits < k_most && ((value != other && fixed(value, digits) == fixed(other, digits)) ||
                             (value != 0 && fixed(value, digits) == fixed(0, digits))))
    ++digits;
  return digits;
}

/// The question whether something was broken into that must not be.
bool asks_for_perforation(const Result& r, const scenarios::Measure& measure) {
  if (measure.tissue.empty()) return measure.counts_faults;
  return r.perforation.fault.perforated && measure.tissue == r.perforation.fault.tissue;
}

/// Facts about the critical limits, and whether one lies within the value's bound.
void judge_limits(const scenarios::CriterionSpec& c, double value, double bound,
                  const scenarios::Measure& measure, CriterionResult& out) {
  const auto near = [&](const std::optional<double>& limit) {
    return limit && bound > 0 && std::fabs(value - *limit) <= bound;
  };
  out.limit_in_bound = near(c.critical_above) || near(c.critical_below);
  const auto fact = [&]() -> Finding {
    const bool above = c.critical_above &&
                       (out.critical_failed ? value > *c.critical_above : near(c.critical_above));
    const auto& limit = above ? c.critical_above : c.critical_below;
    const Number at = as_number(limit.value_or(0), 2);
    if (!out.critical_failed) return finding<Kind::critical_in_bound>(at);
    const bool in_bound = near(limit);
    if (measure.reads == scenarios::Reads::yes_no)
      return in_bound ? finding<Kind::fails_exam_in_bound>() : finding<Kind::fails_exam>();
    if (in_bound)
      return above ? finding<Kind::above_critical_in_bound>(at)
                   : finding<Kind::below_critical_in_bound>(at);
    return above ? finding<Kind::above_critical>(at) : finding<Kind::below_critical>(at);
  };
  if (out.critical_failed || out.limit_in_bound) out.facts.push_back(fact());
}

/// `c`: as_marked.
CriterionResult mark_one(const Result& r, const scenarios::CriterionSpec& c) {
  const Asked a = asked(c.metric, c.full);
  CriterionResult out;
  Findings& facts = out.facts;
  out.id = c.id;
  out.title = c.title;
  out.metric = c.metric;
  out.unit = a.measure.unit;
  out.max = c.points;
  if (not_shown(r, a.measure)) {
    out.judged = false;
    facts.push_back(finding<Kind::not_shown>());
    if (c.critical_above || c.critical_below) facts.push_back(finding<Kind::not_shown_critical>());
    return out;
  }
  const MetricValue v = value_of(r, a);
  out.value = v.value;
  out.bound = v.bound;
  if (!v.value) {
    facts.push_back(finding<Kind::not_measured>());
    out.critical_failed = c.critical_below.has_value();
    out.first = r.end;
    return out;
  }
  const Work work = work_done(r, a.measure);
  const auto share_at = [&c](double value) {
    return std::clamp((value - c.zero) / (c.full - c.zero), 0.0, 1.0);
  };
  const double share = share_at(*v.value), low = share_at(*v.value - v.bound),
               high = share_at(*v.value + v.bound);
  out.work_share = work.share();
  out.points = c.points * share * out.work_share + 0.0;  // never -0
  out.points_bound = std::max(c.points * std::max(low, high) * work.share(1) - out.points,
                              out.points - c.points * std::min(low, high) * work.share(-1)) +
                     0.0;
  out.critical_failed = (c.critical_above && *v.value > *c.critical_above) ||
                        (c.critical_below && *v.value < *c.critical_below);
  if (share >= 1.0 && !out.critical_failed) {
    facts.push_back(out.work_share < 1 ? finding<Kind::full_marks_for_part>()
                                       : finding<Kind::full_marks>());
  } else {
    Loss loss = a.marking->reason(r, a);
    facts = std::move(loss.what);
    const int digits = digits_for(*v.value, c.full);
    // of a yes or no the loss says all
    if (facts.empty() || a.measure.reads != scenarios::Reads::yes_no)
      facts.push_back(finding<Kind::below_full>(value_text(a.measure, *v.value, v.bound, digits),
                                                value_text(a.measure, c.full, 0, digits)));
    if (loss.first.tick < 0 && r.end.tick >= 0) {
      loss.first = r.end;
      facts.push_back(finding<Kind::at_end>(as_s(r.end.t_s(), 2), r.end.tick));
    }
    out.first = loss.first;
  }
  if (const double stretch = granted_stretch(r); c.metric == k_exam_time && stretch != 1)
    facts.push_back(finding<Kind::granted_limits>(as_number(std::round(100 * stretch) / 100)));
  judge_limits(c, *v.value, v.bound, a.measure, out);
  if (out.work_share < 1) {
    if (out.first.tick < 0) out.first = r.end;
    facts.push_back(work_counts(work));
  }
  return out;
}

/// What counts against the pass mark: all points together, or the lowest criterion.
struct Standing {
  double percent = 100.0;
  std::string criterion;  ///< its id; empty: all points together
  bool none = false;      ///< there is nothing to judge by
  double bound_percent = 0.0;
};

Standing standing_of(const Result& r) {
  Standing s;
  if (r.compensatory) {
    double sum = 0;
    for (const auto& c : r.criteria) sum += c.points;
    if (!(r.max_points > 0)) return {0, "", false, 0};
    return {100 * sum / r.max_points, "", false, 100 * r.points_bound / r.max_points};
  }
  for (const auto& c : r.criteria) {
    if (!(c.max > 0) || !c.judged) continue;
    const double percent = 100 * c.points / c.max;
    if (percent < s.percent || s.criterion.empty())
      s = {percent, c.id, false, 100 * c.points_bound / c.max};
  }
  s.none = s.criterion.empty();
  return s;
}

/// The worst and the best that the points could be, percent, whatever the criteria that were not
/// judged are worth.
struct Reach {
  double least = 0.0, most = 0.0;
};
Reach reach_of(const Result& r, const Standing& judged) {
  if (!r.compensatory) return {0.0, judged.none ? 100.0 : judged.percent};
  const double all = r.max_points + r.unjudged_points;
  return {100 * r.points / all, 100 * (r.points + r.unjudged_points) / all};
}

/// What was not judged can make no pass: it is one only when it is one whatever that is worth, and
/// a fail only when nothing could mend it.
void weigh_unjudged(Result& r, const scenarios::RubricSpec& rubric, const Standing& standing,
                    bool critical) {
  std::vector<std::string> open, guarded;
  for (std::size_t i = 0; i < r.criteria.size(); ++i) {
    if (r.criteria[i].judged) continue;
    const scenarios::CriterionSpec& spec = rubric.criteria[i];
    open.push_back(spec.id);
    if (spec.critical_above || spec.critical_below) guarded.push_back(spec.id);
  }
  if (open.empty()) return;
  r.verdict_reasons.push_back(finding<Kind::not_judged>(list_of(open), as_points(r.unjudged_points),
                                                        as_points(r.max_points)));
  if (critical) return;
  const Reach reach =
      r.unjudged_points > 0 ? reach_of(r, standing) : Reach{standing.percent, standing.percent};
  const auto verdict_at = [&](double percent) {
    const double beyond = percent - rubric.pass_percent;
    return std::fabs(beyond) < rubric.borderline_percent ? Verdict::review
           : beyond < 0                                  ? Verdict::fail
                                                         : Verdict::pass;
  };
  const Verdict worst = verdict_at(reach.least), best = verdict_at(reach.most);
  r.verdict = worst == best ? worst : Verdict::review;
  const Number least = as_percent(reach.least, 1), most = as_percent(reach.most, 1);
  if (r.unjudged_points > 0)
    r.verdict_reasons.push_back(worst == best
                                    ? finding<Kind::not_judged_same>(least, most, word_of(worst))
                                    : finding<Kind::not_judged_open>(least, most));
  if (r.verdict != Verdict::pass || guarded.empty()) return;
  r.verdict = Verdict::review;
  r.verdict_reasons.push_back(finding<Kind::not_judged_critical>(list_of(guarded)));
}

}  // namespace

Term word_of(Verdict v) { return {verdict_name(v)}; }

double granted_stretch(const Result& r) {
  const scenarios::Accommodations& granted = r.accommodations;
  const double with_s = static_cast<double>(r.limit_ticks) * k_tick_s,
               own_s = (with_s - granted.extra_time_s) / (1 + granted.extra_time_percent / 100);
  if (!(granted.extra_time_percent > 0) && !(granted.extra_time_s > 0)) return 1;
  if (!(granted.extra_time_s > 0))
    return 1 + granted.extra_time_percent / 100;  // to the digit, whatever the limit's ticks
  return own_s > 0 ? with_s / own_s : 1;
}

scenarios::CriterionSpec as_marked(scenarios::CriterionSpec c, const Result& r) {
  const double stretch = granted_stretch(r);
  if (c.metric != k_exam_time || stretch == 1) return c;
  c.full *= stretch, c.zero *= stretch;
  for (auto* limit : {&c.critical_above, &c.critical_below})
    if (*limit) **limit *= stretch;
  for (double& limit : c.band_limits) limit *= stretch;
  return c;
}

namespace {

/// Each criterion by itself, and the sums.
void mark_criteria(Result& r, const scenarios::RubricSpec& rubric) {
  r.criteria.clear();
  r.verdict_reasons.clear();
  r.points = r.max_points = r.points_bound = r.unjudged_points = 0;
  r.compensatory = rubric.compensatory;
  r.pass_percent = rubric.pass_percent;
  r.borderline_percent = rubric.borderline_percent;
  r.bands.clear();
  for (const auto& b : rubric.bands) r.bands.push_back({b.name, b.most});
  for (const auto& c : rubric.criteria) {
    const scenarios::CriterionSpec as = as_marked(c, r);
    r.criteria.push_back(mark_one(r, as));
    put_in_band(r, as, r.criteria.back());
    r.points += r.criteria.back().points;
    r.points_bound += r.criteria.back().points_bound;
    (r.criteria.back().judged ? r.max_points : r.unjudged_points) += r.criteria.back().max;
  }
}

/// What points and limits do not tell.
void ask_examiner(Result& r, const scenarios::RubricSpec& rubric) {
  if (!r.perforation.agree())
    r.verdict_reasons.push_back(r.perforation.detected() ? finding<Kind::force_without_tissue>()
                                                         : finding<Kind::tissue_without_force>());
  if (r.verdict == Verdict::pass && !r.progress.open_last_step.empty() &&
      !rubric.open_step_passes) {
    r.verdict = Verdict::review;
    r.verdict_reasons.push_back(finding<Kind::last_step_open>(r.progress.open_last_step));
  }
  if (r.perforation.fault.perforated &&
      std::none_of(r.criteria.begin(), r.criteria.end(), [&](const auto& c) {
        return asks_for_perforation(r, scenarios::known_measure(c.metric));
      }))
    r.verdict_reasons.push_back(finding<Kind::fault_not_asked>(Term{r.perforation.fault.tissue}));
  for (const Finding& note : r.notes)
    if (note.asks_examiner()) {
      r.verdict = Verdict::review;
      r.verdict_reasons.push_back(note);
    }
}

}  // namespace

void mark(Result& r, const scenarios::RubricSpec& rubric) {
  mark_criteria(r, rubric);
  bool critical = false, certain = false, limit_open = false;
  for (const auto& c : r.criteria) {
    limit_open = limit_open || c.limit_in_bound;
    if (!c.critical_failed) continue;
    critical = true;
    certain = certain || !c.limit_in_bound;
    r.verdict_reasons.push_back(finding<Kind::critical_limit>(c.id));
  }
  for (auto& too_full : count_bands(r)) {
    critical = certain = true;
    r.verdict_reasons.push_back(std::move(too_full));
  }
  const Standing standing = standing_of(r);
  const double beyond = standing.percent - rubric.pass_percent;
  const bool band = std::fabs(beyond) < rubric.borderline_percent;
  r.verdict = critical || beyond < 0 ? Verdict::fail : Verdict::pass;
  const bool open = !certain && !band && std::fabs(beyond) < standing.bound_percent;
  if (!critical && band) r.verdict = Verdict::review;
  const Number reached = as_percent(standing.percent, 1), pass = as_percent(rubric.pass_percent, 1);
  r.verdict_reasons.push_back(
      !standing.criterion.empty()
          ? finding<Kind::lowest_criterion_reaches>(standing.criterion, reached, pass)
      : r.unjudged_points > 0 ? finding<Kind::judged_sum_reaches>(reached, pass)
                              : finding<Kind::sum_reaches>(reached, pass));
  if (critical && beyond >= 0) r.verdict_reasons.push_back(finding<Kind::enough_alone>());
  if (!critical && band)
    r.verdict_reasons.push_back(
        finding<Kind::borderline>(as_percent(rubric.borderline_percent, 1)));
  if (open && !critical)
    r.verdict_reasons.push_back(
        finding<Kind::bound_crosses>(as_percent(standing.bound_percent, 1)));
  if (!r.compensatory)
    for (const auto& c : r.criteria)
      if (const double percent = c.max > 0 && c.judged ? 100 * c.points / c.max : 100.0;
          percent < rubric.pass_percent && standing.criterion != c.id)
        r.verdict_reasons.push_back(finding<Kind::criterion_below>(c.id, as_percent(percent, 1)));
  weigh_unjudged(r, rubric, standing, critical);
  // What fails by points whatever a limit's figure is, or the other way round, is not open.
  const bool fails_by_points = beyond < 0 && !band && !open;
  if (rubric.review_within_bound && !certain && !fails_by_points && (open || limit_open)) {
    r.verdict = Verdict::review;
    r.verdict_reasons.push_back(finding<Kind::bounds_open>());
  }
  ask_examiner(r, rubric);
}

}  // namespace cavum::grading
