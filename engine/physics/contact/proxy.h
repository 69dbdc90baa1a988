// Surface-constrained proxy of the whole bur. The proxy is where the tooth lets the tool be:
// it follows the device without ever entering solid tissue, so a hard push cannot pop through and
// the normal cannot flip. X, the distance from the proxy to the device, is what the force is made
// of.
#pragma once

#include <vector>

#include "engine/base/pose.h"
#include "engine/base/reserved_vector.h"
#include "engine/base/state_hash.h"
#include "engine/physics/contact/contact_tool.h"
#include "engine/physics/contact/half_spaces.h"
#include "engine/tooth/octree.h"

namespace cavum {

/// Half spaces about a place of the proxy: good for small moves of a tool that does not turn.
/// Cutting only takes tissue away, so that those from before a carve still hold, though they allow
/// less.
struct GatheredContact {
  ReservedVector<HalfSpace> half_spaces;  ///< one of each near sample, then refined ones
  ReservedVector<std::uint32_t> samples;  ///< of the first half spaces
  Vec3 at_mm;
  double turned_rad = -1.0, reach_mm = 0.0;
  std::uint64_t edit = 0;                         ///< edit hash of the tooth that they are about
  std::uint32_t next_patch = 0, next_sample = 0;  ///< of the tool, while they are being gathered
};
/// The half spaces follow from the rest: how many there are is enough.
template <class Visit>
void each_member(Visit& visit, const GatheredContact& state) noexcept {
  const auto& [half_spaces, samples, at_mm, turned_rad, reach_mm, edit, next_patch, next_sample] =
      state;
  visit(half_spaces.size(), samples.size(), at_mm, turned_rad, reach_mm, edit, next_patch,
        next_sample);
}

/// Where the last carve made room for the head, as the tool was turned then.
struct OpenedPosition {
  Vec3 tip_mm;
  double turned_rad = -1.0;  ///< ContactState::turned_rad then; -1 = there is none
};
CAVUM_STATE(OpenedPosition, tip_mm, turned_rad)

/// Up to which travel the tool, its patches and its samples are known to be in free air, or near
/// something. Travel is an upper bound of the path of a part of the tool: what the tip moved, and
/// what the tool turned times the part's lever.
struct Clearances {
  double tool_air_until_mm = 0.0, tool_near_until_mm = 0.0;
  std::vector<double> patch_clear_until_mm, patch_near_until_mm, sample_clear_until_mm;
};
CAVUM_NO_STATE(Clearances)  // what the tooth says may be asked again

/// What the stages of contact share within a tick, and what spares them work.
struct ContactScratch {
  int looked_up = 0;  ///< positions of the tooth that this tick asked for: what contact has cost
  Octree::Cursor cursor;
  std::vector<std::uint8_t> counted;  ///< by sample: was dealt with
};

/// Memory of the contact: the proxy, and what it was last held by.
struct ContactState {
  Vec3 proxy_mm;
  Mat3 rotation;
  Vec3 normal;  ///< last contact normal, out of the tooth; zero before the first contact
  bool touching = false;
  int bur = -1;                             ///< bur that the arrays belong to
  double moved_mm = 0.0, turned_rad = 0.0;  ///< of the tip and of the tool, so far
  double stride_mm = 0.0;                   ///< the longest next step of the proxy
  Vec3 last_step_mm;
  Clearances clear;
  GatheredContact gathered,
      coming;                ///< those in force, and those that a few ticks gather after a carve
  bool catching_up = false;  ///< the latter are being gathered
  OpenedPosition opened;     ///< set by whoever carves
  ActiveSet active;          ///< half spaces that held the last step
};
CAVUM_STATE(ContactState, proxy_mm, rotation, normal, touching, bur, moved_mm, turned_rad,
            stride_mm, last_step_mm, clear, gathered, coming, catching_up, opened, active)
[[nodiscard]] ContactState make_contact_state(const std::vector<ContactTool>& tray,
                                              Vec3 first_tip_mm);
[[nodiscard]] ContactScratch make_contact_scratch(const std::vector<ContactTool>& tray);

/// What one tick of contact found.
struct ContactResult {
  bool touching = false;
  bool still_moving = false;  ///< the proxy goes on in the next tick: it has not arrived
  bool in_air = false;  ///< nothing of the tooth, not even void tissue, near any part of the tool
  Vec3 normal;          ///< out of the tooth, from the device to the proxy
  double penetration_mm = 0;  ///< X, before any recession that is still pending
  Vec3 moved_mm;              ///< how far the proxy moved
};

/// Moves the proxy towards `device`, at most 12 steps of one leaf in a tick near the tooth. A step
/// that leads back the way the one before came shortens the stride; a tick with two of them ends
/// early, and the proxy goes on in the next. After a carve what touches is gathered anew over a few
/// ticks; then the proxy takes the way that was opened at once. Until then the half spaces from
/// before hold it: `state.gathered.edit` says which tooth it has followed. Rotation follows the
/// device.
ContactResult solve_proxy(const Octree& tooth, const ContactTool& tool, int bur, const Pose& device,
                          ContactState& state, ContactScratch& scratch) noexcept;

}  // namespace cavum
