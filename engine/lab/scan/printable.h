// A tooth as one closed surface that can be printed: the outside and the cavity as it was left,
// pulp filled.
#pragma once

#include "engine/tooth/surface_mesh.h"
#include "engine/tooth/tooth.h"

namespace cavum {

struct Printable {
  TriangleMesh mesh;  ///< closed, one part, faces outwards
  double volume_mm3 = 0.0;
  std::size_t left_out = 0;  ///< other parts: crumbs that drilling cut off, hollows inside
  double left_out_mm3 = 0.0;
};

/// `around`: tissues_around_tooth of the unprepared tooth. Throws Error when nothing is left.
[[nodiscard]] Printable printable_surface(const Tooth& tooth, const std::array<bool, 256>& around);

}  // namespace cavum
