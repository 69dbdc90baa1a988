// The servo: one `step(model, state, input) -> output` per tick. The model is constant, the state is
// plain data; the step reads no clock, allocates nothing, takes no lock and logs nothing, so the same
// inputs give the same bits on every machine.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/contact/proxy.h"
#include "engine/cutting/carve_head.h"
#include "engine/force/force_model.h"
#include "engine/force/rendering.h"
#include "engine/force/safety.h"
#include "engine/instrument/diamond_point.h"
#include "engine/servo/tick.h"
#include "engine/servo/tip_estimate.h"
#include "engine/tooth/tooth.h"

namespace cavum {

/// The version of the physics: a recording replays bit for bit under the version that made it.
inline constexpr int k_physics_version = 4;

/// Settings of the handpiece, the device and the tick. TOML text in a session: see `to_toml`.
struct ServoConfig {
  double tick_s = k_tick_s;
  double max_rpm = 200000.0;         ///< speed at a pedal pressed to the floor
  double spin_up_s = 0.15;           ///< time constant of the handpiece's speed
  double position_quantum_mm = 0.0;  ///< step of the device's encoder in the positions it reports; 0 = exact
  SafetyLimits limits;               ///< of the haptic device
};
[[nodiscard]] std::string to_toml(const ServoConfig& config);
/// Throws Error(where, ...) on anything missing, unknown or out of range.
[[nodiscard]] ServoConfig parse_servo_config(const std::string& text, const std::string& where);

/// Everything constant during an exam.
struct ServoModel {
  ServoConfig config;
  ForceModel force;
  std::vector<ContactTool> tray;              ///< diamond points ready for contact
  std::array<TissueConstants, 256> tissue{};  ///< by tissue id
  VoidMap voids;                              ///< of the intact tooth
};
/// Throws Error when a solid tissue has no material in the force model or the tray is empty.
[[nodiscard]] ServoModel make_servo_model(const Tooth& tooth, const std::vector<DiamondPoint>& tray, const ForceModel& force,
                                          const ServoConfig& config);

/// Everything that changes. Copy it to branch a simulation.
struct ServoState {
  Octree tooth;
  std::int64_t tick = 0;
  TipEstimate estimate;
  ContactState contact;
  RenderState render;
  TermsState terms;
  SafetyState safety;
  Vec3 last_tip_mm;
  double rpm = 0.0;
  double recession_mm = 0.0;        ///< surface receded along the contact but not yet carved
  std::uint64_t followed_edit = 0;  ///< edit hash of the tooth that the proxy has followed
  double swept_mm = 0.0;            ///< way of the head since the last carve began
  double carve_began_mm = 0.0;      ///< `recession_mm` when it began
  bool carve_waits = false;         ///< contact needed this tick
  HeadCarving carving;
  std::uint64_t trace_hash = 0;         ///< over every output so far
  ReservedVector<RemovedLeaf> removed;  ///< of the last tick; capacity is reserved once
};
[[nodiscard]] ServoState make_servo_state(const ServoModel& model, const Tooth& tooth, Vec3 first_tip_mm);

/// One tick. After it `state.removed` holds the leaves removed.
TickOutput step(const ServoModel& model, ServoState& state, const TickInput& input) noexcept;

/// Equal for equal histories: outputs, edits of the tooth, and the tick.
[[nodiscard]] std::uint64_t state_hash(const ServoState& state) noexcept;

}  // namespace cavum
