// Names of the live quantities that an instructor may use in conditions. One record each, so that
// parser, runner and advice cannot disagree. The measures of rubrics are in measures.h.
#pragma once

#include <array>
#include <string_view>

#include "scenarios/file/extent.h"

namespace cavum::scenarios {

struct LiveQuantity {
  std::string_view name, unit, meaning;
  const Most* most = nullptr;  ///< where its values end, from 0 on; null: nothing is known of that
};

/// Live quantities of step conditions, in the order of Runner's value table. Besides these, every
/// tissue NAME has `touched_NAME`, the volume of it removed so far, mm3.
inline constexpr std::array<LiveQuantity, 22> k_live_quantities{{
    {"time_s", "s", "since the exam began", &most::limit},
    {"step_time_s", "s", "since this step began", &most::step},
    {"target_removed_percent", "%", "of the target's volume", &most::percent},
    {"removed_mm3", "mm3", "all tissue removed", &most::tooth},
    {"leeway_mm3", "mm3", "removed in the leeway", &most::leeway},
    {"container_mm3", "mm3", "removed in the container (damage)", &most::container},
    {"outside_mm3", "mm3",
     "removed outside target, leeway and container, what is protected included", &most::tooth},
    {"protected_mm3", "mm3", "removed of what is protected, wherever it lies", &most::guarded},
    {"depth_mm", "mm", "deepest the tip has been below the occlusal opening"},
    {"x_mm", "mm", "tip, mesial"},
    {"y_mm", "mm", "tip, buccal"},
    {"z_mm", "mm", "tip, occlusal"},
    {"force_n", "N", "force on the hand", &most::no_end},
    {"peak_force_n", "N", "largest so far", &most::no_end},
    {"pedal", "", "0 released to 1 pressed", &most::one},
    {"rpm", "1/min", "speed of the handpiece", &most::rpm},
    {"contact", "", "1 while the bur touches the tooth", &most::one},
    {"cutting", "", "1 while it turns in contact", &most::one},
    {"bur", "", "which bur of the tray is mounted, 0 the first", &most::last_bur},
    {"button_1", "", "1 while held", &most::one},
    {"button_2", "", "1 while held", &most::one},
    {"perforated", "", "1 once a tissue under perforation.faults was touched", &most::fault},
}};

}  // namespace cavum::scenarios
