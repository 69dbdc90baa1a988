#include "grading/result/loss.h"

#include <algorithm>
#include <cmath>

#include "grading/result/measure_marking.h"

namespace cavum::grading {

Message when(const Trace& t) { return msg("{} (tick {})", as_s(t.t_s(), 2), t.tick); }

Message without_ticks(const Message& m) {
  static const Message k_when = when({});  // the one place of its sentence: what has that very address came from when(), whatever it says
  if (m.empty()) return m;
  if (m.english() == k_when.english()) return msg("{}", m.values()[0]);
  std::vector<Value> values = m.values();
  for (Value& v : values) {
    if (auto* message = std::get_if<Message>(&v)) *message = without_ticks(*message);
    if (auto* list = std::get_if<List>(&v))
      for (Message& item : list->items) item = without_ticks(item);
  }
  return {m.english(), m.plural(), m.count(), std::move(values)};
}

Message place_and_time(const Trace& t) { return t.timed() ? msg("{}, at {}", t.site_mm, when(t)) : msg("{}", t.site_mm); }

Unit unit_of(std::string_view name) noexcept {
  constexpr std::pair<std::string_view, Unit> k_units[] = {{"mm", Unit::mm},    {"mm2", Unit::mm2}, {"mm3", Unit::mm3},  {"N", Unit::newton},
                                                           {"s", Unit::second}, {"deg", Unit::deg}, {"%", Unit::percent}};
  for (const auto& [known, unit] : k_units)
    if (known == name) return unit;
  return Unit::none;
}

Message value_text(const scenarios::Measure& measure, double value, double bound, int digits) {
  if (measure.reads == scenarios::Reads::yes_no && (value == 0 || value == 1)) return msg("{}", Term{value == 1 ? measure.yes : measure.no});
  if (measure.reads == scenarios::Reads::count && bound == 0) return msg("{}", as_number(value));
  return msg("{}", Number{value, unit_of(measure.unit), digits, bound});
}

Message drop_text(const ForceDrop& d) {
  if (d.from_tick < 0) return msg("no force was missing while the hand pressed on");
  const Message went = msg("{}, {} of what the filled tooth would give, went within {}", as_n(d.missing_n, 2), as_percent(100.0 * d.share, 0),
                           as_s(static_cast<double>(d.to_tick - d.from_tick) * k_tick_s, 2));
  const Number felt_s = as_s(static_cast<double>(d.felt_tick) * k_tick_s, 3);
  switch (d.severity()) {
    case DropSeverity::not_felt:
      return msg("{}: not to be felt", went);
    case DropSeverity::faint:
      return msg("{}: faint", went);
    case DropSeverity::felt:
      return msg("{}: felt clearly from {} on", went, felt_s);
    case DropSeverity::felt_and_cut_on:
      break;
  }
  return msg("{}: felt clearly from {} on, and the cavity was opened further for {}", went, felt_s, as_s(d.cut_on_s, 2));
}

namespace {

std::size_t largest(const std::array<double, scenarios::k_walls + 1>& by_wall) {
  return static_cast<std::size_t>(std::max_element(by_wall.begin(), by_wall.end()) - by_wall.begin());
}

Loss missed(const Result& r) {
  const auto w = largest(r.volumes.missed_by_wall_mm3);
  const Trace& last = r.volumes.target_last[w];
  const Number all = as_mm3(r.volumes.missed.mm3, 2, r.volumes.missed.bound_mm3), most = as_mm3(r.volumes.missed_by_wall_mm3[w], 2);
  const Message wall = scenarios::wall_text(w, r.shape.facing);
  if (last.tick < 0)
    return {msg("{} of the target left standing, the largest part towards {} ({}), where nothing of it was cut", all, wall, most), last};
  if (!last.timed())
    return {msg("{} of the target left standing, the largest part towards {} ({}), where some of it was cut", all, wall, most), last};
  return {msg("{} of the target left standing, the largest part towards {} ({}), where it was cut last at {}", all, wall, most, when(last)), last};
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
  const Message wall = scenarios::wall_text(w, r.shape.facing);
  const Number volume = as_mm3(most, 2);
  const Message where = worst == scenarios::Zone::none ? msg("the largest part outside all zones at {} ({})", wall, volume)
                                                       : msg("the largest part in {} at {} ({})", Term{scenarios::zone_name(worst)}, wall, volume);
  if (first.tick < 0) return {where, first};
  return {msg("{}, beginning at {}", where, place_and_time(first)), first};
}

/// "0.68 mm at the mesial end (0.68 mm too far), 0.57 mm at the distal end (0.57 mm short)"
List ends(const Result& r, std::size_t first) {
  List list;
  for (std::size_t i = first; i < first + 2; ++i) {
    const auto& e = r.shape.end_error[i];
    const Term end{scenarios::wall_name(static_cast<scenarios::Wall>(i), r.shape.facing)};
    const Number part = as_mm(e.part_mm, 2), beyond = as_mm(std::fabs(e.beyond_mm), 2);
    list.items.push_back(e.beyond_mm >= 0 ? msg("{} at the {} end ({} too far)", part, end, beyond)
                                          : msg("{} at the {} end ({} short)", part, end, beyond));
  }
  return list;
}

/// When the exam's clock, which stands still in pauses, had run for so long; tick -1 when it never did.
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
  const BoundedVolume& in_target = r.volumes.zone[static_cast<std::size_t>(scenarios::Zone::target)].removed;
  Loss not_cut = missed(r);
  if (over.first.tick < 0) return not_cut;
  return {msg("{}; {} removed beyond the target, {}", not_cut.what, as_mm3(r.volumes.removed.mm3 - in_target.mm3, 2), over.what), over.first};
}

Loss at_walls(const Result& r, const Asked& a) {
  const scenarios::WallFigure figure = a.measure.figure;
  const std::size_t first = a.measure.first_wall, end = first + a.measure.walls;
  const bool over = figure == scenarios::WallFigure::max_over, under = figure == scenarios::WallFigure::max_under,
             p95 = figure == scenarios::WallFigure::p95;
  const auto size = [&](const WallMeasures& m) { return wall_figure(m, figure); };
  std::size_t worst = end;
  for (std::size_t w = first; w < end; ++w) {
    const WallMeasures& m = r.shape.wall[w];
    if (m.samples == 0 && !(over && m.max_over_mm > 0)) continue;
    if (worst == end || size(m) > size(r.shape.wall[worst])) worst = w;
  }
  if (worst == end) return {msg("nothing was cut there"), {}};
  const WallMeasures& m = r.shape.wall[worst];
  const Trace& t = under || (!over && size(m) < 0) ? m.worst_under : m.worst_over;
  const bool thick = &t == &m.worst_under;
  const Message wall = scenarios::wall_text(worst, r.shape.facing);
  const Number furthest = as_mm(thick ? m.max_under_mm : m.max_over_mm, 2);
  const Message what = over && m.over_outside ? msg("cut outside the container, up to {} beyond {}", furthest, wall)
                       : over                 ? msg("{} overcut by up to {}", wall, furthest)
                       : under                ? msg("{} left up to {} thick", wall, furthest)
                       : p95 && thick         ? msg("{}, 95 % of whose places lie no further out than that; the furthest {} thick", wall, furthest)
                       : p95   ? msg("{}, 95 % of whose places lie no further out than that; the furthest {} beyond the target", wall, furthest)
                       : thick ? msg("{}, in the mean of its places; the furthest {} thick", wall, furthest)
                               : msg("{}, in the mean of its places; the furthest {} beyond the target", wall, furthest);
  if (t.timed()) return {msg("{}, at {}, cut at {}", what, t.site_mm, when(t)), t};
  if (t.tick >= 0) return {msg("{}, at {}", what, t.site_mm), t};
  return {thick && m.max_under_mm > 0 ? msg("{}, at {}, where nothing was cut", what, t.site_mm) : what, t};
}

Loss length_error(const Result& r, const Asked&) {
  if (!r.shape.length_mm) return {};
  return {msg("{}; length {} instead of {}", ends(r, 0), as_mm(*r.shape.length_mm, 2), as_mm(r.shape.target_length_mm, 2)), {}};
}

Loss width_error(const Result& r, const Asked&) {
  if (!r.shape.width_mm) return {};
  return {msg("{}; width {} instead of {}", ends(r, 2), as_mm(*r.shape.width_mm, 2), as_mm(r.shape.target_width_mm, 2)), {}};
}

Loss depth_error(const Result& r, const Asked&) {
  if (!r.shape.depth_mm) return {};
  return {msg("depth {} instead of {}", as_mm(*r.shape.depth_mm, 2), as_mm(r.shape.target_depth_mm, 2)), {}};
}

Loss taper_error(const Result& r, const Asked&) {
  return {msg("the walls open by {} instead of {}", as_deg(*r.shape.taper_deg, 1), as_deg(*r.access.target_taper_deg, 1)), {}};
}

Loss overhang(const Result& r, const Asked&) { return {msg("roof left above the chamber, around {}", r.access.overhang_middle_mm), {}}; }

Loss canals_covered(const Result& r, const Asked&) { return {msg("hard tissue stands over the mouths around {}", r.access.canals_covered_mm), {}}; }

Loss floor_cut(const Result& r, const Asked&) {
  if (r.access.floor_first.tick < 0) return {msg("no hard tissue was cut below the target"), {}};
  return {msg("beginning at {}", place_and_time(r.access.floor_first)), r.access.floor_first};
}

Loss dentin_over_pulp(const Result& r, const Asked&) {
  const Trace& at = r.over_pulp.thinnest;
  if (*r.over_pulp.dentin_mm > 0)
    return {at.timed() ? msg("thinnest at {}, cut at {}", at.site_mm, when(at)) : msg("thinnest at {}", at.site_mm), at};
  return {at.timed() ? msg("the pulp was opened at {}, cut at {}", at.site_mm, when(at)) : msg("the pulp was opened at {}", at.site_mm), at};
}

Loss nick(const Result& r, const Asked&) {
  const Trace& at = r.beside.deepest;
  if (at.tick < 0) return {};
  return {msg("the neighbour is cut deepest at {}, cut at {}", at.site_mm, when(at)), r.beside.first_nick};
}

Loss clearance(const Result& r, const Asked&) {
  if (!r.beside.clearance_mm) return {msg("the target opens no contact"), {}};
  return {msg("least between {} and the neighbour's {}", r.beside.clearance_from_mm, r.beside.clearance_to_mm), {}};
}

Loss gum(const Result& r, const Asked&) {
  const Trace& at = r.beside.first_gum;
  if (at.tick < 0) return {};
  return {msg("cut first at {}, at {}", at.site_mm, when(at)), at};
}

Loss time_over(const Result& r, const Asked& a) {
  const Trace first = clock_at(r, a.full);
  return {first.tick >= 0 ? msg("that time was over at {}", when(first)) : Message(), first};
}

Loss force_peak(const Result& r, const Asked&) {
  return {msg("pressed hardest at {}, at {}", r.motion.force_peak.site_mm, when(r.motion.force_peak)), r.motion.force_peak};
}

Loss force_over_limit(const Result& r, const Asked&) {
  if (r.motion.first_over_limit.tick < 0) return {};
  return {msg("above the limit first at {}", when(r.motion.first_over_limit)), r.motion.first_over_limit};
}

Loss fault_opened(const Result& r, const Asked&) {
  const PerforationTruth& t = r.perforation.fault;
  if (!t.perforated) return {msg("no faulty breakthrough"), {}};
  const Message opened = msg("{} opened at {}", Term{t.tissue}, place_and_time(t.first));
  const Number area = as_mm2(t.area_mm2, 3);
  return {t.volume_mm3 > 0 ? msg("{}, {} of its wall in all, {} of it removed", opened, area, as_mm3(t.volume_mm3, 3))
                           : msg("{}, {} of its wall in all, none of it removed", opened, area),
          t.first};
}

Loss swept_outside(const Result& r, const Asked&) {
  const Trace& first = r.perforation.fault.first_outside;
  if (first.tick < 0) return {msg("none"), {}};
  return {msg("from outside the tooth, first at {}", place_and_time(first)), first};
}

Loss fault_felt(const Result& r, const Asked&) {
  for (const auto& e : r.perforation.events)
    if (e.fault && e.confirmed) {
      const Trace at{e.tick, e.site_mm};
      return {msg("a drop in force from {} at {}", as_n(e.force_before_n, 2), when(at)), at};
    }
  return {msg("no faulty breakthrough that force and tissue show"), {}};
}

Loss tissue_touched(const Result& r, const Asked& a) {
  for (const auto& t : r.tissues)
    if (const Trace& first = r.volumes.tissue_first[t.id]; t.name == a.measure.tissue && first.tick >= 0)
      return {msg("touched first at {}", place_and_time(first)), first};
  return {msg("never touched"), {}};
}

Loss first_violation(const Result& r, const Asked&) {
  if (r.progress.first_violation.tick < 0) return {};
  return {msg("first at {}", when(r.progress.first_violation)), r.progress.first_violation};
}

}  // namespace reason

}  // namespace cavum::grading
