// A Haply Inverse3 with its VerseGrip as a stylus, through its maker's service on this computer.
// The service answers each command with one state: a thread of its own sends the force of the
// moment and takes the place, a thousand times a second; the servo takes the latest place without
// waiting.
//
// Never tried on a real one. What is read from public pages alone, and to be checked first: the
// axes, the direction of the grip, the form of the force, the step of the positions and the largest
// forces (docs/inverse3.md).
#pragma once

#include <optional>
#include <string>

#include "engine/device/hardware/inverse3_protocol.h"
#include "engine/device/hardware/threaded_stylus.h"

namespace cavum {

class Inverse3Link;

class Inverse3Stylus final : public ThreadedStylus {
 public:
  /// A service that says nothing for so long is silent, and is told to push with no force.
  static constexpr double k_silent_after_s = 0.100;

  /// Waits for no device: one that is not there yet is taken when it comes (the health says so).
  /// `station`: settings `port`; `device`, an id, needed when there are several; `grip`, an id,
  /// needed when there are several, or `none` for a grip that tells no direction.
  explicit Inverse3Stylus(const StationStylus& station);
  ~Inverse3Stylus() override { stop(); }
  Inverse3Stylus(const Inverse3Stylus&) = delete;
  Inverse3Stylus& operator=(const Inverse3Stylus&) = delete;

 private:
  void run();
  void serve(Inverse3Link& link);
  void exchange(Inverse3Link& link, const std::string& id, bool vector);
  /// Its place, once it means something; otherwise the problem is set. Throws Error when the device
  /// is not there any more.
  void take(const Inverse3Message& message, const std::string& id);
  /// Both return the problem, or nothing.
  [[nodiscard]] std::optional<Error> place_of(const Inverse3Device& device, Place& place);
  [[nodiscard]] std::optional<Error> direction_of(const Inverse3Message& message,
                                                  Place& place) const;
  /// No place is known until the next one.
  void lose();
  /// None either where the place means nothing.
  [[nodiscard]] Vec3 force() noexcept;

  // of the thread
  std::string received_;
  bool calibrated_ = true, powered_ = true;  // as last said
  bool knows_its_position_ = false, lost_ = true;
};

/// Its record.
[[nodiscard]] StylusKind inverse3_kind();

}  // namespace cavum
