#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "grading/result/mark.h"

namespace cavum {
namespace {

MetricValue of_volume(const Volume& v) { return {v.mm3, v.bound_mm3}; }

MetricValue sum_of(const Result& r, std::initializer_list<Zone> zones) {
  MetricValue sum{0.0, 0.0};
  for (const Zone z : zones) {
    const Volume& v = r.volumes.zone[static_cast<std::size_t>(z)].removed;
    *sum.value += v.mm3;
    sum.bound += v.bound_mm3;
  }
  return sum;
}

double wall_figure(const WallMeasures& w, const std::string& figure) {
  if (figure == "mean_mm") return w.mean_mm;
  if (figure == "p95_mm") return w.p95_mm;
  if (figure == "max_over_mm") return w.max_over_mm;
  return w.max_under_mm;
}

double wall_bound(const Result& r, const WallMeasures& w, const std::string& figure) {
  if (w.samples == 0) return r.shape.bound_mm;
  return figure == "mean_mm" ? w.mean_bound_mm : figure == "p95_mm" ? w.p95_bound_mm : r.shape.bound_mm;
}

/// Largest figure of walls 0..last. The true one lies between the largest of the lower ends of all walls and the largest of the upper ends.
MetricValue worst_wall(const Result& r, std::size_t walls, const std::string& figure) {
  std::optional<double> worst;
  double low = 0, high = 0;
  for (std::size_t w = 0; w < walls; ++w) {
    if (r.shape.wall[w].samples == 0 && figure != "max_over_mm") continue;  // no overcut where nothing was cut
    const double v = wall_figure(r.shape.wall[w], figure), bound = wall_bound(r, r.shape.wall[w], figure);
    low = worst ? std::max(low, v - bound) : v - bound;
    high = worst ? std::max(high, v + bound) : v + bound;
    worst = worst ? std::max(*worst, v) : v;
  }
  return worst ? MetricValue{worst, std::max(high - *worst, *worst - low)} : MetricValue{std::nullopt, r.shape.bound_mm};
}

}  // namespace

MetricValue metric_value(const Result& r, const std::string& metric) {
  const auto& m = r.motion;
  const auto zone = [&](Zone z) { return of_volume(r.volumes.zone[static_cast<std::size_t>(z)].removed); };
  const auto exact = [](double v) { return MetricValue{v, 0.0}; };
  for (std::size_t w = 0; w < k_walls; ++w) {
    const std::string name = wall_name(static_cast<Wall>(w));
    for (const char* figure : {"mean_mm", "p95_mm", "max_over_mm", "max_under_mm"}) {
      if (metric != name + "_" + figure) continue;
      const WallMeasures& wall = r.shape.wall[w];
      if (wall.samples == 0 && figure != std::string("max_over_mm")) return {std::nullopt, r.shape.bound_mm};
      return {wall_figure(wall, figure), wall_bound(r, wall, figure)};
    }
  }
  if (metric.rfind("touched_", 0) == 0 && metric.size() > 12 && metric.ends_with("_mm3")) {
    const std::string tissue = metric.substr(8, metric.size() - 12);
    for (const auto& t : r.tissues)
      if (t.name == tissue) return of_volume(r.volumes.tissue[t.id]);
    return exact(0.0);  // this tooth has none of it
  }
  if (metric == "target_removed_percent") return {r.volumes.target_removed_percent, r.volumes.target_removed_bound_percent};
  if (metric == "missed_mm3") return of_volume(r.volumes.missed);
  if (metric == "removed_mm3") return of_volume(r.volumes.removed);
  if (metric == "outside_mm3") return of_volume(r.volumes.outside());
  if (metric == "protected_mm3") return zone(Zone::protected_);
  if (metric == "dice") return {r.volumes.dice, r.volumes.dice_bound};
  if (metric == "leeway_sides_mm3") return zone(Zone::leeway_sides);
  if (metric == "leeway_bottom_mm3") return zone(Zone::leeway_bottom);
  if (metric == "container_sides_mm3") return zone(Zone::container_sides);
  if (metric == "container_bottom_mm3") return zone(Zone::container_bottom);
  if (metric == "container_mm3") return sum_of(r, {Zone::container_sides, Zone::container_bottom});
  if (metric == "overcut_mm3") return sum_of(r, {Zone::container_sides, Zone::container_bottom, Zone::protected_, Zone::none});
  if (metric == "side_walls_max_over_mm") return worst_wall(r, 4, "max_over_mm");
  if (metric == "side_walls_max_under_mm") return worst_wall(r, 4, "max_under_mm");
  if (metric == "side_walls_p95_mm") return worst_wall(r, 4, "p95_mm");
  if (metric == "walls_max_over_mm") return worst_wall(r, k_walls, "max_over_mm");
  if (metric == "walls_max_under_mm") return worst_wall(r, k_walls, "max_under_mm");
  if (metric == "outline_width_mm") return {r.shape.width_mm, r.shape.bound_mm};
  if (metric == "outline_length_mm") return {r.shape.length_mm, r.shape.bound_mm};
  if (metric == "outline_width_error_mm") return {r.shape.width_error_mm, 2 * r.shape.bound_mm};
  if (metric == "outline_length_error_mm") return {r.shape.length_error_mm, 2 * r.shape.bound_mm};
  if (metric == "depth_mm") return {r.shape.depth_mm, r.shape.bound_mm};
  if (metric == "depth_error_mm") return {r.shape.depth_error_mm, 2 * r.shape.bound_mm};
  if (metric == "taper_deg") return {r.shape.taper_deg, r.shape.taper_bound_deg};
  if (metric == "taper_error_deg") {
    const double bound = r.shape.taper_bound_deg + r.access.target_taper_bound_deg;
    if (!r.shape.taper_deg || !r.access.target_taper_deg) return {std::nullopt, bound};
    return {std::fabs(*r.shape.taper_deg - *r.access.target_taper_deg), bound};
  }
  if (metric == "overhang_mm3") return r.access.overhang ? of_volume(*r.access.overhang) : MetricValue{};
  if (metric == "canals_covered_percent") return {r.access.canals_covered_percent, r.access.canals_bound_percent};
  if (metric == "floor_cut_mm3") return of_volume(r.access.floor_cut);
  if (metric == "time_s") return {m.time_s, m.time_bound_s};
  if (metric == "handpiece_time_s") return {m.handpiece_time_s, m.handpiece_bound_s};
  if (metric == "idle_s") return {m.idle_s, m.idle_bound_s};
  if (metric == "path_mm") return {m.path_mm, m.path_bound_mm};
  if (metric == "force_mean_n") return {m.force_mean_n, m.force_bound_n};
  if (metric == "force_peak_n") return {m.force_peak_n, m.force_bound_n};
  if (metric == "force_over_limit_s") return {m.force_over_limit_s, m.over_limit_bound_s};
  if (metric == "perforated") return exact(r.perforation.fault.perforated ? 1.0 : 0.0);
  if (metric == "perforation_volume_mm3") return {r.perforation.fault.volume_mm3, r.perforation.fault.bound_mm3};
  if (metric == "perforation_events")
    return exact(static_cast<double>(std::count_if(r.perforation.events.begin(), r.perforation.events.end(), [](const auto& e) { return e.fault; })));
  if (metric == "steps_completed") return exact(r.progress.steps_completed);
  if (metric == "steps_failed") return exact(r.progress.steps_failed);
  if (metric == "violations") return exact(r.progress.violations);
  throw Error("rubric", "there is no measure '" + metric + "'", "use one that `cavum scenario check` knows");
}

}  // namespace cavum
