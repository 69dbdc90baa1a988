#include "grading/feedback/loss_finder.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "grading/feedback/moments.h"
#include "grading/measures/motion.h"
#include "grading/measures/removed_map.h"
#include "grading/result/loss.h"
#include "grading/result/mark.h"

namespace cavum::grading {
namespace loss_list {
#define LISTED(LIST, WORDS) constexpr LossList LIST{WORDS, &LossFinder::LIST};
LOSS_LISTS(LISTED)
#undef LISTED
}  // namespace loss_list

LossList loss_list_of(const scenarios::Measure& measure) {
  static const std::map<std::string, LossList> k_all{
#define MEASURE(NAME, WORDS, WHAT, VALUE, REASON, MOMENTS, PLACE) {NAME, loss_list::MOMENTS},
#define FAMILY(KEY, MEMBERS, VALUE, REASON, MOMENTS) {scenarios::KEY, loss_list::MOMENTS},
#include "scenarios/file/measures_table.inc"
  };
  return k_all.at(measure.key());
}

LossFinder::LossFinder(const GradeInput& input, const Result& result,
                       const scenarios::CriterionSpec& spec, Why& why)
    : in_(input), r_(result), spec_(spec), why_(why), asked_(asked(spec.metric, spec.full)) {
  end_ = static_cast<std::int64_t>(std::min(input.inputs.size(), input.records.size()));
  for (const auto& e : input.events)
    if (e.as<Finished>() != nullptr) end_ = std::min(end_, e.tick + 1);
  if (input.inputs.empty()) end_ = std::int64_t{1} << 31;
}

void LossFinder::find() {
  (this->*loss_list_of(asked_.measure).list)();
  value_and_work();
}

void LossFinder::fact(Facts facts, std::optional<double> amount, const std::string& unit,
                      const Trace& t, double bound) {
  WhyItem item;
  item.facts = std::move(facts);
  item.amount = amount;
  if (bound > 0) item.bound = bound;
  item.unit = unit;
  if (t.tick >= 0) {
    item.tick = item.end_tick = t.tick;
    item.site_mm = t.site_mm;
  }
  why_.items.push_back(std::move(item));
}

double LossFinder::points_at(double value) const {
  return why_.criterion.work_share * spec_.points *
         std::clamp((value - spec_.zero) / (spec_.full - spec_.zero), 0.0, 1.0);
}

std::vector<WhyItem> LossFinder::whole_leaves(
    const std::function<bool(const RemovedAt&)>& counts) const {
  return removal_moments(in_, end_, counts);
}

void LossFinder::leave_out(const WhyItem& i) {
  ++why_.left_out;
  why_.left_out_amount += *i.amount;
  why_.left_out_points += i.points_lost.value_or(0);
}

void LossFinder::list_largest(std::vector<WhyItem> items) {
  std::erase_if(items, [this](const WhyItem& i) {
    const bool nothing = i.unit == "mm3" && *i.amount < k_min_moment_mm3;
    if (nothing) leave_out(i);
    return nothing;
  });
  for (const auto& i : keep_largest(items)) leave_out(i);
  for (auto& i : items) why_.items.push_back(std::move(i));
}

/// Moments of what was removed, whose volumes add up to the criterion's value: what each cost is
/// said where less is better.
void LossFinder::removed_moments(std::vector<WhyItem> items) {
  if (spec_.full < spec_.zero) {
    double before = 0;
    for (auto& i : items) {
      const double now = before + *i.amount;
      i.points_lost = points_at(before) - points_at(now);
      if (now <= spec_.full)
        i.facts.emplace_back("within_free", std::vector{"free"},
                             msg("within the {} that cost nothing", as_mm3(spec_.full, 2)));
      else if (before < spec_.full)
        i.facts.emplace_back("partly_free", std::vector{"beyond", "free"},
                             msg("{} of it beyond the {} that cost nothing",
                                 as_mm3(now - spec_.full, 3), as_mm3(spec_.full, 2)));
      else if (before >= spec_.zero)
        i.facts.emplace_back(
            "no_points_left", std::vector{"zero"},
            msg("beyond the {} at which no points are left", as_mm3(spec_.zero, 2)));
      before = now;
    }
  }
  list_largest(std::move(items));
}

std::vector<WhyItem> LossFinder::in_zones(const std::vector<scenarios::Zone>& zones) const {
  std::vector<RemovedShare> shares;
  for_each_removed_share(in_, RemovedMap(in_.removed, end_ - 1), end_ - 1,
                         [&](const RemovedShare& s) {
                           if (std::find(zones.begin(), zones.end(), s.zone) == zones.end()) return;
                           shares.push_back(s);
                           if (zones.size() == 1) shares.back().bound_mm3 += s.bottom_or_sides_mm3;
                         });
  return removal_moments(in_.zones, std::move(shares));
}

void LossFinder::missed(double points) {
  struct Part {
    double sum = 0;
    Vec3 middle;
  };
  std::array<Part, scenarios::k_walls + 1> parts;
  const RemovedMap removed(in_.removed, end_ - 1);
  in_.zones.for_each_target_leaf([&](IVec3 leaf) {
    if (removed.has(leaf)) return;
    Part& p = parts[static_cast<std::size_t>(in_.zones.wall(leaf))];
    p.sum += 1;
    p.middle += in_.zones.centre_mm(leaf);
  });
  for (std::size_t w = 0; w <= scenarios::k_walls; ++w) {
    const double mm3 = r_.volumes.missed_by_wall_mm3[w];
    if (!(mm3 > 0)) continue;
    const Part& p = parts[w];
    const Trace& last = r_.volumes.target_last[w];
    const Term wall = scenarios::wall_text(w, r_.shape.facing);
    const Vec3 middle_mm = p.sum > 0 ? p.middle / p.sum : Vec3();
    fact({p.sum > 0 ? Fact("target_left", {"wall", "middle"},
                           msg("target left towards {}, its middle at {}", wall, middle_mm))
                    : Fact("target_left_at", {"wall"}, msg("target left towards {}", wall)),
          last.tick >= 0 ? Fact("cut_last", msg("cut there last at this time"))
                         : Fact("never_cut", msg("nothing of it was cut there"))},
         mm3, "mm3", last.tick >= 0 ? last : r_.end, r_.volumes.missed_bound_by_wall_mm3[w]);
    if (r_.volumes.missed.mm3 > 0)
      why_.items.back().points_lost = points * mm3 / r_.volumes.missed.mm3;
    if (mm3 >= k_min_moment_mm3) continue;
    leave_out(why_.items.back());
    why_.items.pop_back();
  }
}

void LossFinder::walls(std::size_t first, std::size_t end,
                       std::optional<scenarios::WallFigure> figure) {
  const bool under = figure == scenarios::WallFigure::max_under,
             over =
                 figure == scenarios::WallFigure::max_over || figure == scenarios::WallFigure::p95;
  const double full = std::max(0.0, spec_.full);
  for (std::size_t w = first; w < end; ++w) {
    const WallMeasures& m = r_.shape.wall[w];
    const Term wall = scenarios::wall_text(w, r_.shape.facing);
    if (m.samples == 0 && !(m.max_over_mm > 0)) {
      fact({{"wall_uncut", {"wall"}, msg("{}: nothing was cut there", wall)}});
      continue;
    }
    fact({{"wall_figures",
           {"wall", "mean", "p95", "places"},
           msg("{}: mean {}, 95th percentile {}, of {} places (+ = overcut)", wall,
               as_mm(m.mean_mm, 2, m.mean_bound_mm), as_mm(m.p95_mm, 2, m.p95_bound_mm),
               m.samples)}});
    if (m.worst_over.tick >= 0 && !under && m.max_over_mm > full)
      fact({{"overcut_furthest", {"wall"}, msg("{}: furthest overcut", wall)}}, m.max_over_mm, "mm",
           m.worst_over, r_.shape.bound_mm);
    if (over || m.max_under_mm <= full) continue;
    const bool cut = m.worst_under.tick >= 0;
    fact({cut ? Fact("most_left", {"wall"},
                     msg("{}: most left standing, seen from the surface cut here", wall))
              : Fact("most_left_uncut", {"wall", "site"},
                     msg("{}: most left standing, at {}, where nothing was cut", wall,
                         m.worst_under.site_mm))},
         m.max_under_mm, "mm", m.worst_under, r_.shape.bound_mm);
  }
  if (under) return;
  // by parts of leaves, as zones are counted: a wall's part is never more than the zone's whole
  std::vector<RemovedShare> shares;
  for_each_removed_share(
      in_, RemovedMap(in_.removed, end_ - 1), end_ - 1, [&](const RemovedShare& s) {
        const auto w = static_cast<std::size_t>(in_.zones.wall(s.leaf));
        if (s.zone != scenarios::Zone::target && w >= first && w < end &&
            in_.before.octree.is_solid(s.tissue) && in_.zones.distance_mm(s.leaf) > full)
          shares.push_back(s);
      });
  list_largest(removal_moments(in_.zones, std::move(shares)));
}

void LossFinder::dice() {
  std::vector<WhyItem> beyond = in_zones(asked_.marking->zones);
  double too_much = 0;
  for (const auto& i : beyond) too_much += *i.amount;
  const double both = too_much + r_.volumes.missed.mm3,
               lost = both > 0 ? (spec_.points - why_.criterion.points) / both : 0.0;
  for (auto& i : beyond) i.points_lost = lost * *i.amount;
  missed(lost * r_.volumes.missed.mm3);
  list_largest(std::move(beyond));
}

void LossFinder::overhang() {
  const AccessMeasures& a = r_.access;
  if (!a.overhang)
    return fact({{"no_overhang", msg("this target opens nothing that could be overhung")}});
  const double lost =
      a.overhang->mm3 > 0 ? (spec_.points - why_.criterion.points) / a.overhang->mm3 : 0.0;
  std::vector<WhyItem> items = overhang_moments(in_, end_, a);
  for (auto& i : items) i.points_lost = lost * *i.amount;
  list_largest(std::move(items));
}

void LossFinder::canals() {
  double covered = 0;
  for (const auto& p : r_.access.canal_mouths) covered += p.part;
  if (!(covered > 0))
    return fact(
        {{"canals_open", msg("no canal's mouth has hard tissue on the straight line out")}});
  for (const auto& p : r_.access.canal_mouths) {
    if (!(p.part > 0)) continue;
    const Trace last = last_cut_near(in_, end_, p.middle_mm);
    fact(
        {{"canal_covered",
          {"middle"},
          msg("so much of a canal's mouth is covered by hard tissue on the straight line out, its middle at {}",
              p.middle_mm)},
         last_cut(last)},
        100 * p.part / p.whole, "%", last);
    if (last.tick < 0) why_.items.back().site_mm = p.middle_mm;
    why_.items.back().points_lost = (spec_.points - why_.criterion.points) * p.part / covered;
  }
}

/// Points that no moment accounts for: what the value as a whole costs, and what does not count
/// because too little of the work was done.
void LossFinder::value_and_work() {
  const CriterionResult& c = why_.criterion;
  if (!c.value) {
    fact({{"not_measured", msg("cannot be measured on this cavity")}}, {}, "", r_.end);
    why_.items.back().points_lost = spec_.points;
    return;
  }
  double accounted = why_.left_out_points;
  for (const auto& i : why_.items) accounted += i.points_lost.value_or(0);
  const double by_work =
      points_at(spec_.full) < spec_.points ? spec_.points - points_at(spec_.full) : 0.0;
  const double by_value = spec_.points - c.points - by_work - accounted;
  if (by_value > 1e-9) {
    const Number full{spec_.full, unit_of(c.unit).value_or(Unit::none), 2};
    fact({*c.value < spec_.full
              ? Fact("short_of_full", {"full"}, msg("short of {}, which gives full marks", full))
              : Fact("beyond_full", {"full"}, msg("beyond {}, which gives full marks", full))},
         std::fabs(*c.value - spec_.full), c.unit, c.first, c.bound);
    why_.items.back().points_lost = by_value;
  }
  if (by_work > 1e-9) {
    const auto part = std::find_if(c.facts.begin(), c.facts.end(), [](const Finding& f) {
      return f.kind == FindingKind::part_counts || f.kind == FindingKind::part_towards_counts;
    });
    fact({fact_of(*part)}, {}, "", r_.end);
    why_.items.back().points_lost = by_work;
  }
}

void LossFinder::steps() {
  std::int64_t last = 0;
  for (const auto& e : in_.events) {
    if (e.as<Overruns>() != nullptr)
      continue;  // late ticks of the computer, in nearly every second of a slow one: nothing that a
                 // candidate did
    const char* kind = kind_of(e.event);
    const Term word = word_of(e.event);
    const Fact what = std::visit(
        EachKind{
            [&](const AnyOf<StepStarted, StepCompleted, StepFailed, StepTimeUp> auto& of) {
              return Fact(kind, {"event", "step"}, msg("{} ({})", word, of.step + 1LL));
            },
            [&](const AnyOf<AimReached, Perforated> auto& of) {
              return Fact(kind, {"event", "tissue"},
                          msg("{} ({})", word, Term{in_.before.tissue_name(of.tissue)}));
            },
            [&](const Finished& of) {
              return Fact(kind, {"event", "how"}, msg("{} ({})", word, Term{finish_name(of.how)}));
            },
            [&](const AnyOf<TimeUp, BurNotAllowed, OverSpeed, PauseStarted, PauseEnded,
                            PauseRefused, HoldStarted, HoldEnded, RecordingGap, RecordingMoved,
                            ServoGap, Overruns, StylusSilent, StylusBack, PedalLost, PedalBack,
                            ServoStopped, ServoDisagrees, ServoLateness, WorkAfterEnd, LockAttempt,
                            OfficeHold, OfficeHoldReleased, Announced, AnnouncementRead,
                            TutorialStep, MeasuredForce> auto&) {
              return Fact(kind, {"event"}, msg("{}", word));
            }},
        e.event);
    WhyItem item;
    item.tick = item.end_tick = e.tick;
    item.facts = {what, {"since_event_before", msg("so long after the event before")}};
    item.amount = static_cast<double>(e.tick - last) * k_tick_s;
    item.unit = "s";
    if (e.tick < static_cast<std::int64_t>(in_.inputs.size()) && e.tick >= 0)
      item.site_mm = in_.inputs[static_cast<std::size_t>(e.tick)].tip_mm();
    why_.items.push_back(std::move(item));
    last = e.tick;
  }
}

void LossFinder::perforation() {
  const PerforationMeasures& p = r_.perforation;
  const Term fault{noop("fault")}, aim{noop("aim")};
  const auto truth = [&](const Term& kind, const PerforationTruth& t) {
    if (t.outside_mm3 > 0)
      fact({{"removed_from_outside",
             msg("tissue: removed from outside the tooth, which is no perforation")}},
           t.outside_mm3, "mm3", t.first_outside);
    if (!t.perforated) return fact({{"not_opened", {"of"}, msg("tissue: {} not opened", kind)}});
    fact({{"opened",
           {"of", "tissue"},
           msg("tissue: {}, {} first opened here; of its wall in all", kind, Term{t.tissue})}},
         t.area_mm2, "mm2", t.first, t.area_bound_mm2);
    fact({{"removed_behind", {"of"}, msg("tissue: {}, removed from the cavity", kind)}},
         t.volume_mm3, "mm3", {}, t.bound_mm3);
    if (t.drop)
      fact({{"force_drop", {"of", "drop"}, msg("drop: {}, {}", kind, drop_text(*t.drop))}},
           t.drop->missing_n, "N", {t.drop->from_tick, t.drop->site_mm});
  };
  truth(fault, p.fault);
  if (p.has_aims) truth(aim, p.aim);
  if (p.events.empty()) fact({{"no_breakthrough_seen", msg("force: no breakthrough seen")}});
  if (p.aim_unseen())
    fact({{"aim_unseen",
           msg("force: the breakthrough into the aim was not seen, which costs nothing")}});
  for (const auto& e : p.events) {
    const Term& kind = e.fault ? fault : aim;
    const Number before = as_n(e.force_before_n, 2), after = as_n(e.force_after_n, 2),
                 way = as_mm(e.advance_mm, 2);
    const std::vector<const char*> names{"of", "before", "after", "way"};
    fact(
        {e.confirmed
             ? Fact(
                   "force_fell_confirmed", names,
                   msg("force: {}, a fall from {} to {} while the tip went on by {}; confirmed by the tissue",
                       kind, before, after, way))
             : Fact(
                   "force_fell_unconfirmed", names,
                   msg("force: {}, a fall from {} to {} while the tip went on by {}; not confirmed by the tissue",
                       kind, before, after, way))},
        e.force_before_n - e.force_after_n, "N", {e.tick, e.site_mm});
    why_.items.back().end_tick = e.seen_tick;
  }
  fact({p.agree()
            ? Fact("force_and_tissue_agree", msg("force and tissue agree about faults"))
            : Fact("force_and_tissue_disagree", msg("force and tissue disagree about faults"))});
}

void LossFinder::shape(Extent extent, std::optional<double> found, double wanted,
                       std::optional<double> error) {
  const bool deep = extent == Extent::depth, along_x = extent == Extent::length;
  fact({deep      ? Fact("cavity_depth", msg("depth of the cavity"))
        : along_x ? Fact("cavity_length", msg("length of the cavity"))
                  : Fact("cavity_width", msg("width of the cavity"))},
       found, "mm", {}, r_.shape.bound_mm);
  fact({deep      ? Fact("target_depth", msg("depth of the target"))
        : along_x ? Fact("target_length", msg("length of the target"))
                  : Fact("target_width", msg("width of the target"))},
       wanted, "mm");
  // the leaves at the ends tell when that was cut
  struct End {
    scenarios::Wall wall;
    Vec3 direction;
  };
  using scenarios::Wall;
  const std::vector<End> ends =
      deep      ? std::vector<End>{{Wall::floor, {0, 0, -1}}}
      : along_x ? std::vector<End>{{Wall::mesial, {1, 0, 0}}, {Wall::distal, {-1, 0, 0}}}
                : std::vector<End>{{Wall::buccal, {0, 1, 0}}, {Wall::lingual, {0, -1, 0}}};
  for (const End& end : ends) {
    const Term name{scenarios::wall_name(end.wall)};
    Trace t;
    double most = -1e9;
    for (const auto& r : in_.removed) {
      if (r.tick >= end_) continue;
      const Vec3 at = in_.zones.centre_mm(r.leaf.leaf());
      if (dot(at, end.direction) <= most) continue;
      most = dot(at, end.direction);
      t = {r.tick, at};
    }
    if (t.tick >= 0)
      fact({deep ? Fact("deepest_removed", msg("deepest place removed, from the tooth's origin"))
                 : Fact("furthest_removed", {"end"},
                        msg("furthest {} place removed, from the tooth's origin", name))},
           most, "mm", t);
    if (deep || !error) continue;
    const auto& e = r_.shape.end_error[static_cast<std::size_t>(end.wall)];
    const Number beyond = as_mm(std::fabs(e.beyond_mm), 2);
    fact(
        {e.beyond_mm >= 0 ? Fact("end_too_far", {"end", "by"},
                                 msg("missing or too much at the {} end, {} too far", name, beyond))
                          : Fact("end_short", {"end", "by"},
                                 msg("missing or too much at the {} end, {} short", name, beyond))},
        e.part_mm, "mm", t, r_.shape.bound_mm);
    if (*error > 0)
      why_.items.back().points_lost =
          (points_at(spec_.full) - why_.criterion.points) * e.part_mm / *error;
  }
  if (deep)
    fact({{"depth_error", msg("missing and too much together")}}, error, "mm", {},
         2 * r_.shape.bound_mm);
}

void LossFinder::missed_target() { missed(spec_.points - why_.criterion.points); }

void LossFinder::removed_in_zones() { removed_moments(in_zones(asked_.marking->zones)); }

void LossFinder::at_walls() {
  const scenarios::Measure& m = asked_.measure;
  walls(m.first_wall, m.first_wall + m.walls, m.figure);
}

void LossFinder::length() {
  shape(Extent::length, r_.shape.length_mm, r_.shape.target_length_mm, r_.shape.length_error_mm);
}
void LossFinder::width() {
  shape(Extent::width, r_.shape.width_mm, r_.shape.target_width_mm, r_.shape.width_error_mm);
}
void LossFinder::depth() {
  shape(Extent::depth, r_.shape.depth_mm, r_.shape.target_depth_mm, r_.shape.depth_error_mm);
}

void LossFinder::taper() {
  fact({{"taper", msg("mean slope of the side walls")}}, r_.shape.taper_deg, "deg", {},
       r_.shape.taper_bound_deg);
  walls(0, scenarios::k_side_walls, {});
}

void LossFinder::taper_error() {
  fact({{"taper", msg("mean slope of the side walls")}}, r_.shape.taper_deg, "deg", {},
       r_.shape.taper_bound_deg);
  fact({{"target_taper", msg("mean slope of the target's side walls")}}, r_.access.target_taper_deg,
       "deg", {}, r_.access.target_taper_bound_deg);
  walls(0, scenarios::k_side_walls, {});
}

void LossFinder::floor_cut() {
  removed_moments(whole_leaves([&](const RemovedAt& r) {
    const IVec3 leaf = r.leaf.leaf();
    return in_.before.octree.is_solid(r.leaf.tissue) &&
           in_.before.octree.tissue(leaf) == r.leaf.tissue &&
           in_.zones.zone(leaf) != scenarios::Zone::target &&
           in_.zones.wall(leaf) == scenarios::Wall::floor;
  }));
}

void LossFinder::dentin_over_pulp() {
  const OverPulpMeasures& o = r_.over_pulp;
  if (!o.dentin_mm) return;
  fact({*o.dentin_mm > 0
            ? Fact("dentin_left", {"pulp"}, msg("left over the pulp's wall at {}", o.pulp_mm))
            : Fact("pulp_opened", msg("the pulp was opened"))},
       o.dentin_mm, "mm", o.thinnest, o.bound_mm);
}

void LossFinder::nick() {
  const AdjacentMeasures& b = r_.beside;
  if (b.deepest.tick >= 0)
    fact({{"neighbour_cut", msg("cut deepest into a neighbour here")}}, b.nick_depth_mm, "mm",
         b.deepest, b.nick_depth_bound_mm);
  removed_moments(whole_leaves([&](const RemovedAt& r) {
    return in_.beside != nullptr && in_.beside->apart.of_neighbours[r.leaf.tissue];
  }));
}

void LossFinder::clearance() {
  const AdjacentMeasures& b = r_.beside;
  if (!b.clearance_mm) return;
  const Trace last = last_cut_near(in_, end_, b.clearance_from_mm);
  fact({{"clearance",
         {"site", "neighbour"},
         msg("from {} to the neighbour's {}", b.clearance_from_mm, b.clearance_to_mm)},
        last_cut(last)},
       b.clearance_mm, "mm", last, b.clearance_bound_mm);
}

void LossFinder::gum() {
  removed_moments(whole_leaves([&](const RemovedAt& r) {
    return in_.beside != nullptr && in_.beside->apart.of_gum[r.leaf.tissue];
  }));
}

void LossFinder::tissue() {
  std::uint8_t id = k_air;
  for (const auto& t : r_.tissues)
    if (t.name == asked_.measure.tissue) id = t.id;
  removed_moments(whole_leaves([&](const RemovedAt& r) { return r.leaf.tissue == id; }));
}

void LossFinder::time() {
  fact({{"time", msg("time that counts, pauses taken off")}}, r_.motion.time_s, "s");
  fact({{"idle", msg("neither moving nor cutting")}}, r_.motion.idle_s, "s");
  steps();
  list_largest(idle_moments(in_, end_, r_.pauses));
}

void LossFinder::handpiece_time() {
  list_largest(tick_stretches(
      in_, end_, [&](std::int64_t i) { return record(i).rpm >= k_turning_rpm; }, 0,
      {"turned", msg("the handpiece turned")}, Stretch::duration));
}

void LossFinder::idle() {
  fact({{"idle", msg("neither moving nor cutting")}}, r_.motion.idle_s, "s");
  list_largest(idle_moments(in_, end_, r_.pauses));
}

void LossFinder::force() { pressed_above(spec_.full); }
void LossFinder::force_over_limit() { pressed_above(in_.scenario.force_limit_n); }

void LossFinder::pressed_above(double force) {
  if (r_.motion.force_peak.tick >= 0)
    fact({{"pressed_hardest", msg("pressed hardest")}}, r_.motion.force_peak_n, "N",
         r_.motion.force_peak);
  list_largest(tick_stretches(
      in_, end_, [&](std::int64_t i) { return force_n(record(i)) > force; }, k_moment_gap_ticks,
      {"pressed_above", {"limit"}, msg("pressed with more than {}", as_n(force, 2))},
      Stretch::peak_force));
}

}  // namespace cavum::grading
