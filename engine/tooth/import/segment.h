// From gray to tissues, at the volume's own voxels, by rules that do not depend on the scanner's
// gray values.
//
// 1. Hard tissue is brighter than the dentin threshold; its largest connected body is the tooth.
// 2. The outside is what a ball of k_cap_mm radius reaches from the volume's border without
// touching hard tissue
//    (and what lies within a ball's radius of where it got to). So the canals of roots that are
//    broken short stay closed. What is neither hard nor outside and connected to nothing larger is
//    pulp; dark or not does not matter.
// 3. Partial volumes put a rim of dentin's gray around the enamel. A voxel of dentin's gray within
// k_rim_voxels of
//    the outside takes the tissue of the nearest voxel that is enamel by its gray, or dentin and
//    deeper than that: the skin is what lies beneath it.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "engine/tooth/import/read_volume.h"
#include "engine/tooth/import/thresholds.h"
#include "engine/tooth/tissue_grid.h"

namespace cavum {

inline constexpr double k_cap_mm =
    0.55;  ///< radius: wider than a canal, narrower than the space between roots
inline constexpr double k_rim_voxels = 2.5;

/// Tissues at the voxels, and smooth fields between them.
struct Segmentation {
  IVec3 size;
  std::vector<std::uint8_t> tissue;  ///< TissueId per voxel
  std::vector<float> solid;          ///< > 0 in enamel and dentin; its zero is the solid surface
  std::array<std::uint64_t, 256> voxels{};  ///< per tissue
  std::uint64_t pulp_bodies = 0;            ///< connected bodies of pulp
  double rim_percent = 0.0;  ///< share of the enamel's outer voxels that a dentin voxel covers
  std::uint64_t specks = 0, pores = 0;  ///< loose specks ignored, voxels of pores filled
};

/// Segments a CT volume. Throws Error naming `where` when no tooth or no pulp is found.
[[nodiscard]] Segmentation segment(const Volume& volume, const GrayLevels& levels,
                                   const std::string& where);

/// Takes a label map as it is: `meaning` gives the tissue id (air too) of every label; 0 is air
/// unless it says otherwise. Throws Error listing labels without a meaning.
[[nodiscard]] Segmentation from_labels(const Volume& labels,
                                       const std::map<int, std::uint8_t>& meaning,
                                       const std::string& where);

/// Reads "1=enamel,2=dentin,3=pulp" (also `air`). Throws Error naming the part it cannot read.
[[nodiscard]] std::map<int, std::uint8_t> parse_label_map(const std::string& text);

/// Indicator of a tissue, smoothed over the 27 neighbours (1-2-1 along each axis), 0..1.
[[nodiscard]] std::vector<float> smoothed_indicator(const Segmentation& s, std::uint8_t tissue);

}  // namespace cavum
