// Removal of tissue by the coated head of a bur at one pose. How far the surface recedes is
// decided by the servo (v = X/τ · rpm/rpm_ref); here its shape becomes the shape of the head.
#pragma once

#include <vector>

#include "engine/base/pose.h"
#include "engine/base/state_hash.h"
#include "engine/physics/bur/bur.h"
#include "engine/tooth/octree.h"

namespace cavum {

/// A head at a pose in the tooth.
struct CarvedHead {
  Vec3 tip_mm;
  Mat3 rotation;
  int bur = -1;  ///< of the tray; -1 = none
};
CAVUM_STATE(CarvedHead, tip_mm, rotation, bur)

/// A carve is worked out over several ticks and made in the last of them.
struct HeadCarving {
  CarvedHead last;  ///< the last complete carve, to know what is done already
  CarvedHead now;   ///< the carve under way
  Octree::Plan plan;
  bool worked_out = false;  ///< the plan is complete
  double swept_mm = 0.0;    ///< path of the tool since `now` began; whoever moves it counts
  [[nodiscard]] bool under_way() const noexcept { return now.bur >= 0; }
};
/// The plan follows from the heads and the tooth: how far it has come is enough.
template <class Visit>
void each_member(Visit& visit, const HeadCarving& state) noexcept {
  const auto& [last, now, plan, worked_out, swept_mm] = state;
  visit(last, now, state.under_way() ? plan.progress() : 0, worked_out, swept_mm);
}

/// Begins to carve a head; what was under way is dropped.
void begin_carving(HeadCarving& carving, const CarvedHead& head) noexcept;
void drop_carving(HeadCarving& carving) noexcept;

enum class CarvingStep { under_way, done, no_room };
/// Work enough for any carve.
inline constexpr int k_at_once = 1 << 30;
/// Works `work` units (about 15 ns each, see Octree::plan) on the carve under way; when all is
/// worked out, the next call makes it: it turns every leaf inside the head to air and raises the
/// surface distance around it. Removed leaves are appended to `removed` within its capacity. With
/// `k_at_once` a single call does everything; a very large carve is otherwise made in parts. A head
/// that only moved on since the last carve is carved on its leading side alone: behind it nothing
/// can change, for all heads are convex. `no_room`: part of the head was not carved, and the
/// carving is over.
CarvingStep go_on_carving(HeadCarving& carving, Octree& tooth, const Bur& head, int work,
                          std::vector<RemovedLeaf>& removed) noexcept;

}  // namespace cavum
