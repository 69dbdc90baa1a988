#include "engine/physics/servo/recession.h"

#include <algorithm>

#include "engine/physics/contact/tuning.h"

namespace cavum {

using namespace tuning;

namespace {

// The distance field is cut wider than the head by a clearance of 0.01 leaf and more
// (carve_head.cpp): the proxy may go ahead by that.

/// What is pending when a proxy comes back to where the head was carved, mm, at most 0: the hole is
/// a clearance deeper than the head was.
double pending_at_touch_mm(const ContactState& contact, const CarvedHead& carved,
                           double leaf_mm) noexcept {
  if (carved.bur != contact.bur) return 0.0;
  const Vec3 offset = carved.tip_mm - contact.proxy_mm;
  const double deeper_mm = dot(offset, contact.normal);
  const bool there = length(offset - contact.normal * deeper_mm) <= k_same_hole_leaves * leaf_mm;
  return there ? -std::clamp(deeper_mm, 0.0, k_max_ahead_leaves * leaf_mm) : 0.0;
}

}  // namespace

double carve_step_mm(double leaf_mm) noexcept {
  return std::max(k_step_leaves * leaf_mm, k_min_step_mm);
}

void follow_recession(const ContactState& contact, const ContactResult& found, bool was_touching,
                      const CarvedHead& carved, double leaf_mm, Recession& state) noexcept {
  // A proxy that only slides takes nothing off: its normal is within a degree of the surface's,
  // which over 2 mm would add up to half a leaf.
  if (!found.touching)
    state.pending_mm = 0.0;
  else if (!was_touching)
    state.pending_mm = pending_at_touch_mm(contact, carved, leaf_mm);
  else if (state.followed_edit != contact.gathered.edit)
    state.pending_mm = std::max(state.pending_mm + dot(found.moved_mm, found.normal),
                                -k_max_ahead_leaves * leaf_mm);
  if (!found.still_moving) state.followed_edit = contact.gathered.edit;
}

void gather_recession(double speed_mm_s, double dt_s, double leaf_mm, Recession& state) noexcept {
  state.pending_mm =
      std::min(state.pending_mm + speed_mm_s * dt_s, k_max_pending_steps * carve_step_mm(leaf_mm));
}

CarvedHead receded(CarvedHead head, Vec3 normal, double pending_mm) noexcept {
  head.tip_mm = head.tip_mm - normal * std::max(0.0, pending_mm);
  return head;
}

}  // namespace cavum
