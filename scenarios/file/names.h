// Names an instructor may use: live quantities in conditions, measures in a rubric. One list each, so
// that parser, runner, grading and the manual cannot disagree.
#pragma once

#include <array>
#include <string_view>

namespace cavum {

struct NamedQuantity {
  std::string_view name, unit, meaning;
};

/// Live quantities of step conditions, in the order of Runner's value table. Besides these, every
/// tissue NAME has `touched_NAME`, the volume of it removed so far, mm3.
inline constexpr std::array<NamedQuantity, 22> k_live_quantities{{
    {"time_s", "s", "since the exam began"},
    {"step_time_s", "s", "since this step began"},
    {"target_removed_percent", "%", "of the target's volume"},
    {"removed_mm3", "mm3", "all tissue removed"},
    {"leeway_mm3", "mm3", "removed in the leeway"},
    {"container_mm3", "mm3", "removed in the container (damage)"},
    {"outside_mm3", "mm3", "removed outside target, leeway and container, what is protected included"},
    {"protected_mm3", "mm3", "removed of what is protected, wherever it lies"},
    {"depth_mm", "mm", "deepest the tip has been below the occlusal opening"},
    {"x_mm", "mm", "tip, mesial"},
    {"y_mm", "mm", "tip, buccal"},
    {"z_mm", "mm", "tip, occlusal"},
    {"force_n", "N", "force on the hand"},
    {"peak_force_n", "N", "largest so far"},
    {"pedal", "", "0 released to 1 pressed"},
    {"rpm", "1/min", "speed of the handpiece"},
    {"contact", "", "1 while the point touches the tooth"},
    {"cutting", "", "1 while it turns in contact"},
    {"point", "", "which point of the tray is mounted, 0 the first"},
    {"button_1", "", "1 while held"},
    {"button_2", "", "1 while held"},
    {"perforated", "", "1 once a tissue under perforation.faults was touched"},
}};

/// Measures a criterion may use.
inline constexpr std::array<NamedQuantity, 65> k_metrics{{
    {"target_removed_percent", "%", "of the target's volume"},
    {"missed_mm3", "mm3", "target left standing"},
    {"removed_mm3", "mm3", "all tissue removed"},
    {"outside_mm3", "mm3", "removed outside target, leeway and container, what is protected included"},
    {"protected_mm3", "mm3", "removed of what is protected, wherever it lies"},
    {"dice", "", "agreement of removed and target, 1 = equal"},
    {"leeway_sides_mm3", "mm3", "removed in the leeway beside the target"},
    {"leeway_bottom_mm3", "mm3", "removed in the leeway below the target"},
    {"container_sides_mm3", "mm3", "damage beside the target"},
    {"container_bottom_mm3", "mm3", "damage below the target"},
    {"container_mm3", "mm3", "damage beside and below the target"},
    {"overcut_mm3", "mm3", "everything removed beyond target and leeway"},
    {"mesial_mean_mm", "mm", "mean deviation of the wall, + = overcut"},
    {"mesial_p95_mm", "mm", "95th percentile of the wall's deviation"},
    {"mesial_max_over_mm", "mm", "largest overcut of the wall"},
    {"mesial_max_under_mm", "mm", "largest thickness left standing"},
    {"distal_mean_mm", "mm", "mean deviation of the wall, + = overcut"},
    {"distal_p95_mm", "mm", "95th percentile of the wall's deviation"},
    {"distal_max_over_mm", "mm", "largest overcut of the wall"},
    {"distal_max_under_mm", "mm", "largest thickness left standing"},
    {"buccal_mean_mm", "mm", "mean deviation of the wall, + = overcut"},
    {"buccal_p95_mm", "mm", "95th percentile of the wall's deviation"},
    {"buccal_max_over_mm", "mm", "largest overcut of the wall"},
    {"buccal_max_under_mm", "mm", "largest thickness left standing"},
    {"lingual_mean_mm", "mm", "mean deviation of the wall, + = overcut"},
    {"lingual_p95_mm", "mm", "95th percentile of the wall's deviation"},
    {"lingual_max_over_mm", "mm", "largest overcut of the wall"},
    {"lingual_max_under_mm", "mm", "largest thickness left standing"},
    {"floor_mean_mm", "mm", "mean deviation of the floor, + = too deep"},
    {"floor_p95_mm", "mm", "95th percentile of the floor's deviation"},
    {"floor_max_over_mm", "mm", "largest excess depth"},
    {"floor_max_under_mm", "mm", "largest thickness left standing"},
    {"side_walls_max_over_mm", "mm", "largest overcut of the four side walls"},
    {"side_walls_max_under_mm", "mm", "largest thickness left standing at the four side walls"},
    {"side_walls_p95_mm", "mm", "largest 95th percentile of the four side walls"},
    {"walls_max_over_mm", "mm", "largest overcut of all walls and the floor"},
    {"walls_max_under_mm", "mm", "largest thickness left standing at all walls and the floor"},
    {"outline_width_mm", "mm", "buccal to lingual, at the surface"},
    {"outline_length_mm", "mm", "mesial to distal, at the surface"},
    {"outline_width_error_mm", "mm", "difference from the target's"},
    {"outline_length_error_mm", "mm", "difference from the target's"},
    {"depth_mm", "mm", "deepest point below the occlusal opening"},
    {"depth_error_mm", "mm", "difference from the target's"},
    {"taper_deg", "deg", "opening of the side walls towards the occlusal side"},
    {"taper_error_deg", "deg", "difference from the target's"},
    {"overhang_mm3", "mm3", "roof of the target left above what the task opens (perforation.aims)"},
    {"canals_covered_percent", "%", "of the canals' mouths, under hard tissue left on the straight line out"},
    {"floor_cut_mm3", "mm3", "hard tissue removed below the target"},
    {"time_s", "s", "until the exam ended"},
    {"handpiece_time_s", "s", "with the handpiece turning"},
    {"idle_s", "s", "neither moving nor cutting"},
    {"path_mm", "mm", "way of the tip"},
    {"force_mean_n", "N", "while cutting"},
    {"force_peak_n", "N", "largest on the hand"},
    {"force_over_limit_s", "s", "above force_limit_n"},
    {"perforated", "", "1 when a tissue under perforation.faults was touched"},
    {"perforation_volume_mm3", "mm3", "removed of the tissues under perforation.faults"},
    {"perforation_events", "", "faulty breakthroughs seen in the force"},
    {"touched_enamel_mm3", "mm3", "enamel removed"},
    {"touched_dentin_mm3", "mm3", "dentin removed"},
    {"touched_pulp_mm3", "mm3", "pulp removed"},
    {"touched_periodontium_mm3", "mm3", "periodontium touched"},
    {"steps_completed", "", "steps done"},
    {"steps_failed", "", "steps failed"},
    {"violations", "", "a point that is not allowed, or a speed above max_rpm"},
}};

/// Unit of a measure; empty when unknown or without unit.
[[nodiscard]] constexpr std::string_view metric_unit(std::string_view name) noexcept {
  for (const auto& m : k_metrics)
    if (m.name == name) return m.unit;
  return {};
}

/// Whether more (1) or less (-1) of a measure is better; 0 where that depends on the task.
[[nodiscard]] constexpr int better_direction(std::string_view metric) noexcept {
  for (const std::string_view name : {"target_removed_percent", "dice", "steps_completed"})
    if (metric == name) return 1;
  for (const std::string_view name : {"removed_mm3", "outline_width_mm", "outline_length_mm", "depth_mm", "taper_deg", "force_mean_n"})
    if (metric == name) return 0;
  if (metric.ends_with("_mean_mm") || metric.ends_with("_p95_mm") || metric.starts_with("touched_")) return 0;
  return -1;
}

}  // namespace cavum
