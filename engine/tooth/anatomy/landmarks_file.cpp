#include "engine/tooth/anatomy/landmarks_file.h"

#include <array>

#include "engine/base/json_reader.h"
#include "engine/base/json_struct.h"

namespace cavum {

std::array<std::string_view, 5> names_of(ToothClass) {
  return {name_of(ToothClass::unknown), name_of(ToothClass::incisor), name_of(ToothClass::canine),
          name_of(ToothClass::premolar), name_of(ToothClass::molar)};
}

// What is kept.
// clang-format off
CAVUM_JSON_OF(CuspTip, (name), (tip_mm), (prominence_mm))
CAVUM_JSON_OF(CanalOpening, (at_mm), (radius_mm))
void json_fields(auto& of, JsonOf<Landmarks> auto& self) {
  of("tooth_class", self.tooth_class.kind);
  of("axis_through_mm", self.long_axis.through_mm), of("axis_occlusal", self.long_axis.occlusal), of("axis_tilt_deg", self.long_axis.tilt_deg);
  of("mesial_ridge_crest_mm", self.mesial_ridge.crest_mm), of("mesial_ridge_lowest_mm", self.mesial_ridge.lowest_mm);
  of("distal_ridge_crest_mm", self.distal_ridge.crest_mm), of("distal_ridge_lowest_mm", self.distal_ridge.lowest_mm);
  CAVUM_NAMES((cusps), (cusp_ridges), (central_fissure_mm), (fissure_branches_mm), (mesial_pit_mm), (central_pit_mm), (distal_pit_mm),
              (incisal_edge_mm), (occlusal_table_mm), (height_of_contour_mm), (neck_mm), (pulp_horns_mm), (chamber_roof_mm), (chamber_floor_mm),
              (canal_mouths), (apices_mm), (moved))
}
// clang-format on

namespace {

constexpr double k_furthest_landmark_mm = 1000.0;
constexpr std::size_t k_max_landmark_points = 20'000;
constexpr JsonLimits k_landmark_json{8U << 20, 400'000, 8};

}  // namespace

std::string landmarks_text(const Landmarks& landmarks) {
  return to_json_value(landmarks).dump();
}  // the shortest digits that give each double back

Landmarks parse_landmarks(std::string_view text, const std::string& where) {
  return json_value_of<Landmarks>(
      parse_json(text, where, k_landmark_json),
      {.where = where,
       .advice = msg("the file was changed or is damaged: use the original"),
       .most_elements = k_max_landmark_points,
       .largest = k_furthest_landmark_mm});
}

}  // namespace cavum
