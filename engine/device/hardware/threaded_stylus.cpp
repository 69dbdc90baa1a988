#include "engine/device/hardware/threaded_stylus.h"

#include <chrono>
#include <limits>
#include <utility>

#include "engine/device/device_error.h"
#include "engine/physics/servo/scheduling.h"

namespace cavum {

ThreadedStylus::ThreadedStylus(const StationStylus& station, StylusFacts facts)
    : station_(station),
      facts_(std::move(facts)),
      problem_(stylus_error(facts_.id, DeviceError::starting, msg("was not looked for yet"),
                            msg("wait a second"))) {}

ThreadedStylus::~ThreadedStylus() { stop(); }

void ThreadedStylus::start(std::function<void()> run) { thread_ = std::thread(std::move(run)); }

void ThreadedStylus::stop() noexcept {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  stop_asked_.notify_all();
  thread_.join();
}

DeviceReading ThreadedStylus::read(double) {
  last_ = place_.take();
  if (last_.at_ns == 0) {  // nothing heard yet: not even an old place
    constexpr double k_none = std::numeric_limits<double>::quiet_NaN();
    return {.pose = {{k_none, k_none, k_none}, {}}};
  }
  const bool fresh = static_cast<double>(monotonic_ns() - last_.at_ns) * 1e-9 <= k_stale_after_s;
  const Pose pose = facts_.measures_direction
                        ? to_tooth(station_.placement, last_.device_mm, last_.tool_to_device)
                        : to_tooth(station_.placement, last_.device_mm);
  return {.pose = pose,
          .flags = static_cast<std::uint16_t>(fresh ? last_.flags | k_stylus_fresh : 0)};
}

void ThreadedStylus::send_force(Vec3 force_n) {
  wanted_.put({force_n, monotonic_ns()});
  cut_.store(false, std::memory_order_release);
}

StylusHealth ThreadedStylus::health() const {
  StylusHealth h;
  h.readings = meter_.count();
  h.plugged_in = plugged_in_.load();
  h.unplugged = unplugged_.load();
  h.forces_cut = forces_cut_.load();
  h.mean_period_s = meter_.mean_s();
  h.jitter_s = meter_.scatter_s();
  h.longest_gap_s = meter_.longest_s();
  const std::lock_guard lock(mutex_);
  h.problem = problem_;
  return h;
}

void ThreadedStylus::set_problem(std::optional<Error> problem) {
  const std::lock_guard lock(mutex_);
  problem_ = std::move(problem);
}

bool ThreadedStylus::wait(double seconds) {
  std::unique_lock lock(mutex_);
  return stop_asked_.wait_for(lock, std::chrono::duration<double>(seconds),
                              [this] { return stop_.load(); });
}

void ThreadedStylus::look_again_and_again(const std::function<void()>& serve) {
  constexpr double k_look_again_s = 0.2;
  do {
    try {
      serve();
    } catch (const Error& e) {
      set_problem(e);
    } catch (const std::exception& e) {
      set_problem(stylus_error(facts_.id, DeviceError::failed,
                               msg("cannot be served ({})", e.what()), msg("begin Cavum again")));
    }
    meter_.pause();
  } while (!wait(k_look_again_s));
}

void ThreadedStylus::put(const Place& place) {
  place_.put(place);
  meter_.add(place.at_ns);
}

Vec3 ThreadedStylus::force_now(bool& cut) noexcept {
  cut = false;
  const Wanted wanted = wanted_.take();
  // A servo that says nothing any more is no servo: its last force must not stay.
  const bool old = static_cast<double>(monotonic_ns() - wanted.at_ns) * 1e-9 > k_force_lasts_s;
  if (old || cut_.load(std::memory_order_acquire) || !is_finite(wanted.tooth_n)) return {};
  const Vec3 force = force_to_device(station_.placement, wanted.tooth_n);
  const double size = length(force);
  cut = size > facts_.peak_n;
  return cut ? force * (facts_.peak_n / size) : force;
}

}  // namespace cavum
