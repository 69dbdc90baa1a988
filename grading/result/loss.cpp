#include "grading/result/loss.h"

#include <algorithm>
#include <cmath>

#include "grading/result/measure_marking.h"

namespace cavum::grading {

Value value_text(const scenarios::Measure& measure, double value, double bound, int digits) {
  if (measure.reads == scenarios::Reads::yes_no && (value == 0 || value == 1))
    return Term{value == 1 ? measure.yes : measure.no};
  if (measure.reads == scenarios::Reads::count && bound == 0) return as_number(value);
  return Number{value, unit_of(measure.unit).value_or(Unit::none), digits, bound};
}

Message drop_text(const ForceDrop& d) {
  if (d.from_tick < 0) return msg("no force was missing while the hand pressed on");
  const Number missing = as_n(d.missing_n, 2), share = as_percent(100.0 * d.share, 0),
               within = as_s(static_cast<double>(d.to_tick - d.from_tick) * k_tick_s, 2),
               felt_s = as_s(static_cast<double>(d.felt_tick) * k_tick_s, 3);
  switch (d.severity()) {
    case DropSeverity::not_felt:
      return msg(
          "resistance fell by {}, {} of what the filled tooth would give, within {}: not to be felt",
          missing, share, within);
    case DropSeverity::faint:
      return msg("resistance fell by {}, {} of what the filled tooth would give, within {}: faint",
                 missing, share, within);
    case DropSeverity::felt:
      return msg(
          "resistance fell by {}, {} of what the filled tooth would give, within {}: felt clearly from {} on",
          missing, share, within, felt_s);
    case DropSeverity::felt_and_cut_on:
      break;
  }
  return msg(
      "resistance fell by {}, {} of what the filled tooth would give, within {}: felt clearly from {} on, and cutting continued for {}",
      missing, share, within, felt_s, as_s(d.cut_on_s, 2));
}

namespace {

using Kind = FindingKind;

/// A wall's identifier, for programs.
Name id_of(std::size_t wall) { return {scenarios::wall_name(static_cast<scenarios::Wall>(wall))}; }
Number seconds(const Trace& t) { return as_s(t.t_s(), 2); }

/// Where it began, and when that is known; nothing where it never did.
void put_first(Findings& facts, const Trace& t) {
  if (t.timed()) facts.push_back(finding<Kind::first_cut>(t.site_mm, seconds(t), t.tick));
  if (!t.timed() && t.tick >= 0) facts.push_back(finding<Kind::site>(t.site_mm));
}

std::size_t largest(const std::array<double, scenarios::k_walls + 1>& by_wall) {
  return static_cast<std::size_t>(std::max_element(by_wall.begin(), by_wall.end()) -
                                  by_wall.begin());
}

Loss missed(const Result& r) {
  const auto w = largest(r.volumes.missed_by_wall_mm3);
  const Trace& last = r.volumes.target_last[w];
  const Number all = as_mm3(r.volumes.missed.mm3, 2, r.volumes.missed.bound_mm3),
               most = as_mm3(r.volumes.missed_by_wall_mm3[w], 2);
  const Term wall = scenarios::wall_text(w, r.shape.facing);
  if (last.tick < 0) return {{finding<Kind::target_left_uncut>(all, wall, most, id_of(w))}, last};
  if (!last.timed())
    return {{finding<Kind::target_left_partly_cut>(all, wall, most, id_of(w))}, last};
  return {{finding<Kind::target_left>(all, wall, most, seconds(last), last.tick, id_of(w))}, last};
}

Loss removed_in(const Result& r, const std::vector<scenarios::Zone>& zones) {
  Trace first;
  double most = 0;
  std::size_t w = 0;
  scenarios::Zone worst = zones.front();
  for (const scenarios::Zone z : zones) {
    const ZoneVolume& v = r.volumes.zone[static_cast<std::size_t>(z)];
    const auto largest_at = largest(v.by_wall_mm3);
    if (v.by_wall_mm3[largest_at] > most) {
      most = v.by_wall_mm3[largest_at];
      w = largest_at;
      worst = z;
    }
    if (v.first.tick >= 0 && (first.tick < 0 || v.first.tick < first.tick)) first = v.first;
  }
  const Term wall = scenarios::wall_text(w, r.shape.facing);
  const Number volume = as_mm3(most, 2);
  Loss loss{{worst == scenarios::Zone::none
                 ? finding<Kind::removed_outside>(wall, volume, id_of(w))
                 : finding<Kind::removed_in_zone>(Term{scenarios::zone_name(worst)}, wall, volume,
                                                  id_of(w))},
            first};
  put_first(loss.what, first);
  return loss;
}

/// "0.68 mm at the mesial end (0.68 mm too far)", and the other end.
Findings ends(const Result& r, std::size_t first) {
  Findings facts;
  for (std::size_t i = first; i < first + 2; ++i) {
    const auto& e = r.shape.end_error[i];
    const Term end{scenarios::wall_name(static_cast<scenarios::Wall>(i), r.shape.facing)};
    const Number part = as_mm(e.part_mm, 2), beyond = as_mm(std::fabs(e.beyond_mm), 2);
    facts.push_back(e.beyond_mm >= 0 ? finding<Kind::end_too_far>(part, end, beyond)
                                     : finding<Kind::end_short>(part, end, beyond));
  }
  return facts;
}

/// The fact itself, and where and when it was cut.
Loss cut_at(Finding fact, const Trace& at) {
  Loss loss{{std::move(fact)}, at};
  if (at.timed()) loss.what.push_back(finding<Kind::cut_site>(at.site_mm, seconds(at), at.tick));
  return loss;
}

/// When the exam's clock, which stands still in pauses, had run for so long; tick -1 when it never
/// did.
Trace clock_at(const Result& r, double seconds) {
  auto tick = static_cast<std::int64_t>(std::floor(seconds * k_ticks_per_second));
  for (const auto& p : r.pauses)
    if (p.begin <= tick) tick += p.end - p.begin;
  return tick >= 0 && tick <= r.end.tick ? Trace{tick, {}} : Trace{};
}

}  // namespace

namespace reason {

Loss figure_alone(const Result&, const Asked&) { return {}; }

Loss missed_target(const Result& r, const Asked&) { return missed(r); }

Loss removed_in_zones(const Result& r, const Asked& a) { return removed_in(r, a.marking->zones); }

Loss missed_and_beyond(const Result& r, const Asked& a) {
  Loss over = removed_in(r, a.marking->zones);
  const BoundedVolume& in_target =
      r.volumes.zone[static_cast<std::size_t>(scenarios::Zone::target)].removed;
  Loss all = missed(r);
  if (over.first.tick < 0) return all;
  all.what.push_back(
      finding<Kind::removed_beyond>(as_mm3(r.volumes.removed.mm3 - in_target.mm3, 2)));
  all.what.insert(all.what.end(), over.what.begin(), over.what.end());
  return {std::move(all.what), over.first};
}

Loss at_walls(const Result& r, const Asked& a) {
  const scenarios::WallFigure figure = a.measure.figure;
  const std::size_t first = a.measure.first_wall, end = first + a.measure.walls;
  const bool over = figure == scenarios::WallFigure::max_over,
             under = figure == scenarios::WallFigure::max_under,
             p95 = figure == scenarios::WallFigure::p95;
  const auto size = [&](const WallMeasures& m) { return wall_figure(m, figure); };
  std::size_t worst = end;
  for (std::size_t w = first; w < end; ++w) {
    const WallMeasures& m = r.shape.wall[w];
    if (m.samples == 0 && !(over && m.max_over_mm > 0)) continue;
    if (worst == end || size(m) > size(r.shape.wall[worst])) worst = w;
  }
  if (worst == end) return {{finding<Kind::wall_uncut>()}, {}};
  const WallMeasures& m = r.shape.wall[worst];
  const Trace& t = under || (!over && size(m) < 0) ? m.worst_under : m.worst_over;
  const bool thick = &t == &m.worst_under;
  const Term wall = scenarios::wall_text(worst, r.shape.facing);
  const Number furthest = as_mm(thick ? m.max_under_mm : m.max_over_mm, 2);
  Loss loss{
      {over && m.over_outside ? finding<Kind::wall_beyond_container>(furthest, wall, id_of(worst))
       : over                 ? finding<Kind::wall_overcut>(wall, furthest, id_of(worst))
       : under                ? finding<Kind::wall_thick>(wall, furthest, id_of(worst))
       : p95 && thick         ? finding<Kind::wall_p95_thick>(wall, furthest, id_of(worst))
       : p95                  ? finding<Kind::wall_p95_overcut>(wall, furthest, id_of(worst))
       : thick                ? finding<Kind::wall_mean_thick>(wall, furthest, id_of(worst))
                              : finding<Kind::wall_mean_overcut>(wall, furthest, id_of(worst))},
      t};
  if (t.timed()) loss.what.push_back(finding<Kind::cut_site>(t.site_mm, seconds(t), t.tick));
  if (!t.timed() && t.tick >= 0) loss.what.push_back(finding<Kind::site>(t.site_mm));
  if (t.tick < 0 && thick && m.max_under_mm > 0)
    loss.what.push_back(finding<Kind::site_uncut>(t.site_mm));
  return loss;
}

Loss length_error(const Result& r, const Asked&) {
  if (!r.shape.length_mm) return {};
  Loss loss{ends(r, 0), {}};
  loss.what.push_back(
      finding<Kind::length>(as_mm(*r.shape.length_mm, 2), as_mm(r.shape.target_length_mm, 2)));
  return loss;
}

Loss width_error(const Result& r, const Asked&) {
  if (!r.shape.width_mm) return {};
  Loss loss{ends(r, 2), {}};
  loss.what.push_back(
      finding<Kind::width>(as_mm(*r.shape.width_mm, 2), as_mm(r.shape.target_width_mm, 2)));
  return loss;
}

Loss depth_error(const Result& r, const Asked&) {
  if (!r.shape.depth_mm) return {};
  return {{finding<Kind::depth>(as_mm(*r.shape.depth_mm, 2), as_mm(r.shape.target_depth_mm, 2))},
          {}};
}

Loss taper_error(const Result& r, const Asked&) {
  return {
      {finding<Kind::taper>(as_deg(*r.shape.taper_deg, 1), as_deg(*r.access.target_taper_deg, 1))},
      {}};
}

Loss overhang(const Result& r, const Asked&) {
  return {{finding<Kind::roof_left>(r.access.overhang_middle_mm)}, {}};
}

Loss canals_covered(const Result& r, const Asked&) {
  return {{finding<Kind::canals_covered>(r.access.canals_covered_mm)}, {}};
}

Loss floor_cut(const Result& r, const Asked&) {
  if (r.access.floor_first.tick < 0) return {{finding<Kind::floor_uncut>()}, {}};
  Loss loss{{}, r.access.floor_first};
  put_first(loss.what, loss.first);
  return loss;
}

Loss dentin_over_pulp(const Result& r, const Asked&) {
  const Trace& at = r.over_pulp.thinnest;
  return cut_at(*r.over_pulp.dentin_mm > 0 ? finding<Kind::dentin_thinnest>(at.site_mm)
                                           : finding<Kind::pulp_opened>(at.site_mm),
                at);
}

Loss nick(const Result& r, const Asked&) {
  const Trace& at = r.beside.deepest;
  if (at.tick < 0) return {};
  Loss loss = cut_at(finding<Kind::neighbour_cut>(at.site_mm), at);
  loss.first = r.beside.first_nick;
  return loss;
}

Loss clearance(const Result& r, const Asked&) {
  if (!r.beside.clearance_mm) return {{finding<Kind::no_contact_opened>()}, {}};
  return {{finding<Kind::clearance>(r.beside.clearance_from_mm, r.beside.clearance_to_mm)}, {}};
}

Loss gum(const Result& r, const Asked&) {
  Loss loss{{}, r.beside.first_gum};
  put_first(loss.what, loss.first);
  return loss;
}

Loss time_over(const Result& r, const Asked& a) {
  const Trace first = clock_at(r, a.full);
  if (first.tick < 0) return {};
  return {{finding<Kind::full_time_over>(seconds(first), first.tick)}, first};
}

Loss force_peak(const Result& r, const Asked&) {
  const Trace& at = r.motion.force_peak;
  return {{finding<Kind::pressed_hardest>(at.site_mm, seconds(at), at.tick)}, at};
}

Loss force_over_limit(const Result& r, const Asked&) {
  const Trace& first = r.motion.first_over_limit;
  if (first.tick < 0) return {};
  return {{finding<Kind::force_above_limit>(seconds(first), first.tick)}, first};
}

Loss fault_opened(const Result& r, const Asked&) {
  const PerforationTruth& t = r.perforation.fault;
  if (!t.perforated) return {{finding<Kind::nothing_opened>()}, {}};
  const Number area = as_mm2(t.area_mm2, 3);
  Loss loss{{t.volume_mm3 > 0 ? finding<Kind::tissue_opened_and_removed>(Term{t.tissue}, area,
                                                                         as_mm3(t.volume_mm3, 3))
                              : finding<Kind::tissue_opened>(Term{t.tissue}, area)},
            t.first};
  put_first(loss.what, t.first);
  return loss;
}

Loss swept_outside(const Result& r, const Asked&) {
  const Trace& first = r.perforation.fault.first_outside;
  if (first.tick < 0) return {{finding<Kind::none_from_outside>()}, {}};
  Loss loss{{finding<Kind::from_outside>()}, first};
  put_first(loss.what, first);
  return loss;
}

Loss fault_felt(const Result& r, const Asked&) {
  for (const auto& e : r.perforation.events)
    if (e.fault && e.confirmed) {
      const Trace at{e.tick, e.site_mm};
      return {{finding<Kind::force_fell>(as_n(e.force_before_n, 2), seconds(at), at.tick)}, at};
    }
  return {{finding<Kind::no_fall_confirmed>()}, {}};
}

Loss tissue_touched(const Result& r, const Asked& a) {
  const Term tissue{a.measure.tissue};
  for (const auto& t : r.tissues)
    if (const Trace& first = r.volumes.tissue_first[t.id];
        t.name == a.measure.tissue && first.tick >= 0) {
      Loss loss{{finding<Kind::tissue_touched>(tissue)}, first};
      put_first(loss.what, first);
      return loss;
    }
  return {{finding<Kind::tissue_untouched>(tissue)}, {}};
}

Loss first_violation(const Result& r, const Asked&) {
  const Trace& first = r.progress.first_violation;
  if (first.tick < 0) return {};
  return {{finding<Kind::violated>(seconds(first), first.tick)}, first};
}

}  // namespace reason

}  // namespace cavum::grading
