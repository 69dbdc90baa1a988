// A bur as the catalogue lists it: its profile, and up to which height it is coated and cuts.
// Shapes and sizes ship in data/burs/, one TOML file each.
#pragma once

#include <algorithm>
#include <string>

#include "engine/physics/bur/head_field.h"
#include "engine/physics/bur/profile.h"

namespace cavum {

struct Bur {
  std::string name;               ///< file name without ending: "round-1.0"
  std::string title;              ///< for people
  double cutting_length_mm = 0;   ///< coated from the tip up to this height
  Profile profile;                ///< head, neck and shank
  double head_radius_mm = 0;      ///< largest radius of the coated part
  double smallest_radius_mm = 0;  ///< of the head's curvature: a ball end's, or the head's own
  double widest_from_mm = 0,
         widest_to_mm = 0;  ///< heights between which the head does not get narrower either way
  Profile head;             ///< the coated part alone, closed by a flat top
  HeadField field;          ///< its distance as a table: what cuts

  /// Signed distance, mm, to the coated head, in the tool frame, exact.
  [[nodiscard]] double head_distance_mm(Vec3 tool_mm) const noexcept {
    return std::max(head.distance_mm(tool_mm), tool_mm.z - cutting_length_mm);
  }
};

/// Reads `name, title, cutting_length_mm, profile = [{r_mm, z_mm, centre = [r, z]}, ...]` (centre
/// makes an arc). Throws Error(where:line:column, ...).
[[nodiscard]] Bur parse_bur(const std::string& text, const std::string& where);

}  // namespace cavum
