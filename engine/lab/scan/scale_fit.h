// Whether a scan that does not fit is one of the same tooth in another size: a scanner that
// measures too large or too small, or a print that shrank. Point to plane as in register_scan.h,
// with the size as a seventh unknown (Umeyama, IEEE PAMI 13 (1991) 376, for pairs of points).
#pragma once

#include <optional>
#include <vector>

#include "engine/lab/scan/outer_surface.h"
#include "engine/lab/scan/rigid.h"

namespace cavum {

/// p -> to_tooth * (scale · p).
struct ScaledPose {
  double scale = 1.0;
  Rigid to_tooth;
};

/// From a pose near by. None where it runs away: the size changes by more than a quarter, or too
/// few points lie near the tooth.
[[nodiscard]] std::optional<ScaledPose> fit_with_scale(const std::vector<SurfacePoint>& scan,
                                                       const Rigid& near,
                                                       const OuterSurface& tooth);

/// The points in that size.
[[nodiscard]] std::vector<SurfacePoint> in_size(std::vector<SurfacePoint> points, double scale);

}  // namespace cavum
