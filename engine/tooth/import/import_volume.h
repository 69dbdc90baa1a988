// A tooth from a CT volume or a label map: segmented at the volume's own voxels, then resampled
// into leaves of the tooth frame. The solid surface is the zero of a smooth field (cubic
// interpolation of the gray, or of smoothed labels), so that leaves smaller than a voxel show no
// steps.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "engine/tooth/import/frame.h"
#include "engine/tooth/import/sense.h"
#include "engine/tooth/import/thresholds.h"
#include "engine/tooth/tooth.h"

namespace cavum {

struct VolumeImportOptions {
  std::optional<Vec3> spacing_mm;  ///< overrides the file's
  ThresholdOptions thresholds;     ///< CT only; automatic where empty
  std::map<int, std::uint8_t>
      labels;  ///< not empty: the file is a label map, and this is what it means
  double leaf_mm = 0.05;
  double periodontium_mm = 1.0;  ///< 0 = none
  FrameOptions frame;
  SenseOptions sense;
};

struct VolumeImport {
  Tooth tooth;
  VoxelSpacing spacing;
  std::uint64_t native_enamel = 0, native_dentin = 0, native_pulp = 0;  ///< voxels of the file
  std::uint64_t pulp_bodies = 0;
  ToothSense sense;
  double rim_percent =
      0.0;  ///< share of the enamel's outer voxels covered by dentin; 0 for label maps
};

/// Throws Error as sense.h does; as read_volume, find_gray_levels and segment do; when enamel or
/// dentin is missing and no occlusal axis given; when a label map has enamel and dentin exchanged;
/// when the tooth would need more than 1024 leaves along an edge; and when an assumed spacing gives
/// no tooth's size.
[[nodiscard]] VolumeImport import_volume(const std::string& path,
                                         const VolumeImportOptions& options);

}  // namespace cavum
