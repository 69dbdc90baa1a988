#include "grading/feedback/moments_of_measure.h"

#include <fmt/core.h>

#include <stdexcept>
#include <string>

namespace cavum::grading {

std::vector<MomentsOfMeasure> checked_moments(std::vector<MomentsOfMeasure> rows) {
  std::vector<std::string> keys;
  for (const auto& row : rows) {
    if (row.measure == nullptr || row.words == nullptr || row.list == nullptr)
      throw std::logic_error(fmt::format("moments_of_measure: {} lacks name, words or list", row.measure != nullptr ? row.measure : "a row"));
    keys.emplace_back(row.measure);
  }
  scenarios::require_row_for_each(keys, "moments_of_measure");
  return rows;
}

const std::vector<MomentsOfMeasure>& moments_of_measures() {
  static const std::vector<MomentsOfMeasure> k_rows = checked_moments({
      {.measure = "target_removed_percent", .words = "what stayed, by wall", .list = &LossFinder::missed_target},
      {.measure = "missed_mm3", .words = "what stayed, by wall", .list = &LossFinder::missed_target},
      {.measure = "removed_mm3", .words = "what was removed there", .list = &LossFinder::removed_in_zones},
      {.measure = "outside_mm3", .words = "what was removed there", .list = &LossFinder::removed_in_zones},
      {.measure = "protected_mm3", .words = "what was removed there", .list = &LossFinder::removed_in_zones},
      {.measure = "leeway_sides_mm3", .words = "what was removed there", .list = &LossFinder::removed_in_zones},
      {.measure = "leeway_bottom_mm3", .words = "what was removed there", .list = &LossFinder::removed_in_zones},
      {.measure = "container_sides_mm3", .words = "what was removed there", .list = &LossFinder::removed_in_zones},
      {.measure = "container_bottom_mm3", .words = "what was removed there", .list = &LossFinder::removed_in_zones},
      {.measure = "container_mm3", .words = "what was removed there", .list = &LossFinder::removed_in_zones},
      {.measure = "overcut_mm3", .words = "what was removed there", .list = &LossFinder::removed_in_zones},
      {.measure = "dice", .words = "what stayed, what was removed beyond", .list = &LossFinder::dice},
      {.measure = scenarios::k_wall_family, .words = "the walls' figures, furthest places, what was cut beyond", .list = &LossFinder::at_walls},
      {.measure = "outline_length_mm", .words = "both ends, when they were cut", .list = &LossFinder::length},
      {.measure = "outline_length_error_mm", .words = "both ends, when they were cut", .list = &LossFinder::length},
      {.measure = "outline_width_mm", .words = "both ends, when they were cut", .list = &LossFinder::width},
      {.measure = "outline_width_error_mm", .words = "both ends, when they were cut", .list = &LossFinder::width},
      {.measure = "depth_mm", .words = "the deepest place, when it was cut", .list = &LossFinder::depth},
      {.measure = "depth_error_mm", .words = "the deepest place, when it was cut", .list = &LossFinder::depth},
      {.measure = "taper_deg", .words = "the side walls", .list = &LossFinder::taper},
      {.measure = "taper_error_deg", .words = "both slopes, the side walls", .list = &LossFinder::taper_error},
      {.measure = "overhang_mm3", .words = "each piece of roof, last cut near it", .list = &LossFinder::overhang},
      {.measure = "canals_covered_percent", .words = "each mouth, last cut near it", .list = &LossFinder::canals},
      {.measure = "floor_cut_mm3", .words = "what was removed there", .list = &LossFinder::floor_cut},
      {.measure = "dentin_over_pulp_mm", .words = "the thinnest place, when it was cut", .list = &LossFinder::dentin_over_pulp},
      {.measure = "neighbour_nick_depth_mm", .words = "the deepest place, what was removed of neighbours", .list = &LossFinder::nick},
      {.measure = "neighbour_nick_area_mm2", .words = "the deepest place, what was removed of neighbours", .list = &LossFinder::nick},
      {.measure = "neighbour_removed_mm3", .words = "the deepest place, what was removed of neighbours", .list = &LossFinder::nick},
      {.measure = "proximal_clearance_mm", .words = "both places, last cut near the first", .list = &LossFinder::clearance},
      {.measure = "gum_removed_mm3", .words = "what was removed of it", .list = &LossFinder::gum},
      {.measure = "gum_touched_s", .words = "what was removed of it", .list = &LossFinder::gum},
      {.measure = "time_s", .words = "events, idle times", .list = &LossFinder::time},
      {.measure = "handpiece_time_s", .words = "when it turned", .list = &LossFinder::handpiece_time},
      {.measure = "idle_s", .words = "idle times", .list = &LossFinder::idle},
      {.measure = "force_mean_n", .words = "when more was pressed than gives full marks", .list = &LossFinder::force},
      {.measure = "force_peak_n", .words = "when more was pressed than gives full marks", .list = &LossFinder::force},
      {.measure = "force_over_limit_s", .words = "when more was pressed than the limit", .list = &LossFinder::force_over_limit},
      {.measure = "perforated", .words = "by tissue and by force", .list = &LossFinder::perforation},
      {.measure = "perforation_volume_mm3", .words = "by tissue and by force", .list = &LossFinder::perforation},
      {.measure = "soft_tissue_outside_mm3", .words = "by tissue and by force", .list = &LossFinder::perforation},
      {.measure = "perforation_events", .words = "by tissue and by force", .list = &LossFinder::perforation},
      {.measure = scenarios::k_tissue_family, .words = "what was removed of it", .list = &LossFinder::tissue},
      {.measure = "path_mm", .words = "events", .list = &LossFinder::steps},
      {.measure = "steps_completed", .words = "events", .list = &LossFinder::steps},
      {.measure = "steps_failed", .words = "events", .list = &LossFinder::steps},
      {.measure = "violations", .words = "events", .list = &LossFinder::steps},
  });
  return k_rows;
}

const MomentsOfMeasure& moments_of(const scenarios::Measure& measure) {
  const std::string key = measure.key();
  for (const auto& row : moments_of_measures())
    if (row.measure == key) return row;
  throw std::logic_error("moments_of_measure: no row for the measure " + key);
}

}  // namespace cavum::grading
