// A haptic stylus as the station sees it: a device of the servo that also says what it is and how
// it fares. Which one is open makes no difference to an exam; what it measures and bears is in its
// facts.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "engine/base/error.h"
#include "engine/physics/servo/servo_device.h"

namespace cavum {

/// What a stylus is; the same for as long as it is open.
struct StylusFacts {
  std::string id;                    ///< of its record in the table of styluses: a lower-case word
  Message name;                      ///< product, with what the device says of itself
  std::string serial = {};           ///< of this very device; empty when it tells none
  double position_quantum_mm = 0.0;  ///< step of the positions it reports; 0 = exact
  double peak_n = 0.0;               ///< force that it can give for a moment; more is cut to it
  double continuous_n = 0.0;         ///< force that it can give without end
  double rate_hz = 0.0;              ///< exchanges in a second, when all is well
  double reach_mm = 0.0;             ///< from the middle of its workspace, in each direction
  bool measures_direction =
      false;  ///< of the handpiece; otherwise the placement's fixed one counts
};

/// How it fares. Periods are between readings that came from the device.
struct StylusHealth {
  std::optional<Error> problem = {};  ///< none: positions come, and they mean something
  std::int64_t readings = 0;
  std::int64_t plugged_in = 0, unplugged = 0;
  std::int64_t forces_cut = 0;  ///< commands that were larger than it can bear
  double mean_period_s = 0.0, jitter_s = 0.0,
         longest_gap_s = 0.0;  ///< jitter: standard deviation of the periods; 0 below two readings
};

/// `read`, `show` and `send_force` belong to one thread at a time: the servo's while it runs, the
/// caller's before. The rest may be called by any.
class Stylus : public ServoDevice {
 public:
  [[nodiscard]] virtual const StylusFacts& facts() const noexcept = 0;
  /// May wait for a moment: not for the servo thread.
  [[nodiscard]] virtual StylusHealth health() const = 0;
};

}  // namespace cavum
