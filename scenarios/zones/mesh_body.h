// A closed triangle surface as a body. Inside is what the surface winds around (so cavities of the
// mesh are outside, and bodies that overlap are one); near the surface the distance is that to the
// triangles themselves, at the leaves' centres.
#pragma once

#include <vector>

#include "engine/tooth/surface_mesh.h"
#include "scenarios/zones/shape.h"

namespace cavum::scenarios {

class MeshBody final : public Shape {
 public:
  /// `mesh` is closed, its faces look outwards, no coordinate beyond 200 mm (see surface_files.h).
  /// Where it leaves the tooth's box it is cut off.
  MeshBody(const Tooth& tooth, const TriangleMesh& mesh);
  /// Exact at leaf centres up to k_exact_leaves from the surface, where further away only the sign
  /// counts; between centres interpolated.
  [[nodiscard]] double distance_mm(Vec3 p) const noexcept override;
  static constexpr double k_exact_leaves = 4;

 private:
  TissueGrid lattice_;  // size, leaf and origin alone
  std::vector<float> value_mm_;
};

/// Counts what MeshBody will do with this surface: the leaves of its box, and for each triangle
/// those near it. Throws Error beyond a limit.
void count_mesh_body(const Tooth& tooth, const TriangleMesh& mesh, ZoneWork& work);

}  // namespace cavum::scenarios
