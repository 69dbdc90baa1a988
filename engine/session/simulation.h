// The exam's physics, built from what a session holds and nothing else. The exam and its replay
// both start here, so that they cannot start differently.
#pragma once

#include <functional>

#include "engine/physics/servo/servo.h"
#include "engine/session/session.h"

namespace cavum {

struct Simulation {
  Tooth tooth;  ///< before the first tick
  ServoModel model;
  ServoState state;
};

/// Called for every recorded tick while it is simulated again, so that a scenario can catch up.
/// `state.removed` holds the leaves removed in the tick.
using TickVisitor = std::function<void(std::int64_t tick, const TickInput& input,
                                       const TickOutput& output, const ServoState& state)>;

/// Throws Error when the tooth, a bur, the force model or the servo settings cannot be used;
/// `where` precedes the name of the part.
/// With `start`, the setup's tooth as somebody has read it already, that is copied instead of read
/// again.
[[nodiscard]] Simulation make_simulation(const SessionSetup& setup, const std::string& where,
                                         const Tooth* start = nullptr);

/// The tooth as it is now; save_tooth of it is what a session keeps on closing.
[[nodiscard]] Tooth drilled_tooth(const Simulation& simulation);

}  // namespace cavum
