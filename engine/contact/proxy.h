// Surface-constrained proxy of the whole diamond point. The proxy is where the tooth lets the tool be:
// it follows the device without ever entering solid tissue, so a hard push cannot pop through and the
// normal cannot flip. X, the distance from the proxy to the device, is what the force is made of.
#pragma once

#include <vector>

#include "engine/base/pose.h"
#include "engine/base/reserved_vector.h"
#include "engine/contact/contact_tool.h"
#include "engine/contact/half_spaces.h"
#include "engine/tooth/octree.h"

namespace cavum {

/// Constants of one tissue as the contact averages them.
struct TissueConstants {
  double stiffness_n_per_mm = 0, damping_n_s_per_mm = 0;
  double recession_per_s = 0;  ///< 1/τ; 0 for void tissue
};

/// Means over the area touched, weighted by the area seen along the contact normal.
struct TouchedMeans {
  TissueConstants of;        ///< recession over the solid part only, where the coated head touches it
  bool touching = false;     ///< false: nothing touched, `of` is zero
  bool void_tissue = false;  ///< pulp or another void tissue lies before the head
};

/// Memory of the contact: the proxy, and until which travel each patch and sample is known to be in free air.
struct ContactState {
  Vec3 proxy_mm;
  Mat3 rotation;
  Vec3 normal;  ///< last contact normal, out of the tooth; zero before the first contact
  bool touching = false;
  int point = -1;        ///< diamond point that the arrays belong to
  double travel_mm = 0;  ///< how far any part of the tool has moved so far, an upper bound
  double tool_clear_until_mm = 0;
  std::vector<double> patch_clear_until_mm, patch_near_until_mm, sample_clear_until_mm;  ///< in units of travel
  double turned_mm = 0;                                                                  ///< part of the travel that came from rotation
  ReservedVector<HalfSpace> half_spaces;                                                 ///< about `gathered_mm`; room for one of each sample
  Vec3 gathered_mm;  ///< proxy when they were gathered; good for small moves of an unturned tool in an unchanged tooth
  double gathered_turned_mm = -1, gathered_reach_mm = 0;
  std::uint64_t gathered_edit = 0;
  TouchedMeans means;  ///< as long as neither tool, tooth nor normal changed much
  double means_turned_mm = -1;
  std::uint64_t means_edit = 0;
  Vec3 means_proxy_mm, means_normal;
  Octree::Cursor cursor;
};
[[nodiscard]] ContactState make_contact_state(const std::vector<ContactTool>& tray, Vec3 first_tip_mm);

/// What one tick of contact found.
struct ContactResult {
  bool touching = false;
  Vec3 normal;                ///< out of the tooth, from the device to the proxy
  double penetration_mm = 0;  ///< X, before any recession that the cutting still owes
  Vec3 moved_mm;              ///< how far the proxy moved
};

/// Moves the proxy towards `device`, at most 12 steps of one leaf in a tick near the tooth. Rotation follows the device.
ContactResult update_contact(const Octree& tooth, const ContactTool& tool, int point, const Pose& device, ContactState& state) noexcept;

/// A sample touches solid tissue within half a leaf, fading out linearly, and void tissue where its
/// surface has reached it; so k and c change continuously across every border. `tissue` has 256 entries.
[[nodiscard]] TouchedMeans touched_means(const Octree& tooth, const ContactTool& tool, const TissueConstants* tissue, ContactState& state) noexcept;

}  // namespace cavum
