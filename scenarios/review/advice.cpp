#include "scenarios/review/advice.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "engine/base/text.h"
#include "engine/tooth/adjacent.h"
#include "scenarios/exam/runner.h"
#include "scenarios/file/checked_toml.h"
#include "scenarios/file/condition.h"
#include "scenarios/file/expression.h"
#include "scenarios/file/measures.h"
#include "scenarios/file/names.h"
#include "scenarios/file/rubric_check.h"
#include "scenarios/operators/expert_time.h"
#include "scenarios/operators/operator.h"
#include "scenarios/review/wall_areas.h"

namespace cavum::scenarios {
namespace {

constexpr double k_thin_wall_mm2 =
    1.0;  // of a wall thinner than the leeway: less is a rim where the crown curves away
constexpr double k_useless_share = 0.1, k_poor_share = 0.6;  // of the target, within a bur's reach
constexpr double k_coarse_leaf_mm = 0.1;
constexpr double k_min_wall_mm2 = 0.05;  // less hard tissue beside the target is no wall
using Ranges = std::map<std::string, ValueRange>;

/// "a, b or c": first what measures nothing else.
std::string measures_of_protection() {
  std::vector<std::string> names;
  for (const bool alone : {true, false})
    for (const auto& m : measures())
      if (m.counts_protected && (m.needs == Needs::protection) == alone) names.push_back(m.name);
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i)
    list += (i == 0 ? "" : i + 1 < names.size() ? ", " : " or ") + names[i];
  return list;
}

class Adviser {
 public:
  Adviser(const Scenario& scenario, const Tooth& tooth, const ZoneMap& zones,
          const std::vector<Bur>& burs)
      : s_(scenario),
        tooth_(tooth),
        own_(own_tooth(tooth)),
        zones_(zones),
        burs_(burs),
        limit_s_(static_cast<double>(exam_limit_ticks(scenario)) * k_tick_s) {
    for (const auto& t : tooth.tissues)
      role_[t.id] = among(s_.perforation.aims, t.name)     ? 1
                    : among(s_.perforation.faults, t.name) ? 2
                                                           : 0;
  }

  void target();
  void leeway();
  void walls();
  void time(ExpertsPart& expert);
  void steps();
  void criteria();
  [[nodiscard]] std::vector<Problem> take() { return std::move(problems_); }

 private:
  static bool among(const std::vector<std::string>& list, const std::string& name) {
    return std::find(list.begin(), list.end(), name) != list.end();
  }
  void warn(const std::string& place, const Message& what, const Message& what_to_do,
            Mistake mistake = Mistake::other) {
    problems_.push_back(problem_at(s_, place, what, what_to_do, mistake));
    problems_.back().warning = true;
  }
  [[nodiscard]] Number mm3(std::uint64_t leaves) const {
    return as_mm3(static_cast<double>(leaves) * zones_.leaf_volume_mm3(), 2);
  }
  [[nodiscard]] double volume(std::initializer_list<Zone> list) const {
    double sum = 0;
    for (const Zone z : list)
      sum += static_cast<double>(zones_.count(z)) * zones_.leaf_volume_mm3();
    return sum;
  }
  [[nodiscard]] ExamExtent extent() const;
  void step_condition(std::size_t step, const char* key, const std::string& text,
                      const Ranges& ranges);
  void criterion(std::size_t i, const CriterionSpec& c, const Measure& measure,
                 const ValueRange& range);
  void wall_criterion(std::size_t i, const Measure& measure, const WallAreas& mm2);

  const Scenario& s_;
  const Tooth& tooth_;
  const Tooth own_;  // without what stands beside it
  const ZoneMap& zones_;
  const std::vector<Bur>& burs_;
  double limit_s_;
  std::array<int, 256> role_{};  // 1 aim, 2 fault
  std::vector<Problem> problems_;
};

void Adviser::target() {
  std::array<std::uint64_t, 256> inside{}, beside{};
  const Octree& tree = tooth_.octree;
  zones_.for_each_target_leaf([&](IVec3 leaf) {
    ++inside[tree.tissue(leaf)];
    for (const IVec3 step : k_six_neighbours)
      if (zones_.zone(leaf + step) != Zone::target) ++beside[tree.tissue(leaf + step)];
  });
  for (const auto& t : tooth_.tissues) {
    if (t.id == k_air || role_[t.id] == 1 || (role_[t.id] == 0 && tree.is_solid(t.id))) continue;
    const bool fault = role_[t.id] == 2;
    const Message remedy = fault ? msg("make the target smaller, or list '{}' under aims", t.name)
                                 : msg("list '{}' under aims or faults of [perforation]", t.name);
    if (inside[t.id] > 0)
      warn("zones/target/0",
           fault ? msg("the target holds {} of {}, which must not be opened", mm3(inside[t.id]),
                       t.name)
                 : msg("the target holds {} of {}, which is neither an aim nor a fault",
                       mm3(inside[t.id]), t.name),
           remedy, Mistake::trespass);
    else if (beside[t.id] > 0)
      warn("zones/target/0",
           fault ? msg("the target touches the {}, which must not be opened", t.name)
                 : msg("the target touches the {}, which is neither an aim nor a fault", t.name),
           remedy, Mistake::trespass);
  }
  if (zones_.guarded_in_target() > 0)
    warn("zones/target/0",
         msg("the target reaches {} of what is protected, and the protection counts there",
             mm3(zones_.guarded_in_target())),
         msg("make the target smaller, or protect less"), Mistake::trespass);
}

void Adviser::leeway() {
  std::array<std::uint64_t, 256> reached{};
  std::uint64_t guarded = 0;
  const auto& leeway = s_.zones.leeway;
  zones_.for_each_leaf([&](IVec3 leaf, Zone zone) {
    if (zone == Zone::target) return;
    const Wall wall = zones_.wall(leaf);
    if (wall == Wall::opening ||
        zones_.distance_mm(leaf) > (wall == Wall::floor ? leeway.bottom_mm : leeway.sides_mm))
      return;
    const auto tissue = tooth_.octree.tissue(leaf);
    if (tissue == k_air) return;
    ++reached[tissue];
    guarded += zone == Zone::protected_ && role_[tissue] != 2 ? 1 : 0;
  });
  for (const auto& t : tooth_.tissues)
    if (role_[t.id] == 2 && reached[t.id] > 0)
      warn("zones/leeway",
           msg("the leeway reaches {} of {}, which must not be opened: it is wider than the wall",
               mm3(reached[t.id]), t.name),
           msg("make the leeway narrower, or the target smaller"), Mistake::trespass);
  if (guarded > 0)
    warn("zones/leeway",
         msg("the leeway reaches {} of what is protected, and the protection counts there",
             mm3(guarded)),
         msg("make the leeway narrower, or protect less"), Mistake::trespass);
}

/// Walls that end in the air before the leeway does.
void Adviser::walls() {
  const WallAreas thin = thin_walls_mm2(s_.zones, tooth_, own_, zones_);
  for (std::size_t w = 0; w < k_walls; ++w)
    if (thin[w] >= k_thin_wall_mm2)
      warn("zones/leeway",
           msg("the leeway is wider than {} of the tooth over {}: it leads out into the air",
               wall_text(w, zones_.facing()), as_mm2(thin[w], 1)),
           msg("make the leeway narrower, or move the target inwards"), Mistake::trespass);
}

void Adviser::time(ExpertsPart& expert) {
  if (zones_.leaf_mm() > k_coarse_leaf_mm)
    warn(
        "tooth",
        msg("the tooth's leaves are {} wide: zones, reach and figures are known to half of that only",
            as_mm(zones_.leaf_mm(), k_as_needed)),
        msg("make the tooth with leaves of 0.05 mm"));
  if (!zones_.target_is_open()) {
    warn(
        "zones/target/0",
        msg("the target lies buried: no part of it is at the tooth's surface, so no bur comes to it without cutting elsewhere"),
        msg("let the target reach up to the surface, for example by a shape \"column\" over it"),
        Mistake::unreachable);
    return;
  }
  std::vector<ContactTool> tray;
  for (const auto& p : burs_) tray.push_back(make_contact_tool(p));
  const ChosenBur chosen = choose_bur(zones_, tooth_, tray);
  // on coarse leaves a bur may fit by half a leaf, which the plan cannot tell: only what fails with
  // that to spare is sure
  const double spare = 0.5 * zones_.leaf_mm();
  const MarginSpec at_most{k_expert_margin.sides_mm + spare, k_expert_margin.bottom_mm + spare};
  std::vector<double> covers = chosen.covers;
  if (!covers.empty() && *std::min_element(covers.begin(), covers.end()) < k_poor_share) {
    const FreeRoom room = free_room(zones_, tooth_, at_most);
    for (std::size_t i = 0; i < tray.size(); ++i)
      if (covers[i] < k_poor_share)
        covers[i] =
            std::max(covers[i], coverage(room, reach_map(room, zones_, tooth_, tray[i]), tray[i]));
  }
  double best = 0;
  for (const double share : covers) best = std::max(best, share);
  expert.reach = best;
  const auto percent = [](double share) { return as_percent(100 * share); };
  for (std::size_t i = 0; i < tray.size(); ++i)
    if (covers[i] < k_useless_share)
      warn(fmt::format("burs/{}", i),
           msg("the bur '{}' fits into {} of the target", burs_[i].name, percent(covers[i])),
           msg("take it out, or make the target wider"), Mistake::unreachable);
  if (best < k_poor_share)
    warn("burs", msg("no allowed bur removes more than {} of the target", percent(best)),
         msg("allow one that fits, or make the target wider"), Mistake::unreachable);
  if (chosen.index == tray.size()) return;
  const auto way = plan_work(chosen, tooth_, tray, s_.perforation.aims);
  expert.time_s =
      expert_time_s(way, chosen.map.tool, tooth_, tray[chosen.index], make_skill("expert", 1));
  if (*expert.time_s > limit_s_)
    warn("time_limit_s",
         msg("the built-in expert needs about {}, and the limit is {}", as_s(*expert.time_s, 0),
             as_s(limit_s_, k_as_needed)),
         msg("allow more time, or see what `cavum scenario solve` reaches"), Mistake::unreachable);
}

/// What can happen in this tooth.
ExamExtent Adviser::extent() const {
  ExamExtent e;
  const auto leaves = tooth_.octree.count_leaves();
  for (const auto& t : tooth_.tissues) {
    const double mm3_of = static_cast<double>(leaves[t.id]) * zones_.leaf_volume_mm3();
    if (t.id != k_air && !is_adjacent(t.name)) e.tooth_mm3 += mm3_of;
    e.tissue_mm3[t.name] = mm3_of;
  }
  e.limit_s = limit_s_;
  e.over_limit_s = s_.force_limit_n > 0 ? limit_s_ : 0.0;
  e.target_mm3 = zones_.target_mm3();
  e.protected_mm3 = volume({Zone::protected_});
  e.leeway_sides_mm3 = volume({Zone::leeway_sides});
  e.leeway_bottom_mm3 = volume({Zone::leeway_bottom});
  e.leeway_mm3 = volume({Zone::leeway_sides, Zone::leeway_bottom});
  e.container_sides_mm3 = volume({Zone::container_sides});
  e.container_bottom_mm3 = volume({Zone::container_bottom});
  e.container_mm3 = volume({Zone::container_sides, Zone::container_bottom});
  e.steps = static_cast<double>(s_.steps.size());
  e.fault = s_.perforation.faults.empty() ? 0.0 : 1.0;
  e.rpm = s_.max_rpm;
  e.last_bur = static_cast<double>(s_.burs.size()) - 1;
  return e;
}

/// Of the live quantities, in a step that may take `step_s`.
Ranges live_ranges(ExamExtent exam, double step_s) {
  exam.step_s = step_s;
  Ranges r;
  for (const auto& q : k_live_quantities)
    if (q.most != nullptr) r[std::string(q.name)] = {0, exam.*q.most->value};
  for (const auto& [tissue, mm3] : exam.tissue_mm3) r["touched_" + tissue] = {0, mm3};
  return r;
}

void Adviser::step_condition(std::size_t step, const char* key, const std::string& text,
                             const Ranges& ranges) {
  if (text.empty()) return;
  const std::string place = fmt::format("steps/{}/{}", step, key);
  std::vector<std::string> known;
  for (const auto& t : tooth_.tissues) known.push_back("touched_" + t.name);
  Ranges with_missing = ranges;
  for (const auto& name : names_in_expression(text)) {
    if (name.rfind("touched_", 0) != 0 || ranges.count(name) > 0) continue;
    warn(place, msg("this tooth has no tissue '{}', so '{}' stays 0", name.substr(8), name),
         suggestion(name, known), Mistake::unknown_tissue);
    with_missing[name] = {0, 0};
  }
  const Outlook outlook = judge_condition(text, with_missing);
  const bool completes = std::string(key) == "complete_when";
  if (outlook == Outlook::never)
    warn(place, msg("'{}' can never come true", key),
         completes
             ? msg("ask for something that can be reached, or the step ends by its time limit only")
             : msg("ask for something that can happen, or take it out"),
         Mistake::unreachable);
  if (outlook == Outlook::always)
    warn(place, msg("'{}' is true from the first tick", key),
         completes ? msg("ask for something that is still to be done") : msg("take it out"),
         Mistake::idle);
}

void Adviser::steps() {
  const ExamExtent exam = extent();
  for (std::size_t i = 0; i < s_.steps.size(); ++i) {
    const StepSpec& step = s_.steps[i];
    const Ranges ranges =
        live_ranges(exam, std::min(limit_s_, step.time_limit_s.value_or(limit_s_) *
                                                 (1 + s_.accommodations.extra_time_percent / 100)));
    step_condition(i, "complete_when", step.complete_when, ranges);
    step_condition(i, "fail_when", step.fail_when, ranges);
    if (step.time_limit_s && *step.time_limit_s > s_.time_limit_s)
      warn(fmt::format("steps/{}/time_limit_s", i),
           msg("the step's time limit is longer than the exam's"),
           msg("make it shorter, or take it out"), Mistake::idle);
  }
}

void Adviser::criterion(std::size_t i, const CriterionSpec& c, const Measure& measure,
                        const ValueRange& range) {
  const std::string place = fmt::format("rubric/criteria/{}", i);
  const auto share = [&](double v) {
    return std::clamp((v - c.zero) / (c.full - c.zero), 0.0, 1.0);
  };
  const double best = std::max(share(range.low), share(range.high)),
               worst = std::min(share(range.low), share(range.high));
  const Message runs =
      range.high >= k_no_end    ? msg("'{}' never falls below {}", c.metric, as_number(range.low))
      : range.low == range.high ? msg("'{}' is always {} here", c.metric, as_number(range.low))
                                : msg("'{}' runs from {} to {} here", c.metric,
                                      as_number(range.low), as_number(range.high));
  if (c.points > 0 && best <= 0)
    warn(place + "/zero", msg("nobody can win these points: {}", runs),
         msg("set 'full' and 'zero' within that"), Mistake::unreachable);
  else if (c.points > 0 && worst >= 1)
    warn(place + "/full", msg("nobody can lose these points: {}", runs),
         msg("set 'full' and 'zero' within that, or take the criterion out"), Mistake::idle);
  else if (c.points > 0 && best < 1)
    warn(place + "/full", msg("nobody can win all of these points: {}", runs),
         msg("set 'full' within that"), Mistake::unreachable);
  if (c.critical_below && c.critical_above && *c.critical_below > *c.critical_above)
    warn(place + "/critical_below",
         msg("everybody fails: every value is below {} or above {}", as_number(*c.critical_below),
             as_number(*c.critical_above)),
         msg("make critical_below the smaller of the two"), Mistake::contradictory);
  else if ((c.critical_below && c.full < *c.critical_below) ||
           (c.critical_above && c.full > *c.critical_above))
    warn(place + (c.critical_below && c.full < *c.critical_below ? "/critical_below"
                                                                 : "/critical_above"),
         msg("who has full marks at {} fails by it all the same", as_number(c.full)),
         msg("let the critical limit lie beyond 'full'"), Mistake::contradictory);
  if (measure.needs == Needs::aim && s_.perforation.aims.empty())
    warn(
        place + "/metric",
        msg("'{}' measures the access to a tissue that is the aim, and this scenario names none: nobody can win these points",
            c.metric),
        msg("name the aim in [perforation], or take the criterion out"), Mistake::unreachable);
  if ((c.critical_above && *c.critical_above < range.low) ||
      (c.critical_below && *c.critical_below > range.high))
    warn(place + (c.critical_above && *c.critical_above < range.low ? "/critical_above"
                                                                    : "/critical_below"),
         msg("everybody fails by this: {}", runs), msg("set it within that"),
         Mistake::contradictory);
  else if (c.critical_above && *c.critical_above >= range.high)
    warn(place + "/critical_above", msg("nobody can fail by this: {}", runs),
         msg("set it within that, or take it out"), Mistake::idle);
  else if (c.critical_below && *c.critical_below <= range.low)
    warn(place + "/critical_below", msg("nobody can fail by this: {}", runs),
         msg("set it within that, or take it out"), Mistake::idle);
}

/// A figure of a wall that the cavity does not have.
void Adviser::wall_criterion(std::size_t i, const Measure& measure, const WallAreas& mm2) {
  if (measure.walls != 1 || mm2[measure.first_wall] >= k_min_wall_mm2) return;
  const Term wall = wall_text(measure.first_wall, zones_.facing());
  warn(fmt::format("rubric/criteria/{}/metric", i),
       measure.figure == WallFigure::max_over
           ? msg("in this tooth the cavity does not have {}: nobody can lose these points", wall)
           : msg("in this tooth the cavity does not have {}: nobody can win these points", wall),
       msg("take the criterion out, or measure a wall that stays"),
       measure.figure == WallFigure::max_over ? Mistake::idle : Mistake::unreachable);
}

void Adviser::criteria() {
  const ExamExtent exam = extent();
  const WallAreas walls_mm2 = hard_walls_mm2(own_, zones_);
  for (std::size_t i = 0; i < s_.rubric.criteria.size(); ++i) {
    const CriterionSpec& c = s_.rubric.criteria[i];
    const std::string place = fmt::format("rubric/criteria/{}", i);
    if (!(c.points > 0) && !c.critical_above && !c.critical_below && c.band_limits.empty())
      warn(place + "/points", msg("the criterion gives no points and decides nothing"),
           msg("give it points or a critical limit, or take it out"), Mistake::idle);
    const Measure measure = known_measure(c.metric);
    if (const auto high = most_of(measure, exam)) criterion(i, c, measure, {0, *high});
    wall_criterion(i, measure, walls_mm2);
  }
  for (auto& p : turned_round(s_.rubric)) problems_.push_back(std::move(p));
  const bool guard_judged =
      std::any_of(s_.rubric.criteria.begin(), s_.rubric.criteria.end(), [](const CriterionSpec& c) {
        return known_measure(c.metric).counts_protected && (c.points > 0 || c.critical_above);
      });
  if (!guard_judged && !s_.zones.protected_shapes.empty())
    warn("zones/protected/0",
         msg("what is protected can be removed for nothing: no criterion measures it"),
         msg("add one on {}, or take [[zones.protected]] out", measures_of_protection()),
         Mistake::idle);
  const bool fault_judged =
      std::any_of(s_.rubric.criteria.begin(), s_.rubric.criteria.end(),
                  [](const CriterionSpec& c) { return known_measure(c.metric).counts_faults; });
  if (!fault_judged && !s_.perforation.faults.empty())
    warn(
        "rubric/criteria/0/metric",
        msg("who opens what must not be opened ([perforation] faults) loses nothing by it: no criterion asks for it"),
        msg("add one on perforated, with critical_above = 0.5"), Mistake::idle);
  if (!(s_.rubric.pass_percent > 0) && s_.rubric.bands.empty())
    warn("rubric", msg("everybody passes: the pass mark is 0 %"), msg("set 'pass_percent' above 0"),
         Mistake::idle);
}

}  // namespace

std::vector<Problem> advise_rubric(Scenario scenario, const RubricSpec& rubric, const Tooth& tooth,
                                   const ZoneMap& zones) {
  scenario.rubric = rubric;
  scenario.path = rubric.path;
  scenario.places.clear();
  for (std::size_t i = 0; i < rubric.criteria.size(); ++i)
    scenario.places[fmt::format("rubric/criteria/{}", i)] =
        rubric.criteria[i].metric_at;  // and so of all that it holds
  Adviser a(scenario, tooth, zones, {});
  a.criteria();
  return a.take();
}

std::vector<Problem> advise(const Scenario& scenario, const Tooth& tooth, const ZoneMap& zones,
                            const std::vector<Bur>& burs, ExpertsPart& expert) {
  Adviser a(scenario, tooth, zones, burs);
  a.target();
  a.leeway();
  a.walls();
  a.time(expert);
  a.steps();
  a.criteria();
  std::vector<Problem> problems = a.take();
  for (auto& p : charged_twice(scenario.rubric)) problems.push_back(std::move(p));
  return problems;
}

}  // namespace cavum::scenarios
