// The servo: one `step(model, state, input) -> output` per tick. The model is constant, the state
// is plain data; the step reads no clock, allocates nothing, takes no lock and logs nothing, so the
// same inputs give the same bits on every machine.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/physics/bur/bur.h"
#include "engine/physics/contact/proxy.h"
#include "engine/physics/contact/touched_means.h"
#include "engine/physics/cutting/carve_head.h"
#include "engine/physics/force/force_model.h"
#include "engine/physics/force/rendering.h"
#include "engine/physics/force/safety.h"
#include "engine/physics/servo/handpiece.h"
#include "engine/physics/servo/recession.h"
#include "engine/physics/servo/servo_config.h"
#include "engine/physics/servo/tick.h"
#include "engine/physics/servo/tip_estimate.h"
#include "engine/tooth/tooth.h"

namespace cavum {

/// The version of the physics: a recording replays bit for bit under the version that made it.
inline constexpr int k_physics_version = 1;

/// Everything constant during an exam.
struct ServoModel {
  ServoConfig config;
  ForceModel force;
  std::vector<ContactTool> tray;              ///< burs ready for contact
  std::array<TissueConstants, 256> tissue{};  ///< by tissue id
  VoidMap voids;                              ///< of the intact tooth
};
/// Throws Error when a solid tissue has no material in the force model or the tray is empty.
[[nodiscard]] ServoModel make_servo_model(const Tooth& tooth, const std::vector<Bur>& tray,
                                          const ForceModel& force, const ServoConfig& config);

/// Everything that changes, by stages. Copy it to branch a simulation.
struct ServoState {
  Octree tooth;
  std::int64_t tick = 0;
  Handpiece handpiece;
  TipEstimate estimate;
  ContactState contact;
  TouchedMemory touched;
  Recession recession;
  RenderState render;
  TermsState terms;
  HeadCarving carving;
  SafetyState safety;
  std::uint64_t trace_hash = 0;         ///< over every record so far
  ReservedVector<RemovedLeaf> removed;  ///< of the last tick; capacity is reserved once
  ContactScratch scratch;
};
[[nodiscard]] ServoState make_servo_state(const ServoModel& model, const Tooth& tooth,
                                          Vec3 first_tip_mm);

/// One tick. After it `state.removed` holds the leaves removed.
TickOutput step(const ServoModel& model, ServoState& state, const TickInput& input) noexcept;

/// Over every bit of the state but the removed leaves and what the contact may ask the tooth again:
/// equal for equal histories.
[[nodiscard]] std::uint64_t state_hash(const ServoState& state) noexcept;

}  // namespace cavum
