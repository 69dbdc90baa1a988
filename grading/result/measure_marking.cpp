#include "grading/result/measure_marking.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

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

/// The largest figure of the measure's walls. The true one lies between the largest of the lower
/// ends of all walls and the largest of the upper ends.
MetricValue worst_wall(const Result& r, const Asked& a) {
  const scenarios::WallFigure figure = a.measure.figure;
  std::optional<double> worst;
  double low = 0, high = 0;
  for (std::size_t w = a.measure.first_wall; w < a.measure.first_wall + a.measure.walls; ++w) {
    const WallMeasures& wall = r.shape.wall[w];
    if (wall.samples == 0 && figure != scenarios::WallFigure::max_over)
      continue;  // no overcut where nothing was cut
    const double v = wall_figure(wall, figure), bound = wall_bound_mm(r.shape, wall, figure);
    if (a.measure.walls == 1) return {v, bound};
    low = worst ? std::max(low, v - bound) : v - bound;
    high = worst ? std::max(high, v + bound) : v + bound;
    worst = worst ? std::max(*worst, v) : v;
  }
  return worst ? MetricValue{worst, std::max(high - *worst, *worst - low)}
               : MetricValue{std::nullopt, r.shape.bound_mm};
}

MetricValue of_tissue(const Result& r, const Asked& a) {
  for (const auto& t : r.tissues)
    if (t.name == a.measure.tissue) return of_volume(r.volumes.tissue[t.id]);
  return exactly(0.0);  // this tooth has none of it
}

MetricValue taper_difference(const Result& r) {
  const double bound = r.shape.taper_bound_deg + r.access.target_taper_bound_deg;
  if (!r.shape.taper_deg || !r.access.target_taper_deg) return {std::nullopt, bound};
  return {std::fabs(*r.shape.taper_deg - *r.access.target_taper_deg), bound};
}

MetricValue fault_events(const Result& r) {
  return exactly(
      static_cast<double>(std::count_if(r.perforation.events.begin(), r.perforation.events.end(),
                                        [](const auto& e) { return e.fault && e.confirmed; })));
}

/// Every zone; without the target, what lies beyond it.
std::vector<scenarios::Zone> all_zones(bool with_target) {
  std::vector<scenarios::Zone> zones{
      scenarios::Zone::leeway_sides,    scenarios::Zone::leeway_bottom,
      scenarios::Zone::container_sides, scenarios::Zone::container_bottom,
      scenarios::Zone::protected_,      scenarios::Zone::none};
  if (with_target) zones.insert(zones.begin(), scenarios::Zone::target);
  return zones;
}

std::string place_in(const char* pointer, const scenarios::Measure& m) {
  if (pointer == nullptr) return "";
  const std::string place = pointer;
  return place.ends_with('/') ? place + m.name : place;
}

/// The families' places: the wall's or the tissue's object, in it the figure's or the tissue's
/// name.
std::string family_place(const scenarios::Measure& m, bool bound) {
  if (!m.tissue.empty())
    return fmt::format("{}/tissue_mm3/{}", bound ? "/volumes/bounds" : "/volumes", m.tissue);
  if (m.walls != 1) return "";
  return fmt::format("/walls/{}{}{}",
                     scenarios::wall_name(static_cast<scenarios::Wall>(m.first_wall)),
                     bound ? "/bounds/" : "/", scenarios::wall_figure_name(m.figure));
}

}  // namespace

const MeasureMarking& marking_of(const scenarios::Measure& measure) {
  using scenarios::Zone;
  using R = const Result&;
  using A = const Asked&;
  static const std::vector<MeasureMarking> k_rows{
#define IN(OBJECT) .json = OBJECT, .bound_json = OBJECT "bounds/"
#define IN_OVERCUT .json = "/volumes/overcut/", .bound_json = "/volumes/bounds/"
#define MEASURE(NAME, WORDS, WHAT, VALUE, REASON, MOMENTS, PLACE)                            \
  {.measure = NAME,                                                                          \
   .value = []([[maybe_unused]] R r, [[maybe_unused]] A a) -> MetricValue { return VALUE; }, \
   .reason = reason::REASON IN_ROW PLACE},
#define FAMILY(KEY, MEMBERS, VALUE, REASON, MOMENTS) \
  MEASURE(scenarios::KEY, , , VALUE, REASON, MOMENTS, ())
#include "scenarios/file/measures_table.inc"
#undef IN
#undef IN_OVERCUT
  };
  const std::string key = measure.key();
  return *std::find_if(k_rows.begin(), k_rows.end(),
                       [&](const MeasureMarking& row) { return row.measure == key; });
}

Asked asked(const std::string& metric, double full) {
  Asked a{scenarios::known_measure(metric), nullptr, full};
  a.marking = &marking_of(a.measure);
  return a;
}

std::string json_location(const scenarios::Measure& m) {
  return m.family != nullptr ? family_place(m, false) : place_in(marking_of(m).json, m);
}
std::string bound_json_location(const scenarios::Measure& m) {
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

double wall_bound_mm(const ShapeMeasures& shape, const WallMeasures& w,
                     scenarios::WallFigure figure) noexcept {
  if (w.samples == 0) return shape.bound_mm;
  return figure == scenarios::WallFigure::mean  ? w.mean_bound_mm
         : figure == scenarios::WallFigure::p95 ? w.p95_bound_mm
                                                : shape.bound_mm;
}

bool not_shown(const Result& r, const scenarios::Measure& measure) {
  if (!r.not_shown) return false;
  if (measure.of_exam || measure.name == "soft_tissue_outside_mm3") return true;
  if (measure.needs == scenarios::Needs::neighbour || measure.needs == scenarios::Needs::gum)
    return true;  // a tooth is scanned alone
  return std::any_of(r.tissues.begin(), r.tissues.end(), [&](const Tissue& t) {
    return t.name == measure.tissue && r.not_shown->tissue[t.id];
  });
}

MetricValue value_of(const Result& r, const Asked& a) {
  return not_shown(r, a.measure) ? MetricValue{} : a.marking->value(r, a);
}

MetricValue metric_value(const Result& r, const std::string& metric) {
  return value_of(r, asked(metric, 0));
}

}  // namespace cavum::grading
