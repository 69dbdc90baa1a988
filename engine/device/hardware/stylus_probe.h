// A stylus tried by itself: how often it speaks and how evenly, the smallest step of its positions,
// and the friction of its joints in air, found by pushing ever harder, very slowly, until it moves.
#pragma once

#include <array>
#include <optional>

#include "engine/device/stylus.h"

namespace cavum {

struct StylusProbeOptions {
  double listen_s = 2.0;      ///< before anything is pushed
  double ramp_n_per_s = 0.4;  ///< growth of the push
  double most_n = 1.0;        ///< it is never pushed harder
  double moved_mm =
      0.12;  ///< way that counts as moving; at least two steps of the encoder are taken
  bool friction = true;
  bool real_time = true;  ///< false: as fast as it goes, for a simulated one
};

struct StylusProbe {
  std::int64_t readings = 0;
  double rate_hz = 0.0, jitter_s = 0.0,
         longest_gap_s = 0.0;  ///< rate over the listening, the others since it was opened
  double quantum_mm = 0.0;     ///< smallest way between two unequal positions; 0 = it never moved
  struct Axis {
    double forwards_n = 0.0, backwards_n = 0.0;  ///< push at which it moved along +axis and -axis
                                                 ///< of the tooth frame; 0 = not found
    /// Friction acts against both, weight and springs for one and against the other.
    [[nodiscard]] double friction_n() const noexcept { return 0.5 * (forwards_n + backwards_n); }
    [[nodiscard]] double bias_n() const noexcept { return 0.5 * (backwards_n - forwards_n); }
  };
  std::array<Axis, 3> axes;
  double friction_n = 0.0;                     ///< mean of the axes; 0 = not found
  std::optional<Error> friction_problem = {};  ///< why it was not found
};

/// Nobody may hold the stylus. It ends with no force. Throws Error when the stylus is not ready, or
/// falls silent meanwhile.
[[nodiscard]] StylusProbe probe_stylus(Stylus& stylus, const StylusProbeOptions& options = {});

}  // namespace cavum
