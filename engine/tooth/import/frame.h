// The tooth frame of an imported tooth: +z occlusal, +x mesial, +y buccal: z cross x, or turned
// over (the mirror image) for a tooth whose handedness is the other one; origin at the middle of
// the enamel's box. What the files do not say is assumed by one rule and named in Tooth::source.
#pragma once

#include <optional>

#include "engine/base/pose.h"
#include "engine/tooth/tooth_source.h"

namespace cavum {

/// What the user may say about the frame. Directions are in the file's own frame; lengths do not
/// matter.
struct FrameOptions {
  std::optional<Vec3> occlusal_axis;  ///< default: from the dentin's centroid to the enamel's
  std::optional<Vec3> mesial_axis;    ///< default: the file's +x (+y when x is within 25 degrees of
                                      ///< the occlusal axis)
  bool mirror =
      false;  ///< +y is turned over: the tooth of the other side of the jaw, so that +y is buccal
  double rotate_deg =
      0.0;  ///< turns the mesial axis about the occlusal one, counter-clockwise seen from above
};

/// Rows (+y turned over where mirrored) are the tooth's axes in the file's frame, so that `axes *
/// v` carries a file vector into the tooth frame.
struct ToothAxes {
  Mat3 axes;
  SourceFrame source;  ///< which axes were given and which assumed
};

/// Throws Error when an axis is zero or not finite, or mesial and occlusal are parallel.
[[nodiscard]] ToothAxes tooth_axes(Vec3 dentin_centroid, Vec3 enamel_centroid,
                                   const FrameOptions& options);

}  // namespace cavum
