// A tooth from three closed surfaces: enamel, dentin, pulp. The meshes are turned into the tooth
// frame before they are filled, so nothing is resampled.
//
// The rule for overlaps and gaps, applied leaf by leaf:
//   1. A leaf belongs to the mesh that holds its centre; where several do: pulp before enamel
//   before dentin.
//      The pulp is exactly its mesh, and an overlap of the hard layers is enamel.
//   2. A leaf in no mesh is a gap, not outside, when it lies between two facing surfaces not more
//   than 2 leaves
//      apart in all (their directions opposed by more than 120 degrees), or when no way leads from
//      it to the outside. A gap goes to enamel or dentin, whichever surface is nearer (dentin when
//      equal).
// So no tissue is lost where layers touch, and no seam is left that the bur could feel.
#pragma once

#include <cstdint>
#include <string>

#include "engine/tooth/import/frame.h"
#include "engine/tooth/import/sense.h"
#include "engine/tooth/tooth.h"

namespace cavum {

struct MeshPaths {
  std::string enamel, dentin, pulp;
};

struct MeshImportOptions {
  double leaf_mm = 0.05;
  double periodontium_mm = 1.0;  ///< 0 = none
  FrameOptions frame;
  SenseOptions sense;
};

struct MeshImport {
  Tooth tooth;
  double mesh_enamel_mm3 = 0, mesh_dentin_mm3 = 0,
         mesh_pulp_mm3 = 0;  ///< volumes of the meshes themselves
  std::uint64_t overlap_leaves = 0, gap_leaves = 0, periodontium_leaves = 0;
  ToothSense sense;
};

/// Throws Error naming the file when a mesh cannot be read, is open, or the layers cannot be what
/// they are said to be (enamel and dentin exchanged, pulp not enclosed), and as sense.h does.
[[nodiscard]] MeshImport import_meshes(const MeshPaths& paths, const MeshImportOptions& options);

}  // namespace cavum
