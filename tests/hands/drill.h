// A hand at a tooth: draws a task, lets the hand work through the simulated Omni and the real
// servo, and keeps what a grader needs, with the truth.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/physics/servo/servo.h"
#include "engine/session/session_reader.h"
#include "tests/hands/hand.h"

namespace cavum::hands {

struct Drilled {
  std::string hand, style, tooth, bur;
  bool meant_to_open = false;  ///< the task was to open the chamber
  std::vector<TickInput> inputs;
  std::vector<TickRecord> records;       ///< with noise on the force
  std::vector<TickRecord> true_records;  ///< without
  std::vector<RemovedAt> removed;
  const Tooth* before = nullptr;
  std::array<bool, 256> voids{};  ///< tissues that may be opened
  ServoModel filled_model;        ///< of the same tooth without its cavities
  Tooth filled;
  std::vector<std::pair<double, double>>
      solids;  ///< k, N/mm, and tau, s, of the tissues that the tooth has and the task lists
  Vec3 first_tip_mm;
  double noise_n = 0.0, friction_n = 0.0, quantum_mm = 0.0, tilt_deg = 0.0;
};

/// Session `seed` of the hand; equal seeds give equal sessions. Half of the tasks lead into a
/// cavity.
[[nodiscard]] Drilled drill(const HandKind& kind, std::uint64_t seed);

}  // namespace cavum::hands
