// A Novint Falcon as a stylus: a thread of its own exchanges a frame with it each millisecond,
// turns encoders into a place and forces into motor commands, and looks for it again when it was
// unplugged. The servo takes the latest place without waiting.
#pragma once

#include <string>

#include "engine/device/hardware/falcon_usb.h"
#include "engine/device/hardware/threaded_stylus.h"

namespace cavum {

class FalconStylus final : public ThreadedStylus {
 public:
  /// Waits for no device: one that is not there yet is taken when it comes, and homed (the health
  /// says so).
  explicit FalconStylus(const StationStylus& station);
  ~FalconStylus() override { stop(); }
  FalconStylus(const FalconStylus&) = delete;
  FalconStylus& operator=(const FalconStylus&) = delete;

 private:
  void run();
  void serve(FalconUsb& usb);
  /// Motor command for what the servo wants now.
  [[nodiscard]] std::array<std::int16_t, 3> motors(const FalconAngles& angles, Vec3 at_mm) noexcept;

  const std::string firmware_;
  const FalconGeometry geometry_;
  const FalconDrive drive_;
};

/// Its record. Peak: 2 lbf, as its maker says; continuous: not published, assumed. Reach: half of
/// the maker's 4 inches.
[[nodiscard]] StylusKind falcon_kind();

}  // namespace cavum
