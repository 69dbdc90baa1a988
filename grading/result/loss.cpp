#include "grading/result/loss.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "engine/base/text.h"
#include "grading/result/measure_marking.h"

namespace cavum::grading {

std::string when(const Trace& t) { return fmt::format("{} s (tick {})", fixed(t.t_s(), 2), t.tick); }
std::string at_when(const Trace& t) { return t.timed() ? " at " + when(t) : std::string(); }
std::string place(Vec3 p) { return fmt::format("[{}, {}, {}] mm", fixed(p.x, 2), fixed(p.y, 2), fixed(p.z, 2)); }
std::string wall_text(std::size_t wall, scenarios::Facing facing) {
  return wall == static_cast<std::size_t>(scenarios::Wall::opening) ? (facing.lateral()  ? "the opening"
                                                                       : facing.anterior ? "the incisal side"
                                                                                         : "the occlusal side")
         : wall == static_cast<std::size_t>(scenarios::Wall::floor)
             ? (facing.lateral() ? "the axial wall" : "the floor")
             : fmt::format("the {} wall", scenarios::wall_name(static_cast<scenarios::Wall>(wall), facing));
}

std::string amount_text(double value, double bound, int digits, const std::string& unit) {
  return fixed(value, digits) + (bound > 0 ? " ± " + fixed(bound, digits) : "") + (unit.empty() ? "" : " " + unit);
}

std::string value_text(const scenarios::Measure& measure, double value, double bound, int digits) {
  if (measure.reads == scenarios::Reads::yes_no && (value == 0 || value == 1)) return value == 1 ? measure.yes : measure.no;
  if (measure.reads == scenarios::Reads::count && bound == 0) return plain_number(value);
  return amount_text(value, bound, digits, measure.unit);
}

namespace {

std::size_t largest(const std::array<double, scenarios::k_walls + 1>& by_wall) {
  return static_cast<std::size_t>(std::max_element(by_wall.begin(), by_wall.end()) - by_wall.begin());
}

Loss missed(const Result& r) {
  const auto w = largest(r.volumes.missed_by_wall_mm3);
  const Trace& last = r.volumes.target_last[w];
  return {fmt::format("{} of the target left standing, the largest part towards {} ({} mm3), where {}",
                      amount_text(r.volumes.missed.mm3, r.volumes.missed.bound_mm3, 2, "mm3"), wall_text(w, r.shape.facing),
                      fixed(r.volumes.missed_by_wall_mm3[w], 2),
                      last.tick < 0  ? "nothing of it was cut"
                      : last.timed() ? "it was cut last at " + when(last)
                                     : "some of it was cut"),
          last};
}

Loss removed_in(const Result& r, const std::vector<scenarios::Zone>& zones) {
  Loss loss;
  double most = 0;
  std::size_t wall = 0;
  scenarios::Zone worst = zones.front();
  for (const scenarios::Zone z : zones) {
    const ZoneVolume& v = r.volumes.zone[static_cast<std::size_t>(z)];
    const auto w = largest(v.by_wall_mm3);
    if (v.by_wall_mm3[w] > most) {
      most = v.by_wall_mm3[w];
      wall = w;
      worst = z;
    }
    if (v.first.tick >= 0 && (loss.first.tick < 0 || v.first.tick < loss.first.tick)) loss.first = v.first;
  }
  loss.text = fmt::format("the largest part {} at {} ({} mm3)",
                          worst == scenarios::Zone::none ? "outside all zones" : fmt::format("in {}", scenarios::zone_name(worst)),
                          wall_text(wall, r.shape.facing), fixed(most, 2));
  if (loss.first.tick >= 0) loss.text += fmt::format(", beginning{} at {}", at_when(loss.first), place(loss.first.site_mm));
  return loss;
}

/// "0.68 mm at the mesial end (0.68 mm too far), 0.57 mm at the distal end (0.57 mm short)"
std::string ends_text(const Result& r, std::size_t first) {
  std::string text;
  for (std::size_t i = first; i < first + 2; ++i) {
    const auto& e = r.shape.end_error[i];
    text += fmt::format("{}{} mm at the {} end ({}{}", text.empty() ? "" : ", ", fixed(e.part_mm, 2),
                        scenarios::wall_name(static_cast<scenarios::Wall>(i), r.shape.facing), fixed(std::fabs(e.beyond_mm), 2),
                        e.beyond_mm >= 0 ? " mm too far)" : " mm short)");
  }
  return text;
}

/// "...; width 2.10 mm instead of 2.00 mm"
Loss outline_error(const Result& r, std::size_t first_end, const char* name, const std::optional<double>& found, double wanted) {
  if (!found) return {};
  return {fmt::format("{}; {} {} mm instead of {} mm", ends_text(r, first_end), name, fixed(*found, 2), fixed(wanted, 2)), {}};
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
  return {fmt::format("{}; {} mm3 removed beyond the target, {}", not_cut.text, fixed(r.volumes.removed.mm3 - in_target.mm3, 2), over.text),
          over.first};
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
  if (worst == end) return {"nothing was cut there", {}};
  const WallMeasures& m = r.shape.wall[worst];
  const Trace& t = under || (!over && size(m) < 0) ? m.worst_under : m.worst_over;
  Loss loss{{}, t};
  if (over && m.over_outside)
    loss.text = fmt::format("cut outside the container, up to {} mm beyond {}", fixed(m.max_over_mm, 2), wall_text(worst, r.shape.facing));
  else if (over)
    loss.text = fmt::format("{} overcut by up to {} mm", wall_text(worst, r.shape.facing), fixed(m.max_over_mm, 2));
  else if (under)
    loss.text = fmt::format("{} left up to {} mm thick", wall_text(worst, r.shape.facing), fixed(m.max_under_mm, 2));
  else
    loss.text = wall_text(worst, r.shape.facing) +
                (p95 ? ", 95 % of whose places lie no further out than that; the furthest " : ", in the mean of its places; the furthest ") +
                (&t == &m.worst_under ? fixed(m.max_under_mm, 2) + " mm thick" : fixed(m.max_over_mm, 2) + " mm beyond the target");
  if (t.tick >= 0) loss.text += fmt::format(", at {}{}{}", place(t.site_mm), t.timed() ? ", cut" : "", at_when(t));
  if (&t == &m.worst_under && t.tick < 0 && m.max_under_mm > 0) loss.text += fmt::format(", at {}, where nothing was cut", place(t.site_mm));
  return loss;
}

Loss length_error(const Result& r, const Asked&) { return outline_error(r, 0, "length", r.shape.length_mm, r.shape.target_length_mm); }
Loss width_error(const Result& r, const Asked&) { return outline_error(r, 2, "width", r.shape.width_mm, r.shape.target_width_mm); }

Loss depth_error(const Result& r, const Asked&) {
  if (!r.shape.depth_mm) return {};
  return {fmt::format("depth {} mm instead of {} mm", fixed(*r.shape.depth_mm, 2), fixed(r.shape.target_depth_mm, 2)), {}};
}

Loss taper_error(const Result& r, const Asked&) {
  return {fmt::format("the walls open by {} instead of {} degrees", fixed(*r.shape.taper_deg, 1), fixed(*r.access.target_taper_deg, 1)), {}};
}

Loss overhang(const Result& r, const Asked&) { return {"roof left above the chamber, around " + place(r.access.overhang_middle_mm), {}}; }

Loss canals_covered(const Result& r, const Asked&) { return {"hard tissue stands over the mouths around " + place(r.access.canals_covered_mm), {}}; }

Loss floor_cut(const Result& r, const Asked&) {
  if (r.access.floor_first.tick < 0) return {"no hard tissue was cut below the target", {}};
  return {fmt::format("beginning{} at {}", at_when(r.access.floor_first), place(r.access.floor_first.site_mm)), r.access.floor_first};
}

Loss dentin_over_pulp(const Result& r, const Asked&) {
  const Trace& at = r.over_pulp.thinnest;
  return {fmt::format("{}{}{}{}", *r.over_pulp.dentin_mm > 0 ? "thinnest at " : "the pulp was opened at ", place(at.site_mm),
                      at.timed() ? ", cut" : "", at_when(at)),
          at};
}

Loss nick(const Result& r, const Asked&) {
  const Trace& at = r.beside.deepest;
  if (at.tick < 0) return {};
  return {fmt::format("the neighbour is cut deepest at {}, cut at {}", place(at.site_mm), when(at)), r.beside.first_nick};
}

Loss clearance(const Result& r, const Asked&) {
  if (!r.beside.clearance_mm) return {"the target opens no contact", {}};
  return {fmt::format("least between {} and the neighbour's {}", place(r.beside.clearance_from_mm), place(r.beside.clearance_to_mm)), {}};
}

Loss gum(const Result& r, const Asked&) {
  const Trace& at = r.beside.first_gum;
  if (at.tick < 0) return {};
  return {fmt::format("cut first at {} at {}", place(at.site_mm), when(at)), at};
}

Loss time_over(const Result& r, const Asked& a) {
  Loss loss{"", clock_at(r, a.full)};
  if (loss.first.tick >= 0) loss.text = "that time was over at " + when(loss.first);
  return loss;
}

Loss force_peak(const Result& r, const Asked&) {
  return {fmt::format("pressed hardest at {} at {}", when(r.motion.force_peak), place(r.motion.force_peak.site_mm)), r.motion.force_peak};
}

Loss force_over_limit(const Result& r, const Asked&) {
  if (r.motion.first_over_limit.tick < 0) return {};
  return {"above the limit first at " + when(r.motion.first_over_limit), r.motion.first_over_limit};
}

Loss fault_opened(const Result& r, const Asked&) {
  const PerforationTruth& t = r.perforation.fault;
  if (!t.perforated) return {"no faulty breakthrough", {}};
  const std::string taken = t.volume_mm3 > 0 ? fmt::format("{} mm3 of it removed", fixed(t.volume_mm3, 3)) : "none of it removed";
  return {fmt::format("{} opened{} at {}, {} mm2 of its wall in all, {}", t.tissue, at_when(t.first), place(t.first.site_mm), fixed(t.area_mm2, 3),
                      taken),
          t.first};
}

Loss swept_outside(const Result& r, const Asked&) {
  const Trace& first = r.perforation.fault.first_outside;
  if (first.tick < 0) return {"none", {}};
  return {fmt::format("from outside the tooth, first{} at {}", at_when(first), place(first.site_mm)), first};
}

Loss fault_felt(const Result& r, const Asked&) {
  for (const auto& e : r.perforation.events)
    if (e.fault && e.confirmed)
      return {fmt::format("a drop in force from {} N at {}", fixed(e.force_before_n, 2), when({e.tick, e.site_mm})), {e.tick, e.site_mm}};
  return {"no faulty breakthrough that force and tissue show", {}};
}

Loss tissue_touched(const Result& r, const Asked& a) {
  for (const auto& t : r.tissues)
    if (const Trace& first = r.volumes.tissue_first[t.id]; t.name == a.measure.tissue && first.tick >= 0)
      return {fmt::format("touched first{} at {}", at_when(first), place(first.site_mm)), first};
  return {"never touched", {}};
}

Loss first_violation(const Result& r, const Asked&) {
  if (r.progress.first_violation.tick < 0) return {};
  return {"first at " + when(r.progress.first_violation), r.progress.first_violation};
}

}  // namespace reason

}  // namespace cavum::grading
