// Gray levels of a tooth in a CT volume, found without being told. Partial volumes smear the
// histogram between the tissues, so only voxels whose neighbours are alike are counted; the tissues
// then stand as clear peaks.
#pragma once

#include <optional>
#include <string>

#include "engine/tooth/import/read_volume.h"
#include "engine/tooth/tooth_source.h"

namespace cavum {

/// Where one tissue ends and the next begins, in the volume's gray.
struct GrayLevels {
  double hard = 0;    ///< dentin above, medium or pulp below
  double enamel = 0;  ///< enamel above, dentin below
  double enamel_surface =
      0;  ///< half way from the medium to enamel: where enamel's outer surface lies
  double pulp_surface = 0;  ///< half way from the pulp to dentin: where the pulp's wall lies
  std::optional<double>
      dark;  ///< pulp below, medium above; only where the pulp is darker than the medium
  std::optional<GrayPeaks> peaks;  ///< as they were found; none: both thresholds were given
};

/// What the user may say instead.
struct ThresholdOptions {
  std::optional<double> enamel, dentin;
};

/// Throws Error when thresholds are not given and fewer than two hard peaks (dentin, enamel) stand
/// out above the medium, or when the given ones are in the wrong order. `where` names the file.
[[nodiscard]] GrayLevels find_gray_levels(const Volume& volume, const ThresholdOptions& options,
                                          const std::string& where);

}  // namespace cavum
