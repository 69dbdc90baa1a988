#include "grading/trial/trial.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <set>
#include <thread>

#include "engine/base/independent_runs.h"
#include "engine/base/text.h"
#include "grading/trial/coarse_tooth.h"
#include "grading/trial/growing_errors.h"
#include "scenarios/exam/runner.h"
#include "scenarios/file/measures.h"
#include "scenarios/file/rubric_check.h"
#include "scenarios/zones/placed.h"

namespace cavum::grading {
namespace {

constexpr std::int64_t k_max_wait_ticks = std::int64_t{600} * k_ticks_per_second;  // 60 MB of ticks

/// Not more than these: each holds a tooth of its own.
std::size_t threads() { return std::min(4U, std::thread::hardware_concurrency()); }

/// What only a hand on a stylus makes.
bool needs_physics(const std::string& metric) {
  static const std::set<std::string> k_all{
      "time_s",       "handpiece_time_s",   "idle_s",  "force_mean_n",
      "force_peak_n", "force_over_limit_s", "path_mm", "perforation_events"};
  return k_all.contains(metric);
}

std::vector<Message> caught_by(const Result& r) {
  std::vector<Message> critical, all_points;
  for (const auto& c : r.criteria) {
    if (c.critical_failed) critical.emplace_back(Name{c.id});
    if (c.max > 0 && c.points <= 0) all_points.emplace_back(Name{c.id});
  }
  if (!critical.empty()) return critical;
  if (r.verdict == Verdict::review && !r.progress.open_last_step.empty())
    return {msg("step {}", r.progress.open_last_step)};
  return all_points;
}

/// Its value is worse than that of honest work, by more than both are unsure of. 'by_task'
/// measures: further from full marks is not known, so any difference counts.
bool worse(const scenarios::Measure& m, const MetricValue& wrong, const MetricValue& honest) {
  if (!wrong.value || !honest.value) return honest.value.has_value();
  const double by = m.better == scenarios::Better::more ? *honest.value - *wrong.value
                                                        : *wrong.value - *honest.value;
  return (m.better == scenarios::Better::by_task ? std::fabs(by) : by) > wrong.bound + honest.bound;
}

/// Which measure should have caught a piece of work.
struct Should {
  std::string metric;                               ///< empty: none that is known
  const scenarios::CriterionSpec* there = nullptr;  ///< a criterion on it
  MetricValue wrong;
  [[nodiscard]] Message text() const {
    if (metric.empty()) return {};
    return there != nullptr ? msg("{} ({})", there->id, metric) : msg("{}", metric);
  }
};

Should should_catch(const Task& task, const FaultyPreparation& work, const Result& r,
                    const Result& honest) {
  std::vector<std::string> metrics;
  if (!work.measure.empty()) metrics.push_back(work.measure);
  for (const auto& m : measures_against(work.mistake)) metrics.push_back(m);
  const auto& criteria = task.scenario.rubric.criteria;
  std::optional<Should> first;
  for (const auto& metric : metrics) {
    scenarios::RubricSpec alone;
    alone.criteria.emplace_back().metric = metric;
    if (!scenarios::not_in_this_exam(alone, task.scenario, task.tooth).empty()) continue;
    const MetricValue wrong = metric_value(r, metric);
    if (!worse(scenarios::known_measure(metric), wrong, metric_value(honest, metric))) continue;
    const auto there = std::find_if(criteria.begin(), criteria.end(),
                                    [&](const auto& c) { return c.metric == metric; });
    if (there != criteria.end()) return {metric, &*there, wrong};
    if (!first) first = Should{metric, nullptr, wrong};
  }
  return first.value_or(Should{});
}

/// What to do about a faulty preparation that passes.
Message advice_against(const Should& should) {
  if (should.metric.empty()) return msg("add a criterion that tells it from honest work");
  const Message value = should.wrong.value ? msg("{}", as_number(*should.wrong.value, 2))
                                           : msg("what honest work has");
  const bool more = scenarios::known_measure(should.metric).better == scenarios::Better::more;
  if (should.there == nullptr)
    return more ? msg("add a criterion on {} with a critical_below above {}", should.metric, value)
                : msg("add a criterion on {} with a critical_above below {}", should.metric, value);
  return more ? msg("give '{}', which measures {}, a critical_below above {}", should.there->id,
                    should.metric, value)
              : msg("give '{}', which measures {}, a critical_above below {}", should.there->id,
                    should.metric, value);
}

/// Beside the target's volume, how much of the work is wrong: left or removed beyond.
bool is_wrong(const Result& r) {
  constexpr double k_share = 0.25;
  const double beyond = r.volumes.removed.mm3 - (r.volumes.target.mm3 - r.volumes.missed.mm3);
  return r.volumes.missed.mm3 >= k_share * r.volumes.target.mm3 ||
         beyond >= k_share * r.volumes.target.mm3;
}

TrialRow row_of(const std::string& name, const Message& what, const Result& r) {
  return {name, what, r.verdict, r.points, r.max_points, caught_by(r), {}};
}

/// A mistake when exactly the target does not pass, or loses points that have nothing to do with
/// the hand.
void judge_honest(const scenarios::Scenario& scenario, const Result& r,
                  std::vector<scenarios::Problem>& problems) {
  double points = 0, max = 0;
  const CriterionResult* worst = nullptr;
  for (const auto& c : r.criteria) {
    if (needs_physics(c.metric)) continue;
    points += c.points;
    max += c.max;
    if (worst == nullptr || c.max - c.points > worst->max - worst->points || c.critical_failed)
      worst = &c;
  }
  const bool enough = points >= 0.01 * k_honest_percent * max;
  if (r.verdict == Verdict::pass && enough) return;
  const Message to_do = !r.progress.open_last_step.empty()
                            ? msg("make the condition of step '{}' one that this completes",
                                  r.progress.open_last_step)
                        : worst != nullptr ? msg("begin with '{}': {}", worst->id, worst->reason())
                                           : msg("give the rubric criteria");
  problems.push_back(scenarios::problem_at(
      scenario, "rubric",
      msg("who removes exactly the target gets {} of {} points that need no hand, and the verdict is {}",
          as_number(points, 1), as_number(max, 1), word_of(r.verdict)),
      to_do));
}

/// Failed, and by more than all bounds together: no finer look changes that.
bool surely_fails(const Result& r, const scenarios::RubricSpec& rubric) {
  if (r.verdict != Verdict::fail) return false;
  bool critical = false;
  for (std::size_t i = 0; i < r.criteria.size(); ++i) {
    const CriterionResult& c = r.criteria[i];
    const scenarios::CriterionSpec& spec = rubric.criteria[i];
    if (!c.value) {
      critical = critical || c.critical_failed;
      continue;
    }
    critical = critical || (spec.critical_above && *c.value - c.bound > *spec.critical_above) ||
               (spec.critical_below && *c.value + c.bound < *spec.critical_below);
  }
  const double short_by =
      r.pass_percent - r.borderline_percent -
      (r.max_points > 0 ? 100 * (r.points + r.points_bound) / r.max_points : 0.0);
  return critical || (r.compensatory && short_by > 0);
}

/// A scenario in a tooth, with the works for it.
struct Bench {
  Bench(const scenarios::Scenario& scenario, const Tooth& tooth, const scenarios::ZoneMap& zones)
      : task(make_task(scenario, tooth, zones)),
        field(tooth, zones),
        works(faulty_preparations(task, field)),
        errors(ladders(task, field)) {}
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;
  [[nodiscard]] Result honest(std::int64_t wait) const {
    return sit(task, honest_cut(field), box_of_work(field), wait);
  }
  [[nodiscard]] Result of(std::size_t work, std::int64_t wait, std::int64_t limit) const {
    return sit(task, works[work].cut, box_of_work(field, works[work].below_mm),
               works[work].waits ? limit : wait);
  }
  Task task;
  TargetField field;
  std::vector<FaultyPreparation> works;
  std::vector<Ladder> errors;
};

/// Both teeth, and what is found out on them.
class TrialRun {
 public:
  TrialRun(const scenarios::Scenario& scenario, const Tooth& tooth, const scenarios::ZoneMap& zones,
           Look look)
      : scenario_(scenario),
        fine_(scenario, tooth, zones),
        limit_(std::min(scenarios::exam_limit_ticks(scenario), k_max_wait_ticks)) {
    constexpr double k_fine_leaf_mm = 0.07;  // what is wider is quick as it is
    if (look == Look::full || tooth.octree.leaf_mm() > k_fine_leaf_mm) return;
    coarse_tooth_ = coarse_tooth(tooth);
    // in coarse leaves a fissure may not be found, or lie elsewhere
    coarse_zones_ = scenarios::follows_landmarks(scenario.zones)
                        ? scenarios::build_zones(scenario, coarse_tooth_, find_landmarks(tooth))
                        : scenarios::build_zones(scenario, coarse_tooth_);
    coarse_.emplace(scenario, coarse_tooth_, coarse_zones_);
  }

  Trial run() {
    honest_ = fine_.honest(0);
    if (!honest_.progress.open_last_step
             .empty()) {  // a step may ask for time, or for a look with the pedal off
      wait_ = limit_;
      honest_ = fine_.honest(wait_);
    }
    trial_.honest = row_of("honest", msg("exactly the target"), honest_);
    judge_honest(scenario_, honest_, trial_.problems);
    try_works();
    grow_errors();
    return std::move(trial_);
  }

 private:
  void try_works();
  void put(const FaultyPreparation& work, const Result& r);
  void grow_errors();
  /// Growth of error `l` on a bench.
  [[nodiscard]] std::vector<scenarios::Problem> growth(const Bench& bench, std::size_t l,
                                                       const Result& honest) const;

  const scenarios::Scenario& scenario_;
  Bench fine_;
  std::int64_t limit_, wait_ = 0;
  Tooth coarse_tooth_;
  scenarios::ZoneMap coarse_zones_;
  std::optional<Bench> coarse_;
  Result honest_;
  Trial trial_;
};

void TrialRun::try_works() {
  const std::size_t n = fine_.works.size();
  std::vector<std::optional<Result>> results(n);
  const auto try_one = [&](std::size_t i) {
    // the same list on both: what applies follows from the scenario, and what is below the floor
    // from both teeth
    const bool there =
        coarse_ && i < coarse_->works.size() && coarse_->works[i].name == fine_.works[i].name;
    if (there) results[i] = coarse_->of(i, wait_, limit_);
    if (!there || !surely_fails(*results[i], scenario_.rubric))
      results[i] = fine_.of(i, wait_, limit_);
  };
  independent_runs(n, try_one, threads());
  for (std::size_t i = 0; i < n; ++i) put(fine_.works[i], *results[i]);
}

void TrialRun::put(const FaultyPreparation& work, const Result& r) {
  if (work.may_be_right && !is_wrong(r)) return;
  const Should should = should_catch(fine_.task, work, r, honest_);
  TrialRow& row = trial_.rows.emplace_back(row_of(work.name, work.what, r));
  row.should = should.text();
  if (r.verdict != Verdict::pass) return;
  trial_.problems.push_back(scenarios::problem_at(
      scenario_, "rubric",
      row.should.empty()
          ? msg("a faulty preparation passes: '{}' ({}) gets {} of {} points", row.name, row.what,
                as_points(row.points), as_points(row.max))
          : msg("a faulty preparation passes: '{}' ({}) gets {} of {} points, and {} should have caught it",
                row.name, row.what, as_points(row.points), as_points(row.max), row.should),
      advice_against(should), scenarios::Mistake::faulty_preparations));
}

std::vector<scenarios::Problem> TrialRun::growth(const Bench& bench, std::size_t l,
                                                 const Result& honest) const {
  std::vector<Result> grown;
  for (const Cut& cut : bench.errors[l].cut)
    grown.push_back(sit(bench.task, cut, box_of_work(bench.field), wait_));
  return judge_growth(scenario_, bench.errors[l], honest, grown);
}

void TrialRun::grow_errors() {
  const std::size_t n = fine_.errors.size();
  std::vector<std::vector<scenarios::Problem>> problems(n);
  const bool screened = coarse_ && coarse_->errors.size() == n;
  std::optional<Result> honest;
  if (screened) honest = coarse_->honest(wait_);
  const auto grow = [&](std::size_t l) {
    if (!screened || !growth(*coarse_, l, *honest).empty()) problems[l] = growth(fine_, l, honest_);
  };
  independent_runs(n, grow, threads());
  for (auto& list : problems)
    for (auto& p : list) trial_.problems.push_back(std::move(p));
}

}  // namespace

Trial run_trial(const scenarios::Scenario& scenario, const Tooth& tooth,
                const scenarios::ZoneMap& zones, Look look) {
  const auto from = std::chrono::steady_clock::now();
  Trial trial = TrialRun(scenario, tooth, zones, look).run();
  trial.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
  return trial;
}

}  // namespace cavum::grading
