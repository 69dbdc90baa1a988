#include "engine/physics/servo/recession.h"

#include <algorithm>
#include <array>

#include "engine/base/hash.h"
#include "engine/physics/contact/tuning.h"

namespace cavum {

using namespace tuning;

namespace {

// The distance field is cut wider than the head by a clearance of 0.01 leaf and more (carve_head.cpp): the proxy may be paid for that in advance.

/// What a proxy owes that comes back to where the head was carved, mm, at most 0: the hole is a clearance deeper than the head was.
double owed_at_touch_mm(const ContactState& contact, const CarvedHead& carved, double leaf_mm) noexcept {
  if (carved.bur != contact.bur) return 0.0;
  const Vec3 way = carved.tip_mm - contact.proxy_mm;
  const double deeper_mm = dot(way, contact.normal);
  const bool there = length(way - contact.normal * deeper_mm) <= k_same_hole_leaves * leaf_mm;
  return there ? -std::clamp(deeper_mm, 0.0, k_max_ahead_leaves * leaf_mm) : 0.0;
}

}  // namespace

double carve_step_mm(double leaf_mm) noexcept { return std::max(k_step_leaves * leaf_mm, k_min_step_mm); }

void follow_recession(const ContactState& contact, const ContactResult& found, bool was_touching, const CarvedHead& carved, double leaf_mm,
                      Recession& state) noexcept {
  // A proxy that only slides pays nothing: its normal is within a degree of the surface's, which over 2 mm would add up to half a leaf.
  if (!found.touching)
    state.owed_mm = 0.0;
  else if (!was_touching)
    state.owed_mm = owed_at_touch_mm(contact, carved, leaf_mm);
  else if (state.followed_edit != contact.gathered.edit)
    state.owed_mm = std::max(state.owed_mm + dot(found.moved_mm, found.normal), -k_max_ahead_leaves * leaf_mm);
  if (!found.on_its_way) state.followed_edit = contact.gathered.edit;
}

void gather_recession(double speed_mm_s, double dt_s, double leaf_mm, Recession& state) noexcept {
  state.owed_mm = std::min(state.owed_mm + speed_mm_s * dt_s, k_max_owed_steps * carve_step_mm(leaf_mm));
}

CarvedHead receded(CarvedHead head, Vec3 normal, double owed_mm) noexcept {
  head.tip_mm = head.tip_mm - normal * std::max(0.0, owed_mm);
  return head;
}

std::uint64_t hash_of(const Recession& s, std::uint64_t seed) noexcept {
  const std::array<double, 7> real{s.owed_mm, s.head.tip_mm.x, s.head.tip_mm.y, s.head.tip_mm.z, s.normal.x, s.normal.y, s.normal.z};
  return fast_hash(&s.followed_edit, sizeof s.followed_edit, fast_hash(real.data(), sizeof real, seed));
}

}  // namespace cavum
