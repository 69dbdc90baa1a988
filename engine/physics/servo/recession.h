// Pending recession: by the law of cutting the surface has gone back further than it was carved, or
// than the proxy has followed. It grows by v = X/τ · rpm/rpm_ref and shrinks by what the proxy
// advances; so the surface recedes at exactly v·dt, whatever a single carve rounds.
#pragma once

#include <cstdint>

#include "engine/physics/contact/proxy.h"
#include "engine/physics/cutting/carve_head.h"

namespace cavum {

struct Recession {
  double pending_mm = 0.0;  ///< r, along the contact normal; below 0: the proxy went ahead by that
  std::uint64_t followed_edit = 0;  ///< edit hash of the tooth that the proxy has followed
  CarvedHead head;  ///< where it gathers: there it is carved when the tool lifts off
  Vec3 normal;      ///< contact normal there
};
CAVUM_STATE(Recession, pending_mm, followed_edit, head, normal)

/// Recession between two carves, mm: s_c = max(0.25 leaf, 0.025 mm).
[[nodiscard]] double carve_step_mm(double leaf_mm) noexcept;

/// After contact was found: `was_touching` is that of the tick before, `carved` the last complete
/// carve.
void follow_recession(const ContactState& contact, const ContactResult& found, bool was_touching,
                      const CarvedHead& carved, double leaf_mm, Recession& state) noexcept;

/// One tick of r' = `speed_mm_s`, at most three carves' worth.
void gather_recession(double speed_mm_s, double dt_s, double leaf_mm, Recession& state) noexcept;

/// A head moved on by `pending_mm` against the contact normal: what is to be carved.
[[nodiscard]] CarvedHead receded(CarvedHead head, Vec3 normal, double pending_mm) noexcept;

}  // namespace cavum
