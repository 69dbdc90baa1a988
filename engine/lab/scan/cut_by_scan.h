// What was drilled away, by the surface that was left: the tooth's leaves that lie outside a
// prepared scan although they were tissue, and the octree without them, its distances those of the
// scan.
#pragma once

#include <string>
#include <vector>

#include "engine/lab/scan/outer_surface.h"

namespace cavum {

/// A piece that was not taken for removed although it may be.
struct ThinPiece {
  Vec3 at_mm;  ///< a leaf of it
  double deep_mm = 0.0, mm3 = 0.0;
};
struct ScanCut {
  Octree after;
  std::vector<RemovedLeaf> removed;
  int cavities = 0;                ///< connected pieces that were removed
  double unseen_mm3 = 0.0;         ///< of the tooth below where the scan ends: it counts as it was
  double left_as_noise_mm3 = 0.0;  ///< pieces too thin or too small to be told from noise
  int left_as_noise = 0;
  std::vector<ThinPiece> apart;  ///< nowhere thicker than 0.3 mm and not joined to the largest
                                 ///< piece: a nick, or a place where two meshes differ
};

/// Whether a thin piece apart from the largest one stays, named, or goes as all others do.
enum class ThinApart { stays, goes };

/// Removed is a leaf of the tooth outside the scan, where the scan lies more than `noise_mm` deeper
/// than the tooth's surface did, in a piece that is somewhere thicker than 0.1 mm and larger than
/// 0.02 mm³, or thicker than twice `noise_mm` and larger than 0.05 mm³. A piece that the scan
/// bounds from above, as a base or a cut through the neck does the root, is not seen and stays. So
/// does a thin piece apart from the largest one: `apart` names it. `scan`: in the tooth's frame,
/// its faces outwards; `caps`: what closes its rims. Throws Error(`where`, ...) where the cavity
/// runs below the end of the scan, and where no inside is left.
[[nodiscard]] ScanCut cut_by_scan(const TriangleMesh& scan, const TriangleMesh& caps,
                                  const OuterSurface& tooth, double noise_mm,
                                  const std::string& where, ThinApart thin = ThinApart::stays);

}  // namespace cavum
