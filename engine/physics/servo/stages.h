// The stages of a tick, in the order in which `step` takes them. Each reads what those before it
// found, changes its own state, which is passed to it last, and returns what it found.
#pragma once

#include <optional>

#include "engine/physics/servo/servo.h"

namespace cavum {

/// What one tick hands from stage to stage.
struct Tick {
  const TickInput& input;
  const ContactTool& tool;
  Pose device;                ///< s, and the rotation
  Vec3 moved_mm;              ///< by how much s moved since the tick before
  bool was_touching = false;  ///< in the tick before
  ContactResult contact{};    ///< |p − s| and n
  double penetration_mm = 0;  ///< X
  double approach_mm = 0;     ///< by how much s moved along −n
  TouchedMeans means{};       ///< k, c and 1/τ
  TermsForce terms{};         ///< of the force model's terms

  [[nodiscard]] Viscoelastic tissue() const noexcept {
    return {means.of.stiffness_n_per_mm, means.of.damping_n_s_per_mm};
  }
};

/// Where a tool that lifts off has recession pending, to be carved there, or many short touches
/// would cut nothing; bur -1: nowhere.
[[nodiscard]] CarvedHead left_behind(const Tick& tick, double leaf_mm,
                                     const Recession& recession) noexcept;
/// X = max(0, |p − s| − r), mm. `carved` is the last complete carve.
[[nodiscard]] double penetration(const Tick& tick, const ContactState& contact,
                                 const CarvedHead& carved, double leaf_mm,
                                 Recession& recession) noexcept;
/// k, c and 1/τ: means over the area touched.
[[nodiscard]] TouchedMeans tissue_mixture(const ServoModel& model, const Octree& tooth,
                                          const Tick& tick, double rpm, const Recession& recession,
                                          const ContactState& contact, ContactScratch& scratch,
                                          TouchedMemory& touched) noexcept;
/// Forces of the model's terms, at approach speed V.
[[nodiscard]] TermsForce model_terms(const ServoModel& model, const ServoState& now,
                                     const Tick& tick, TermsState& terms) noexcept;
/// F = max(0, k X + c V + Σ tissue terms) along n, and the drag of the terms along n, N.
[[nodiscard]] double model_force(const Tick& tick, double speed_mm_s) noexcept;
/// The same as a sampled device may be given it, N: k X + z + b V + Σ tissue terms, and drag
/// through a spring.
[[nodiscard]] Vec3 render(const ServoModel& model, const ServoState& now, const Tick& tick,
                          RenderState& render) noexcept;

/// r grows by r' dt, r' = X/τ · rpm/rpm_ref, or by pressure (grinding.h).
void recede(const ServoModel& model, const Tick& tick, double rpm, double pressing_n,
            const ContactState& contact, double leaf_mm, Recession& recession) noexcept;
/// What a tick of carving did.
struct Carved {
  std::optional<OpenedPosition> opened{};  ///< a carve ended
  bool no_room = false;                    ///< and a part of it was not carved
};
/// The head, moved on by r, is carved when enough has gathered, a part of it in each tick; `left`
/// is carved first. Removed leaves are appended.
[[nodiscard]] Carved carve(const ServoModel& model, const Tick& tick, const CarvedHead& left,
                           const Recession& recession, const ContactState& contact, Octree& tooth,
                           ReservedVector<RemovedLeaf>& removed, HeadCarving& carving) noexcept;

}  // namespace cavum
