// Gray volumes and label maps from files: MetaImage, NRRD, NIfTI, DICOM (a file of several frames,
// or a folder), TIFF (a file of several pages, or a folder), PNG (a folder). ITK reads them, in a
// process of its own (`cavum-read-volume`) with limits to its time and memory: damaged files make
// its libraries abort, spin or fill the memory. What ITK lets pass is checked there, too: data that
// are too short, series with a hole, slices that differ.
#pragma once

#include <optional>
#include <string>

#include "engine/tooth/volume/volume.h"

namespace cavum {

/// The voxel edge assumed when a file has none and the user gives none: usual for micro-CT of whole
/// teeth.
inline constexpr double k_assumed_spacing_mm = 0.125;

/// Reads a file or folder. `spacing_mm` overrides the file's. A spacing that is missing, not
/// positive, or exactly 1,1,1 (what every format writes when it knows none) becomes
/// k_assumed_spacing_mm and is marked as assumed. Throws Error naming file and place: missing, not
/// a volume, data shorter than the header says, a DICOM series with a hole or with several series,
/// gray values that are not finite, more voxels, time or memory than volume_limits.h allows.
[[nodiscard]] Volume read_volume(const std::string& path, const std::optional<Vec3>& spacing_mm);

/// The program that reads: $CAVUM_READ_VOLUME, else `cavum-read-volume` beside the running program.
/// Throws Error when it is not there.
[[nodiscard]] std::string read_volume_program();

}  // namespace cavum
