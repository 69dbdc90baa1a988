// Cusps, ridges, fissures and pits of a crown, found in its map of heights. Everything here is in
// the crown's frame (crown_frame.h), mm.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/tooth/anatomy/groove.h"
#include "engine/tooth/anatomy/height_map.h"
#include "engine/tooth/anatomy/landmarks.h"
#include "engine/tooth/anatomy/occlusal_table.h"

namespace cavum {

inline constexpr double k_cusp_scale_mm =
    0.25;  ///< cusps are looked for in heights smoothed by this
inline constexpr double k_fissure_scale_mm = 0.15;  ///< fissures, ridges and the table in these
inline constexpr double k_cusp_mm = 0.15;           ///< least prominence of a cusp
inline constexpr double k_worn_cusp_mm =
    0.05;  ///< and of one on a side of the table that has no other: worn, or small
inline constexpr double k_table_mm = 0.06;  ///< least depth of a hollow of the table below its rim
inline constexpr double k_fissure_per_mm = 0.5;  ///< least curvature across a fissure

/// The same map at both scales.
struct CrownMaps {
  HeightMap raw, cusps, fissures;
};

struct OcclusalMarks {
  std::vector<CuspTip> cusps;
  Polyline table;
  std::vector<Polyline> cusp_ridges;
  MarginalRidge mesial, distal;
  Polyline central_fissure;
  std::vector<Polyline> branches;
  std::optional<Vec3> mesial_pit, central_pit, distal_pit;
  std::vector<Message> notes;
};

/// Cusps of a crown with or without a table, named by their place; only peaks above `least_z`
/// count.
[[nodiscard]] std::vector<CuspTip> find_cusps(const CrownMaps& maps,
                                              const std::optional<OcclusalTable>& table,
                                              double least_z, std::vector<Message>& notes);

/// Cells of a crown's table that are its lowest: along the groove, clear of the ridges; where there
/// is none, hollows of k_table_mm and more.
[[nodiscard]] std::vector<int> lowest_of_table(const CrownMaps& maps,
                                               const std::optional<Groove>& groove);

/// The table's edge and what lies on it: fills `table`, `cusp_ridges` and, where a groove passes
/// over them, the marginal ridges from `marks.cusps`.
void find_ridges(const CrownMaps& maps, const OcclusalTable& table,
                 const std::optional<Groove>& groove, OcclusalMarks& marks);

/// Fissures and pits, once the ridges are known.
void find_fissures(const CrownMaps& maps, const OcclusalTable& table,
                   const std::optional<Groove>& groove, OcclusalMarks& marks);

/// From mesial to distal along the highest places of a front tooth's edge, down to 0.7 mm below its
/// highest place.
[[nodiscard]] Polyline find_incisal_edge(const CrownMaps& maps);

}  // namespace cavum
