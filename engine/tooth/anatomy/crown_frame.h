// The tooth's own frame, in which landmarks are looked for: its long axis upright, so that a tooth
// which stands askew in its file gives the same landmarks. Fixed by the tissues alone: the axis
// runs from the dentin's centroid to the enamel's.
#pragma once

#include <cstdint>
#include <string>

#include "engine/base/pose.h"
#include "engine/tooth/tooth.h"

namespace cavum {

/// Tissue ids by the names that importers and makers use; k_air where the tooth has no such tissue.
struct TissueIds {
  std::uint8_t enamel = k_air, dentin = k_air, pulp = k_air;
};
[[nodiscard]] TissueIds tissue_ids(const Tooth& tooth);

/// Origin: the enamel's centroid. Rows of `axes`: the tooth's +x and +y brought across the long
/// axis, and the long axis. All mm.
struct CrownFrame {
  Vec3 origin_mm;
  Mat3 axes;
  Vec3 enamel_low, enamel_high;  ///< box of the enamel, in this frame
  Vec3 solid_low, solid_high;    ///< box of all solid tissue, in this frame
  std::uint64_t enamel_leaves = 0, dentin_leaves = 0;
  bool own_axis = true;  ///< false: the tissues tell no axis, or one more than k_max_tilt_deg off;
                         ///< then it is the tooth frame's +z

  [[nodiscard]] Vec3 to_tooth(Vec3 p) const noexcept { return axes.transposed(p) + origin_mm; }
  [[nodiscard]] Vec3 from_tooth(Vec3 p) const noexcept { return axes * (p - origin_mm); }
};

/// The largest angle between the tooth frame's +z and a long axis that is believed: cos 25 degrees.
inline constexpr double k_min_axis_cosine = 0.9063;

/// A tooth without enamel gets a frame with `enamel_leaves` 0.
[[nodiscard]] CrownFrame crown_frame(const Tooth& tooth, const TissueIds& ids);

}  // namespace cavum
