// Lays a scan upon a tooth without any hand work, in any pose: many starts over all rotations, each
// drawn in by a coarse trimmed ICP on few points; the best by more of them; then point to plane
// against the octree's own distance, robust against what was drilled away. Sources: ICP, Besl and
// McKay, IEEE PAMI 14 (1992) 239; point to plane, Chen and Medioni, Image and Vision Computing 10
// (1992) 145; trimmed, Chetverikov et al., ICPR 2002; weights, Beaton and Tukey, Technometrics 16
// (1974) 147.
#pragma once

#include <optional>
#include <vector>

#include "engine/lab/scan/outer_surface.h"
#include "engine/lab/scan/rigid.h"

namespace cavum {

/// A pose of a scan in the tooth's frame, and how well it fits there.
struct ScanPose {
  Rigid to_tooth;
  double noise_mm =
      0.0;  ///< standard deviation of the surfaces' distance where they fit, by the median
  double share = 0.0;  ///< of the scan's area that lies within three of the least of these of the
                       ///< tooth, and faces the same way
};

struct Registration {
  ScanPose best;
  std::optional<ScanPose> second;  ///< the best of the poses that lie elsewhere: turned by 8
                                   ///< degrees or more, or moved by a millimetre
};

/// `scan`: its points, in any frame, mm, normals out of the tooth. The same scan gives the same
/// pose. None where no pose could be worked out: too few points near the tooth.
[[nodiscard]] std::optional<Registration> register_scan(const std::vector<SurfacePoint>& scan,
                                                        const OuterSurface& tooth);

}  // namespace cavum
