// What a task leaves over the pulp: as it is planned, and as its rubric asks for.
#pragma once

#include "engine/tooth/tooth.h"
#include "scenarios/zones/zone_map.h"

namespace cavum::scenarios {

// A cavity's floor leaves 0.8 mm over the pulp where it is planned, and a candidate 0.5 mm: with
// less the pulp is injured (Murray, Smith, Windsor and Mjör, Int Endod J 2003; 36: 33, recalled).
// What is planned and what fails lie a careful hand's overcut apart.
inline constexpr double k_planned_over_pulp_mm = 0.8, k_min_over_pulp_mm = 0.5;

/// From the target to the pulp where they are nearest, mm; 2 mm and more is 2. Known to a leaf.
[[nodiscard]] double planned_over_pulp_mm(const Tooth& tooth, const ZoneMap& zones);

}  // namespace cavum::scenarios
