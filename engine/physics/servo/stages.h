// The stages of a tick, in the order in which `step` takes them. Each changes the part of the state that is its own, reads what those before it
// found, and hands on what it found itself.
#pragma once

#include "engine/physics/servo/servo.h"

namespace cavum {

/// What one tick hands from stage to stage.
struct Tick {
  const TickInput& input;
  const ContactTool& tool;
  Pose device;                  ///< s, and the rotation
  Vec3 moved_mm;                ///< way of s since the tick before
  ContactResult contact{};      ///< |p − s| and n
  bool was_touching = false;    ///< in the tick before
  TouchedMeans means{};         ///< k, c and 1/τ
  double penetration_mm = 0.0;  ///< X
  double approach_mm = 0.0;     ///< way of s along −n in this tick
  TermsForce terms{};           ///< of the force model's terms

  [[nodiscard]] Viscoelastic tissue() const noexcept { return {means.of.stiffness_n_per_mm, means.of.damping_n_s_per_mm}; }
};

/// p = the place nearest to s that the tooth allows; n = (p − s)/|p − s|.
void solve_proxy(ServoState& state, Tick& tick) noexcept;
/// What a tool that lifts off still owes is carved where it was; then X = max(0, |p − s| − r).
void penetration(ServoState& state, Tick& tick) noexcept;
/// k, c and 1/τ: means over the area touched.
void tissue_mixture(const ServoModel& model, ServoState& state, Tick& tick) noexcept;
/// F = max(0, k X + c V + Σ tissue terms) along n, and the drag of the terms.
void model_force(const ServoModel& model, ServoState& state, Tick& tick, TickOutput& out) noexcept;
/// The same as a sampled device may be given it, N: k X + z + b V + Σ tissue terms, and drag through a spring.
[[nodiscard]] Vec3 render(const ServoModel& model, ServoState& state, const Tick& tick) noexcept;
/// r' = X/τ · rpm/rpm_ref, or by pressure (grinding.h); the head, moved on by r, is carved when enough has gathered.
void cut(const ServoModel& model, ServoState& state, const Tick& tick, TickOutput& out) noexcept;

}  // namespace cavum
