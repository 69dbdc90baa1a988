// Where the stylus stands beside the tooth: a rigid transform from the device's own frame to the
// tooth's. What is recorded is the tooth's frame, so that a session says nothing about the table on
// which it was made.
#pragma once

#include <vector>

#include "engine/base/pose.h"

namespace cavum {

/// tooth = rotation · device + offset_mm. A length is a length: nothing is enlarged.
struct Placement {
  Quat rotation;
  Vec3 offset_mm;
  /// From the tool's frame to the tooth's, for a device that knows no direction. The default holds
  /// the handpiece upright.
  Quat tool;
};

/// Tip and direction in the tooth frame, of a device that knows its place alone.
[[nodiscard]] Pose to_tooth(const Placement& placement, Vec3 device_mm) noexcept;
/// The same of one that measures `tool_to_device`, unit.
[[nodiscard]] Pose to_tooth(const Placement& placement, Vec3 device_mm,
                            Quat tool_to_device) noexcept;
/// A force in the tooth frame, as the device must give it.
[[nodiscard]] Vec3 force_to_device(const Placement& placement, Vec3 tooth_n) noexcept;

/// The rotation `first`, then `then`.
[[nodiscard]] Quat turned(Quat first, Quat then) noexcept;
/// Of an orthonormal matrix given by its columns, which need be so to 1e-3 only.
[[nodiscard]] Quat rotation_of(Vec3 column_x, Vec3 column_y, Vec3 column_z) noexcept;

/// In front of the candidate, who looks at the tooth with mesial to the right and buccal away,
/// `middle_mm` of the device at the crown's middle: of a device whose x points to the right, y up
/// and z towards the candidate.
[[nodiscard]] Placement upright_device(Vec3 middle_mm) noexcept;

struct PlacementFit {
  Placement placement;
  double rms_mm = 0.0, worst_mm = 0.0;  ///< what is left between the marks
};
/// The placement that brings each mark of the device closest to its place at the tooth, in the mean
/// of squares (Horn 1987: the largest eigenvector of a 4x4 matrix). Throws Error unless there are
/// three or more marks, as many in both, not on a line, 5 mm or more apart.
[[nodiscard]] PlacementFit fit_placement(const std::vector<Vec3>& device_mm,
                                         const std::vector<Vec3>& tooth_mm);

}  // namespace cavum
