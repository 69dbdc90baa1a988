// A scan without its noise. Normals are averaged first, those alike more than others (Zheng, Fu, Au
// and Tai, IEEE TVCG 17 (2011) 1521); then every corner goes onto the robust implicit
// moving-least-squares surface of all that lies around it, which averages what scatters and keeps
// edges (Öztireli, Guennebaud and Gross, Computer Graphics Forum 28 (2009) 493). Gaussian weights
// are replaced by 1 / (1 + x²)²: no libm.
#pragma once

#include <vector>

#include "engine/lab/scan/surface_points.h"

namespace cavum {

/// The mesh with the corners that `wanted` names (one for each) moved along the surface's normal.
/// `points`: surface_points of `mesh`, all that lie within two radii of such corners. What lies
/// within `radius_mm` counts, with weights (1 - r²)⁴.
[[nodiscard]] TriangleMesh smoothed(const TriangleMesh& mesh,
                                    const std::vector<SurfacePoint>& points,
                                    const std::vector<std::uint8_t>& wanted, double radius_mm);

}  // namespace cavum
