// What sits in the candidate's hand at this station: a stylus that is plugged in, with the foot
// pedal; the built-in operator with a simulated Omni; or mouse and keyboard. One for the check
// before the exam, one for the exam; with most devices they are the same.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/device/hardware/stylus_kind.h"
#include "engine/device/pointer_stylus.h"
#include "scenarios/operators/candidate_device.h"

namespace cavum::station {

struct DeviceChoice {
  std::string name;                      ///< of the table of styluses; none is taken for granted
  std::string operator_name = "expert";  ///< of the simulated candidate, see make_skill
  std::uint64_t seed = 1;
};

class StationDevice {
 public:
  virtual ~StationDevice() = default;
  /// As the station signs it, unless this is practice.
  [[nodiscard]] virtual MotionSource source() const = 0;
  [[nodiscard]] virtual double position_quantum_mm() const = 0;
  [[nodiscard]] virtual double peak_n() const { return 0.0; }  ///< that it bears; 0 = as usual
  [[nodiscard]] virtual double continuous_n() const { return 0.0; }  ///< the same
  [[nodiscard]] virtual std::vector<std::pair<std::string, std::string>> notes() const {
    return {};
  }
  /// Once what the exam asks for is known; may take seconds. Before it only the above may be
  /// called. Throws Error.
  virtual void prepare(const scenarios::ExamSetup& setup) = 0;
  [[nodiscard]] virtual ServoDevice& for_check() = 0;
  [[nodiscard]] virtual ServoDevice& for_exam() = 0;
  /// Where the handpiece waits before the exam, tooth frame.
  [[nodiscard]] virtual Pose start() const = 0;
  /// Where the tip is, tooth frame, while nobody reads the device.
  [[nodiscard]] virtual Vec3 tip_mm() = 0;
  /// No person's hand: what is shown is a demonstration.
  [[nodiscard]] virtual bool simulated() const { return false; }
  /// The candidate has nothing left to do: only simulated ones say so.
  [[nodiscard]] virtual bool done() const { return false; }
  /// What is wrong with it at the moment.
  [[nodiscard]] virtual std::optional<Error> problem() const { return {}; }
  /// Null unless mouse and keyboard are the stylus.
  [[nodiscard]] virtual PointerStylus* pointer() { return nullptr; }
};

/// The record of `name`. Throws Error for a name that is none.
[[nodiscard]] const StylusKind& station_stylus_kind(const std::string& name);
/// Throws Error for a name that is none, and when what a stylus needs is missing.
[[nodiscard]] std::unique_ptr<StationDevice> make_station_device(const DeviceChoice& choice);

}  // namespace cavum::station
