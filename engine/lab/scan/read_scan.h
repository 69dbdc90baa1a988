// A scan as it comes from a file: the one surface in it, its faces outwards, where it ends and what
// holes it has.
#pragma once

#include <string>
#include <vector>

#include "engine/lab/scan/holes.h"
#include "engine/lab/scan/surface_points.h"

namespace cavum {

struct Scan {
  TriangleMesh mesh;  ///< mm, in the scanner's frame
  TriangleMesh caps;  ///< over all of its rims
  std::vector<SurfacePoint> points;
  double end_mm = 0.0;  ///< length of the longest rim: where the scan ends; 0: it is closed
  int holes = 0;        ///< other rims
  std::size_t parts_left_out = 0;  ///< small ones next to the tooth
  double left_out_percent = 0.0;   ///< of the surface
  bool faces_turned = false;       ///< they looked inwards
};

/// Reads an STL, PLY, OBJ or OFF file in units of `unit_mm` millimetres. Parts beside the largest
/// are left out where they are dust; faces that look inwards are turned. Throws Error naming the
/// file when it cannot be read, holds too few triangles, or has more or larger holes than a scan of
/// a tooth has.
[[nodiscard]] Scan read_scan(const std::string& path, double unit_mm);

/// The scan in a mirror, its faces outwards again.
[[nodiscard]] Scan mirrored(Scan scan);

}  // namespace cavum
