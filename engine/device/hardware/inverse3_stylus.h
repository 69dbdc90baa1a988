// A Haply Inverse3 with its VerseGrip as a stylus, through its maker's service on this computer. The service answers each command with one state: a
// thread of its own sends the force of the moment and takes the place, a thousand times a second; the servo takes the latest place without waiting.
//
// Never tried on a real one. What is read from public pages alone, and to be checked first: the axes, the direction of the grip, the form of the
// force, the step of the positions and the largest forces (docs/inverse3.md).
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "engine/device/hardware/inverse3_protocol.h"
#include "engine/device/hardware/stylus_kind.h"
#include "engine/device/latest_value.h"
#include "engine/device/period_meter.h"
#include "engine/device/stylus.h"

namespace cavum {

class Inverse3Link;

class Inverse3Stylus final : public Stylus {
 public:
  /// A place older than the first is not fresh; a force that nobody renewed for the second is not given; a service that says nothing for the third is
  /// silent, and is told to push with no force.
  static constexpr double k_stale_after_s = 0.003, k_force_lasts_s = 0.020, k_silent_after_s = 0.100;

  /// Waits for no device: one that is not there yet is taken when it comes (the health says so). `station`: settings `port`; `device`, an id, needed
  /// when there are several; `grip`, an id, needed when there are several, or `none` for a grip that tells no direction.
  explicit Inverse3Stylus(const StationStylus& station);
  ~Inverse3Stylus() override;
  Inverse3Stylus(const Inverse3Stylus&) = delete;
  Inverse3Stylus& operator=(const Inverse3Stylus&) = delete;

  [[nodiscard]] DeviceReading read(double elapsed_s) override;
  void send_force(Vec3 force_n) override;
  void cut_force() noexcept override { cut_.store(true, std::memory_order_release); }
  [[nodiscard]] const StylusFacts& facts() const noexcept override { return facts_; }
  [[nodiscard]] StylusHealth health() const override;

 private:
  struct Place {
    Vec3 device_mm;
    Quat tool_to_device;
    std::uint16_t flags = 0;  // buttons
    std::int64_t at_ns = 0;   // 0: none yet
  };
  struct Wanted {
    Vec3 tooth_n;
    std::int64_t at_ns = 0;
  };

  void run();
  void serve(Inverse3Link& link);
  void exchange(Inverse3Link& link, const std::string& id, bool vector);
  /// Its place, once it means something; otherwise the problem is set. Throws Error when the device is not there any more.
  void take(const Inverse3Message& message, const std::string& id);
  /// Both return the problem, or nothing.
  [[nodiscard]] std::string place_of(const Inverse3Device& device, Place& place);
  [[nodiscard]] std::string direction_of(const Inverse3Message& message, Place& place) const;
  /// No place is known until the next one.
  void lose();
  [[nodiscard]] Vec3 force_now() noexcept;
  void set_problem(const std::string& problem);
  [[nodiscard]] bool wait(double seconds);

  const StationStylus station_;
  const StylusFacts facts_;
  LatestValue<Place> place_;    // from the thread to the servo
  LatestValue<Wanted> wanted_;  // and back
  Place last_;                  // of the servo
  std::atomic<bool> cut_{true};
  PeriodMeter meter_;
  std::atomic<std::int64_t> plugged_in_{0}, unplugged_{0}, forces_cut_{0};
  std::string heard_;                        // of the thread, as the next two lines
  bool calibrated_ = true, powered_ = true;  // as last said
  bool knows_its_place_ = false, lost_ = true;
  mutable std::mutex mutex_;  // of what follows
  std::condition_variable stop_asked_;
  std::atomic<bool> stop_{false};  // changed with the mutex held, so that nobody sleeps through it
  std::string problem_ = "stylus inverse3: not looked for yet; wait a second";
  std::thread thread_;
};

/// Its record.
[[nodiscard]] StylusKind inverse3_kind();

}  // namespace cavum
