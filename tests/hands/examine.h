// What the tissue, the physics and the detector say of a session: three witnesses side by side.
#pragma once

#include <string>
#include <vector>

#include "grading/perforation/breakthrough.h"
#include "grading/perforation/drop.h"
#include "tests/hands/drill.h"

namespace cavum::hands {

struct Examined {
  std::string hand, style, tooth, bur;
  bool meant_to_open = false;
  double tilt_deg = 0.0, friction_n = 0.0, noise_n = 0.0, quantum_mm = 0.0, seconds = 0.0;
  std::int64_t opened_tick =
      -1;  ///< first face or leaf of a void tissue that was opened; -1 = none
  double area_mm2 = 0.0;
  grading::ForceDrop drop;  ///< where something was opened
  std::vector<grading::Breakthrough> events;
  bool seen = false;  ///< an event from 0.5 s before to 1 s after the steepest stretch, or the one
                      ///< in which the drop could be felt first
  double delay_ms = 0.0;  ///< of the event, after the drop could be felt
  double probability =
      0.0;  ///< of the surest event that counts: at the drop, or anywhere where nothing was opened
  bool false_alarm = false;  ///< an event further than that from any opening
};

[[nodiscard]] Examined examine(const Drilled& session,
                               const grading::BreakthroughSettings& settings = {});

}  // namespace cavum::hands
