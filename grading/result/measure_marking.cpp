#include "grading/result/measure_marking.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace cavum::grading {
namespace {

MetricValue of_volume(const BoundedVolume& v) { return {v.mm3, v.bound_mm3}; }
MetricValue known_to(std::optional<double> value, double bound) { return {value, bound}; }
MetricValue exactly(double v) { return {v, 0.0}; }

/// All that was removed in the row's zones.
MetricValue in_zones(const Result& r, const Asked& a) {
  MetricValue sum{0.0, 0.0};
  for (const scenarios::Zone z : a.marking->zones) {
    const ZoneVolume& zone = r.volumes.zone[static_cast<std::size_t>(z)];
    const BoundedVolume v = a.marking->zones.size() == 1 ? zone.alone() : zone.removed;
    *sum.value += v.mm3;
    sum.bound += v.bound_mm3;
  }
  return sum;
}

/// The largest figure of the measure's walls. The true one lies between the largest of the lower ends of all walls and the largest of the upper ends.
MetricValue worst_wall(const Result& r, const Asked& a) {
  const scenarios::WallFigure figure = a.measure.figure;
  std::optional<double> worst;
  double low = 0, high = 0;
  for (std::size_t w = a.measure.first_wall; w < a.measure.first_wall + a.measure.walls; ++w) {
    const WallMeasures& wall = r.shape.wall[w];
    if (wall.samples == 0 && figure != scenarios::WallFigure::max_over) continue;  // no overcut where nothing was cut
    const double v = wall_figure(wall, figure), bound = wall_bound_mm(r.shape, wall, figure);
    if (a.measure.walls == 1) return {v, bound};
    low = worst ? std::max(low, v - bound) : v - bound;
    high = worst ? std::max(high, v + bound) : v + bound;
    worst = worst ? std::max(*worst, v) : v;
  }
  return worst ? MetricValue{worst, std::max(high - *worst, *worst - low)} : MetricValue{std::nullopt, r.shape.bound_mm};
}

MetricValue of_tissue(const Result& r, const Asked& a) {
  for (const auto& t : r.tissues)
    if (t.name == a.measure.tissue) return of_volume(r.volumes.tissue[t.id]);
  return exactly(0.0);  // this tooth has none of it
}

MetricValue taper_error(const Result& r, const Asked&) {
  const double bound = r.shape.taper_bound_deg + r.access.target_taper_bound_deg;
  if (!r.shape.taper_deg || !r.access.target_taper_deg) return {std::nullopt, bound};
  return {std::fabs(*r.shape.taper_deg - *r.access.target_taper_deg), bound};
}

MetricValue fault_events(const Result& r, const Asked&) {
  return exactly(static_cast<double>(
      std::count_if(r.perforation.events.begin(), r.perforation.events.end(), [](const auto& e) { return e.fault && e.confirmed; })));
}

/// Every zone; without the target, what lies beyond it.
std::vector<scenarios::Zone> all_zones(bool with_target) {
  std::vector<scenarios::Zone> zones{scenarios::Zone::leeway_sides,     scenarios::Zone::leeway_bottom, scenarios::Zone::container_sides,
                                     scenarios::Zone::container_bottom, scenarios::Zone::protected_,    scenarios::Zone::none};
  if (with_target) zones.insert(zones.begin(), scenarios::Zone::target);
  return zones;
}

using R = const Result&;
using A = const Asked&;

/// What was removed in some zones. `json` null: it has no place of its own.
MeasureMarking in_zones_row(const char* measure, std::vector<scenarios::Zone> zones, const char* json = nullptr) {
  return {.measure = measure,
          .value = in_zones,
          .reason = reason::removed_in_zones,
          .zones = std::move(zones),
          .json = json,
          .bound_json = json != nullptr ? "/volumes/bounds/" : nullptr};
}

std::vector<MeasureMarking> volume_markings() {
  return {
      {.measure = "target_removed_percent",
       .value = [](R r, A) { return known_to(r.volumes.target_removed_percent, r.volumes.target_removed_bound_percent); },
       .reason = reason::missed_target,
       .json = "/volumes/",
       .bound_json = "/volumes/bounds/"},
      {.measure = "missed_mm3",
       .value = [](R r, A) { return of_volume(r.volumes.missed); },
       .reason = reason::missed_target,
       .json = "/volumes/",
       .bound_json = "/volumes/bounds/"},
      {.measure = "removed_mm3",
       .value = [](R r, A) { return of_volume(r.volumes.removed); },
       .reason = reason::removed_in_zones,
       .zones = all_zones(true),
       .json = "/volumes/",
       .bound_json = "/volumes/bounds/"},
      in_zones_row("outside_mm3", {scenarios::Zone::none, scenarios::Zone::protected_}, "/volumes/"),
      in_zones_row("protected_mm3", {scenarios::Zone::protected_}, "/volumes/"),
      in_zones_row("leeway_sides_mm3", {scenarios::Zone::leeway_sides}, "/volumes/overcut/"),
      in_zones_row("leeway_bottom_mm3", {scenarios::Zone::leeway_bottom}, "/volumes/overcut/"),
      in_zones_row("container_sides_mm3", {scenarios::Zone::container_sides}, "/volumes/overcut/"),
      in_zones_row("container_bottom_mm3", {scenarios::Zone::container_bottom}, "/volumes/overcut/"),
      in_zones_row("container_mm3", {scenarios::Zone::container_sides, scenarios::Zone::container_bottom}),
      in_zones_row("overcut_mm3",
                   {scenarios::Zone::container_sides, scenarios::Zone::container_bottom, scenarios::Zone::protected_, scenarios::Zone::none}),
      {.measure = "dice",
       .value = [](R r, A) { return known_to(r.volumes.dice, r.volumes.dice_bound); },
       .reason = reason::missed_and_beyond,
       .zones = all_zones(false),
       .json = "/volumes/",
       .bound_json = "/volumes/bounds/"},
      {.measure = scenarios::k_wall_family, .value = worst_wall, .reason = reason::at_walls},
  };
}

std::vector<MeasureMarking> shape_markings() {
  return {
      {.measure = "outline_length_mm",
       .value = [](R r, A) { return known_to(r.shape.length_mm, r.shape.bound_mm); },
       .reason = reason::figure_alone,
       .json = "/shape/",
       .bound_json = "/shape/bound_mm"},
      {.measure = "outline_width_mm",
       .value = [](R r, A) { return known_to(r.shape.width_mm, r.shape.bound_mm); },
       .reason = reason::figure_alone,
       .json = "/shape/",
       .bound_json = "/shape/bound_mm"},
      {.measure = "outline_length_error_mm",
       .value = [](R r, A) { return known_to(r.shape.length_error_mm, 2 * r.shape.bound_mm); },
       .reason = reason::length_error},
      {.measure = "outline_width_error_mm",
       .value = [](R r, A) { return known_to(r.shape.width_error_mm, 2 * r.shape.bound_mm); },
       .reason = reason::width_error},
      {.measure = "depth_mm",
       .value = [](R r, A) { return known_to(r.shape.depth_mm, r.shape.bound_mm); },
       .reason = reason::figure_alone,
       .json = "/shape/",
       .bound_json = "/shape/bound_mm"},
      {.measure = "depth_error_mm",
       .value = [](R r, A) { return known_to(r.shape.depth_error_mm, 2 * r.shape.bound_mm); },
       .reason = reason::depth_error},
      {.measure = "taper_deg",
       .value = [](R r, A) { return known_to(r.shape.taper_deg, r.shape.taper_bound_deg); },
       .reason = reason::figure_alone,
       .json = "/shape/",
       .bound_json = "/shape/taper_bound_deg"},
      {.measure = "taper_error_deg", .value = taper_error, .reason = reason::taper_error},
  };
}

std::vector<MeasureMarking> access_markings() {
  return {
      {.measure = "overhang_mm3",
       .value = [](R r, A) { return r.access.overhang ? of_volume(*r.access.overhang) : MetricValue{}; },
       .reason = reason::overhang,
       .json = "/access/",
       .bound_json = "/access/bounds/"},
      {.measure = "canals_covered_percent",
       .value = [](R r, A) { return known_to(r.access.canals_covered_percent, r.access.canals_bound_percent); },
       .reason = reason::canals_covered,
       .json = "/access/",
       .bound_json = "/access/bounds/"},
      {.measure = "floor_cut_mm3",
       .value = [](R r, A) { return of_volume(r.access.floor_cut); },
       .reason = reason::floor_cut,
       .json = "/access/",
       .bound_json = "/access/bounds/"},
      {.measure = "dentin_over_pulp_mm",
       .value = [](R r, A) { return known_to(r.over_pulp.dentin_mm, r.over_pulp.bound_mm); },
       .reason = reason::dentin_over_pulp,
       .json = "/pulp/",
       .bound_json = "/pulp/bounds/"},
  };
}

std::vector<MeasureMarking> beside_markings() {
  return {
      {.measure = "neighbour_nick_depth_mm",
       .value = [](R r, A) { return known_to(r.beside.nick_depth_mm, r.beside.nick_depth_bound_mm); },
       .reason = reason::nick,
       .json = "/beside/",
       .bound_json = "/beside/bounds/"},
      {.measure = "neighbour_nick_area_mm2",
       .value = [](R r, A) { return known_to(r.beside.nick_area_mm2, r.beside.nick_area_bound_mm2); },
       .reason = reason::nick,
       .json = "/beside/",
       .bound_json = "/beside/bounds/"},
      {.measure = "neighbour_removed_mm3",
       .value = [](R r, A) { return of_volume(r.beside.neighbour_removed); },
       .reason = reason::nick,
       .json = "/beside/",
       .bound_json = "/beside/bounds/"},
      {.measure = "proximal_clearance_mm",
       .value = [](R r, A) { return known_to(r.beside.clearance_mm, r.beside.clearance_bound_mm); },
       .reason = reason::clearance,
       .json = "/beside/",
       .bound_json = "/beside/bounds/"},
      {.measure = "gum_removed_mm3",
       .value = [](R r, A) { return of_volume(r.beside.gum_removed); },
       .reason = reason::gum,
       .json = "/beside/",
       .bound_json = "/beside/bounds/"},
      {.measure = "gum_touched_s",
       .value = [](R r, A) { return known_to(r.beside.gum_touched_s, r.beside.gum_touched_bound_s); },
       .reason = reason::gum,
       .json = "/beside/",
       .bound_json = "/beside/bounds/"},
  };
}

std::vector<MeasureMarking> motion_markings() {
  return {
      {.measure = "time_s",
       .value = [](R r, A) { return known_to(r.motion.time_s, r.motion.time_bound_s); },
       .reason = reason::time_over,
       .json = "/",
       .bound_json = "/bounds/"},
      {.measure = "handpiece_time_s",
       .value = [](R r, A) { return known_to(r.motion.handpiece_time_s, r.motion.handpiece_bound_s); },
       .reason = reason::figure_alone,
       .json = "/",
       .bound_json = "/bounds/"},
      {.measure = "idle_s",
       .value = [](R r, A) { return known_to(r.motion.idle_s, r.motion.idle_bound_s); },
       .reason = reason::figure_alone,
       .json = "/",
       .bound_json = "/bounds/"},
      {.measure = "force_mean_n",
       .value = [](R r, A) { return known_to(r.motion.force_mean_n, r.motion.force_bound_n); },
       .reason = reason::figure_alone,
       .json = "/force/mean_n"},
      {.measure = "force_peak_n",
       .value = [](R r, A) { return known_to(r.motion.force_peak_n, r.motion.force_bound_n); },
       .reason = reason::force_peak,
       .json = "/force/peak_n"},
      {.measure = "force_over_limit_s",
       .value = [](R r, A) { return known_to(r.motion.force_over_limit_s, r.motion.over_limit_bound_s); },
       .reason = reason::force_over_limit,
       .json = "/force/over_limit_s",
       .bound_json = "/bounds/over_limit_s"},
      {.measure = "path_mm",
       .value = [](R r, A) { return known_to(r.motion.path_mm, r.motion.path_bound_mm); },
       .reason = reason::figure_alone,
       .json = "/",
       .bound_json = "/bounds/"},
  };
}

std::vector<MeasureMarking> conduct_markings() {
  return {
      {.measure = "perforated",
       .value = [](R r, A) { return exactly(r.perforation.fault.perforated ? 1.0 : 0.0); },
       .reason = reason::fault_opened,
       .json = "/perforation/truth/",
       .whole = true},
      {.measure = "perforation_volume_mm3",
       .value = [](R r, A) { return known_to(r.perforation.fault.volume_mm3, r.perforation.fault.bound_mm3); },
       .reason = reason::fault_opened,
       .json = "/perforation/truth/volume_mm3",
       .bound_json = "/perforation/truth/bound_mm3"},
      {.measure = "soft_tissue_outside_mm3",
       .value = [](R r, A) { return known_to(r.perforation.fault.outside_mm3, r.perforation.fault.bound_mm3); },
       .reason = reason::swept_outside,
       .json = "/perforation/truth/outside_mm3",
       .bound_json = "/perforation/truth/bound_mm3"},
      {.measure = "perforation_events", .value = fault_events, .reason = reason::fault_felt},
      {.measure = scenarios::k_tissue_family, .value = of_tissue, .reason = reason::tissue_touched},
      {.measure = "steps_completed",
       .value = [](R r, A) { return exactly(r.progress.steps_completed); },
       .reason = reason::figure_alone,
       .json = "/steps/completed",
       .whole = true},
      {.measure = "steps_failed",
       .value = [](R r, A) { return exactly(r.progress.steps_failed); },
       .reason = reason::figure_alone,
       .json = "/steps/failed",
       .whole = true},
      {.measure = "violations",
       .value = [](R r, A) { return exactly(r.progress.violations); },
       .reason = reason::first_violation,
       .json = "/",
       .whole = true},
  };
}

std::string place_in(const char* pointer, const scenarios::Measure& m) {
  if (pointer == nullptr) return "";
  const std::string place = pointer;
  return place.ends_with('/') ? place + m.name : place;
}

/// The families' places: the wall's or the tissue's object, in it the figure's or the tissue's name.
std::string family_place(const scenarios::Measure& m, bool bound) {
  if (!m.tissue.empty()) return fmt::format("{}/tissue_mm3/{}", bound ? "/volumes/bounds" : "/volumes", m.tissue);
  if (m.walls != 1) return "";
  return fmt::format("/walls/{}{}{}", scenarios::wall_name(static_cast<scenarios::Wall>(m.first_wall)), bound ? "/bounds/" : "/",
                     scenarios::wall_figure_name(m.figure));
}

}  // namespace

std::vector<MeasureMarking> checked_markings(std::vector<MeasureMarking> rows) {
  std::vector<std::string> keys;
  for (const auto& row : rows) {
    if (row.measure == nullptr || row.value == nullptr || row.reason == nullptr)
      throw std::logic_error(fmt::format("measure_marking: {} lacks name, value or reason", row.measure != nullptr ? row.measure : "a row"));
    keys.emplace_back(row.measure);
  }
  scenarios::require_row_for_each(keys, "measure_marking");
  return rows;
}

const std::vector<MeasureMarking>& measure_markings() {
  static const std::vector<MeasureMarking> k_rows = [] {
    std::vector<MeasureMarking> all;
    for (auto* some : {volume_markings, shape_markings, access_markings, beside_markings, motion_markings, conduct_markings})
      for (auto& row : some()) all.push_back(std::move(row));
    return checked_markings(std::move(all));
  }();
  return k_rows;
}

const MeasureMarking& marking_of(const scenarios::Measure& measure) {
  const std::string key = measure.key();
  for (const auto& row : measure_markings())
    if (row.measure == key) return row;
  throw std::logic_error("measure_marking: no row for the measure " + key);
}

Asked asked(const std::string& metric, double full) {
  Asked a{scenarios::known_measure(metric), nullptr, full};
  a.marking = &marking_of(a.measure);
  return a;
}

std::string json_place(const scenarios::Measure& m) { return m.family != nullptr ? family_place(m, false) : place_in(marking_of(m).json, m); }
std::string bound_json_place(const scenarios::Measure& m) {
  return m.family != nullptr ? family_place(m, true) : place_in(marking_of(m).bound_json, m);
}

double wall_figure(const WallMeasures& w, scenarios::WallFigure figure) noexcept {
  switch (figure) {
    case scenarios::WallFigure::mean:
      return w.mean_mm;
    case scenarios::WallFigure::p95:
      return w.p95_mm;
    case scenarios::WallFigure::max_over:
      return w.max_over_mm;
    case scenarios::WallFigure::max_under:
      break;
  }
  return w.max_under_mm;
}

double wall_bound_mm(const ShapeMeasures& shape, const WallMeasures& w, scenarios::WallFigure figure) noexcept {
  if (w.samples == 0) return shape.bound_mm;
  return figure == scenarios::WallFigure::mean ? w.mean_bound_mm : figure == scenarios::WallFigure::p95 ? w.p95_bound_mm : shape.bound_mm;
}

bool not_shown(const Result& r, const scenarios::Measure& measure) {
  if (!r.not_shown) return false;
  if (measure.of_exam || measure.name == "soft_tissue_outside_mm3") return true;
  if (measure.needs == scenarios::Needs::neighbour || measure.needs == scenarios::Needs::gum) return true;  // a tooth is scanned alone
  return std::any_of(r.tissues.begin(), r.tissues.end(), [&](const Tissue& t) { return t.name == measure.tissue && r.not_shown->tissue[t.id]; });
}

MetricValue value_of(const Result& r, const Asked& a) { return not_shown(r, a.measure) ? MetricValue{} : a.marking->value(r, a); }

MetricValue metric_value(const Result& r, const std::string& metric) { return value_of(r, asked(metric, 0)); }

}  // namespace cavum::grading
