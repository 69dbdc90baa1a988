// The colours of sections, told apart with every common colour blindness, for the pictures and the
// keys to them.
#pragma once

#include <cstdint>
#include <string>

#include "engine/tooth/tissues.h"
#include "scenarios/zones/zone_map.h"

namespace cavum::scenarios {

struct Palette {
  const char* KnownTissue::*tissue;  ///< which of a tissue's colours
  const char *removed, *leeway, *overcut;
  const char *target_line, *leeway_line, *container_line, *guard_line;
  double line_px;
};
/// Tissues pale, findings strong; or for candidates who need stronger contrasts: light and dark
/// alone tell the tissues apart.
[[nodiscard]] const Palette& palette_of(bool high_contrast);
/// For what many did: the tissues recede.
[[nodiscard]] const Palette& grey_palette();

[[nodiscard]] const char* tissue_colour(const Palette& colours, std::uint8_t tissue);
/// Of what was removed in a zone.
[[nodiscard]] const char* finding_colour(const Palette& colours, Zone zone);
/// Of a share of a class, per cent: + removed outside the target, - left inside it; "" below
/// k_min_heat_percent.
[[nodiscard]] const char* heat_colour(double percent);
inline constexpr double k_min_heat_percent = 5;

}  // namespace cavum::scenarios
