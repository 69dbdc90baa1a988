#include "grading/result/loss.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "engine/base/text.h"

namespace cavum {

std::string when(const Trace& t) { return fixed(t.t_s(), 2) + " s (tick " + std::to_string(t.tick) + ")"; }
std::string place(Vec3 p) { return "[" + fixed(p.x, 2) + ", " + fixed(p.y, 2) + ", " + fixed(p.z, 2) + "] mm"; }
std::string wall_text(std::size_t wall) {
  return wall == static_cast<std::size_t>(Wall::opening) ? "the occlusal side"
         : wall == static_cast<std::size_t>(Wall::floor) ? "the floor"
                                                         : "the " + std::string(wall_name(static_cast<Wall>(wall))) + " wall";
}

std::string amount_text(double value, double bound, int digits, const std::string& unit) {
  return fixed(value, digits) + (bound > 0 ? " ± " + fixed(bound, digits) : "") + (unit.empty() ? "" : " " + unit);
}

namespace {

std::size_t largest(const std::array<double, k_walls + 1>& by_wall) {
  return static_cast<std::size_t>(std::max_element(by_wall.begin(), by_wall.end()) - by_wall.begin());
}

Loss missed_target(const Result& r) {
  const auto w = largest(r.volumes.missed_by_wall_mm3);
  const Trace& last = r.volumes.target_last[w];
  return {amount_text(r.volumes.missed.mm3, r.volumes.missed.bound_mm3, 2, "mm3") + " of the target left standing, most of it towards " +
              wall_text(w) + " (" + fixed(r.volumes.missed_by_wall_mm3[w], 2) + " mm3), where " +
              (last.tick < 0 ? "nothing of it was cut" : "it was cut last at " + when(last)),
          last};
}

Loss removed_in(const Result& r, std::initializer_list<Zone> zones) {
  Loss loss;
  double most = 0;
  std::size_t wall = 0;
  Zone worst = *zones.begin();
  for (const Zone z : zones) {
    const ZoneVolume& v = r.volumes.zone[static_cast<std::size_t>(z)];
    const auto w = largest(v.by_wall_mm3);
    if (v.by_wall_mm3[w] > most) {
      most = v.by_wall_mm3[w];
      wall = w;
      worst = z;
    }
    if (v.first.tick >= 0 && (loss.first.tick < 0 || v.first.tick < loss.first.tick)) loss.first = v.first;
  }
  loss.text = std::string("most of it ") + (worst == Zone::none ? "outside all zones" : std::string("in ") + zone_name(worst)) + " at " +
              wall_text(wall) + " (" + fixed(most, 2) + " mm3)";
  if (loss.first.tick >= 0) loss.text += ", beginning at " + when(loss.first) + " at " + place(loss.first.site_mm);
  return loss;
}

/// By the wall that has the largest of the figure: "max_over_mm", "max_under_mm", "p95_mm" or "mean_mm".
Loss at_walls(const Result& r, std::size_t first, std::size_t end, std::string_view metric) {
  const bool over = metric.ends_with("max_over_mm"), under = metric.ends_with("max_under_mm"), p95 = metric.ends_with("p95_mm");
  const auto size = [&](const WallMeasures& m) { return over ? m.max_over_mm : under ? m.max_under_mm : p95 ? m.p95_mm : m.mean_mm; };
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
  if (over)
    loss.text = wall_text(worst) + " overcut by up to " + fixed(m.max_over_mm, 2) + " mm";
  else if (under)
    loss.text = wall_text(worst) + " left up to " + fixed(m.max_under_mm, 2) + " mm thick";
  else
    loss.text = wall_text(worst) +
                (p95 ? ", 95 % of whose places lie no further out than that; the furthest " : ", in the mean of its places; the furthest ") +
                (&t == &m.worst_under ? fixed(m.max_under_mm, 2) + " mm thick" : fixed(m.max_over_mm, 2) + " mm beyond the target");
  if (t.tick >= 0) loss.text += ", at " + place(t.site_mm) + ", cut at " + when(t);
  return loss;
}

/// "0.68 mm at the mesial end (0.68 mm too far), 0.57 mm at the distal end (0.57 mm short)"
std::string ends_text(const Result& r, std::size_t first) {
  constexpr const char* k_ends[] = {"mesial", "distal", "buccal", "lingual"};
  std::string text;
  for (std::size_t i = first; i < first + 2; ++i) {
    const auto& e = r.shape.end_error[i];
    text += (text.empty() ? "" : ", ") + fixed(e.part_mm, 2) + " mm at the " + k_ends[i] + " end (" + fixed(std::fabs(e.beyond_mm), 2) +
            (e.beyond_mm >= 0 ? " mm too far)" : " mm short)");
  }
  return text;
}

}  // namespace

Loss loss_of(const Result& r, const std::string& metric) {
  if (metric == "target_removed_percent" || metric == "missed_mm3") return missed_target(r);
  if (metric == "dice") {
    Loss over = removed_in(r, {Zone::leeway_sides, Zone::leeway_bottom, Zone::container_sides, Zone::container_bottom, Zone::protected_, Zone::none});
    const Volume& in_target = r.volumes.zone[static_cast<std::size_t>(Zone::target)].removed;
    Loss missed = missed_target(r);
    if (over.first.tick < 0) return missed;
    return {missed.text + "; " + fixed(r.volumes.removed.mm3 - in_target.mm3, 2) + " mm3 removed beyond the target, " + over.text, over.first};
  }
  if (metric == "removed_mm3")
    return removed_in(
        r, {Zone::target, Zone::leeway_sides, Zone::leeway_bottom, Zone::container_sides, Zone::container_bottom, Zone::protected_, Zone::none});
  if (metric == "outside_mm3") return removed_in(r, {Zone::none, Zone::protected_});
  if (metric == "protected_mm3") return removed_in(r, {Zone::protected_});
  if (metric == "leeway_sides_mm3") return removed_in(r, {Zone::leeway_sides});
  if (metric == "leeway_bottom_mm3") return removed_in(r, {Zone::leeway_bottom});
  if (metric == "container_sides_mm3") return removed_in(r, {Zone::container_sides});
  if (metric == "container_bottom_mm3") return removed_in(r, {Zone::container_bottom});
  if (metric == "container_mm3") return removed_in(r, {Zone::container_sides, Zone::container_bottom});
  if (metric == "overcut_mm3") return removed_in(r, {Zone::container_sides, Zone::container_bottom, Zone::protected_, Zone::none});
  if (metric == "floor_cut_mm3") {
    if (r.access.floor_first.tick < 0) return {"no hard tissue was cut below the target", {}};
    return {"beginning at " + when(r.access.floor_first) + " at " + place(r.access.floor_first.site_mm), r.access.floor_first};
  }
  if (metric.rfind("side_walls_", 0) == 0) return at_walls(r, 0, 4, metric);
  if (metric.rfind("walls_", 0) == 0) return at_walls(r, 0, k_walls, metric);
  for (std::size_t w = 0; w < k_walls; ++w)
    if (metric.rfind(std::string(wall_name(static_cast<Wall>(w))) + "_", 0) == 0) return at_walls(r, w, w + 1, metric);
  if (metric == "perforated" || metric == "perforation_volume_mm3") {
    const PerforationTruth& t = r.perforation.fault;
    if (!t.perforated) return {"no faulty breakthrough", {}};
    return {t.tissue + " touched at " + when(t.first) + " at " + place(t.first.site_mm) + ", " + fixed(t.volume_mm3, 3) + " mm3 in all", t.first};
  }
  if (metric == "perforation_events") {
    for (const auto& e : r.perforation.events)
      if (e.fault) return {"a drop in force from " + fixed(e.force_before_n, 2) + " N at " + when({e.tick, e.site_mm}), {e.tick, e.site_mm}};
    return {"no faulty breakthrough seen in the force", {}};
  }
  if (metric.rfind("touched_", 0) == 0) {
    for (const auto& t : r.tissues)
      if (const Trace& first = r.volumes.tissue_first[t.id]; metric == "touched_" + t.name + "_mm3" && first.tick >= 0)
        return {"touched first at " + when(first) + " at " + place(first.site_mm), first};
    return {"never touched", {}};
  }
  if (metric == "overhang_mm3") return {"roof left above the chamber, around " + place(r.access.overhang_middle_mm), {}};
  if (metric == "canals_covered_percent") return {"hard tissue stands over the mouths around " + place(r.access.canals_covered_mm), {}};
  if (metric == "taper_error_deg")
    return {"the walls open by " + fixed(*r.shape.taper_deg, 1) + " instead of " + fixed(*r.access.target_taper_deg, 1) + " degrees", {}};
  if (metric == "force_peak_n")
    return {"pressed hardest at " + when(r.motion.force_peak) + " at " + place(r.motion.force_peak.site_mm), r.motion.force_peak};
  if (metric == "force_over_limit_s" && r.motion.first_over_limit.tick >= 0)
    return {"above the limit first at " + when(r.motion.first_over_limit), r.motion.first_over_limit};
  if (metric == "violations" && r.progress.first_violation.tick >= 0)
    return {"first at " + when(r.progress.first_violation), r.progress.first_violation};
  if (metric == "depth_error_mm" && r.shape.depth_mm)
    return {"depth " + fixed(*r.shape.depth_mm, 2) + " mm instead of " + fixed(r.shape.target_depth_mm, 2) + " mm", {}};
  if (metric == "outline_width_error_mm" && r.shape.width_mm)
    return {ends_text(r, 2) + "; width " + fixed(*r.shape.width_mm, 2) + " mm instead of " + fixed(r.shape.target_width_mm, 2) + " mm", {}};
  if (metric == "outline_length_error_mm" && r.shape.length_mm)
    return {ends_text(r, 0) + "; length " + fixed(*r.shape.length_mm, 2) + " mm instead of " + fixed(r.shape.target_length_mm, 2) + " mm", {}};
  return {};
}

}  // namespace cavum
