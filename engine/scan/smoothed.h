// A scan without its noise: every corner on the robust implicit moving-least-squares surface of all that lies around it, which averages what scatters
// and keeps edges. Source: Öztireli, Guennebaud and Gross, Computer Graphics Forum 28 (2009) 493 (RIMLS); its Gaussian weights of residual and normal
// are replaced by 1 / (1 + x²)², so that no libm is needed.
#pragma once

#include <vector>

#include "engine/scan/surface_points.h"

namespace cavum {

/// The mesh with every corner moved along the surface's normal. `points`: surface_points of `mesh`. A corner is moved by what lies within
/// `radius_mm`, with weights (1 - r²)⁴.
[[nodiscard]] TriangleMesh smoothed(const TriangleMesh& mesh, const std::vector<SurfacePoint>& points, double radius_mm);

}  // namespace cavum
