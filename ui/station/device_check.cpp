#include "ui/station/device_check.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/message_from.h"

namespace cavum::station {
namespace {

using Clock = std::chrono::steady_clock;

CheckItem stylus_item(const DeviceSight& s) {
  using State = CheckItem::State;
  const Message title = msg("Stylus");
  if (!s.error.empty()) return {State::bad, title, s.error};
  if (!s.read_once) return {State::waiting, title, msg("waiting for its first word")};
  if (s.rate_hz < DeviceCheck::k_min_share * s.usual_rate_hz)
    return {State::waiting, title,
            msg("speaks too seldom: {} times a second", as_number(s.rate_hz, 0))};
  return {State::good, title, msg("speaks {} times a second", as_number(s.rate_hz, 0))};
}

CheckItem pedal_item(const DeviceSight& s) {
  using State = CheckItem::State;
  const Message title = msg("Pedal");
  const Number pressed = as_percent(100.0 * s.pedal);
  if (!s.pedal_known) return {State::waiting, title, msg("not heard of yet: move it once")};
  if (s.pedal_came_back) return {State::good, title, msg("reaches both ends")};
  if (!s.pedal_released) return {State::waiting, title, msg("take the foot off it ({})", pressed)};
  if (!s.pedal_pressed)
    return {State::waiting, title, msg("press it down all the way ({})", pressed)};
  return {State::waiting, title, msg("release it ({})", pressed)};
}

CheckItem rest_item(const DeviceSight& s) {
  using State = CheckItem::State;
  const Message title = msg("Finger rest");
  if (!s.read_once || s.wander_mm > 100)
    return {State::waiting, title, msg("lay the fingers on the rest and hold the stylus still")};
  if (s.wander_mm > DeviceCheck::k_max_wander_mm)
    return {State::waiting, title,
            msg("the tip wanders by {}: lay the fingers on the rest", as_mm(s.wander_mm, 1))};
  return {State::good, title, msg("in place, the tip is still within {}", as_mm(s.wander_mm))};
}

/// What happened in the last second, in a ring.
struct LastSecond {
  static constexpr std::size_t k_most = 1000;
  std::vector<Vec3> tips;
  std::vector<Clock::time_point> times;
  std::size_t next = 0;

  void add(Vec3 tip, Clock::time_point now) {
    if (tips.size() < k_most) {
      tips.push_back(tip);
      times.push_back(now);
    } else {
      tips[next] = tip;
      times[next] = now;
    }
    next = (next + 1) % k_most;
  }
  void judge(Clock::time_point now, DeviceSight& sight) const {
    Vec3 sum;
    std::size_t n = 0;
    double oldest_s = 0.0;
    for (std::size_t i = 0; i < tips.size(); ++i) {
      const double age_s = std::chrono::duration<double>(now - times[i]).count();
      if (age_s > 1.0) continue;
      sum += tips[i];
      oldest_s = std::max(oldest_s, age_s);
      ++n;
    }
    sight.rate_hz = oldest_s > 0.2 ? static_cast<double>(n) / oldest_s : 0.0;
    if (oldest_s < 0.9) return;  // not long enough to speak of rest
    const Vec3 mean = sum / static_cast<double>(n);
    sight.wander_mm = 0.0;
    for (std::size_t i = 0; i < tips.size(); ++i)
      if (now - times[i] <= std::chrono::seconds(1))
        sight.wander_mm = std::max(sight.wander_mm, length(tips[i] - mean));
  }
};

}  // namespace

std::array<CheckItem, 3> check_items(const DeviceSight& sight) {
  return {stylus_item(sight), pedal_item(sight), rest_item(sight)};
}

bool all_good(const std::array<CheckItem, 3>& items) {
  return std::all_of(items.begin(), items.end(),
                     [](const CheckItem& i) { return i.state == CheckItem::State::good; });
}

DeviceCheck::DeviceCheck(ServoDevice& device, double usual_rate_hz)
    : device_(device), usual_rate_hz_(usual_rate_hz), thread_([this] { run(); }) {}

DeviceCheck::~DeviceCheck() {
  stop_.store(true, std::memory_order_release);
  thread_.join();
}

DeviceSight DeviceCheck::sight() const {
  const std::lock_guard lock(mutex_);
  return sight_;
}

void DeviceCheck::run() noexcept {
  DeviceSight seen;
  seen.usual_rate_hz = usual_rate_hz_;
  LastSecond last;
  auto due = Clock::now();
  auto before = due;
  for (int i = 0; !stop_.load(std::memory_order_acquire); ++i) {
    due =
        std::max(due + std::chrono::milliseconds(1), Clock::now() - std::chrono::milliseconds(20));
    std::this_thread::sleep_until(due);
    const auto now = Clock::now();
    try {
      const DeviceReading r = device_.read(std::chrono::duration<double>(now - before).count());
      device_.send_force({});
      if ((r.flags & k_stylus_fresh) != 0 && is_finite(r.pose.tip_mm)) {
        seen.read_once = true;
        seen.tip_mm = r.pose.tip_mm;
        seen.rotation = r.pose.rotation;
        last.add(r.pose.tip_mm, now);
      }
      seen.pedal_known = (r.flags & k_pedal_fresh) != 0 && std::isfinite(r.pedal);
      if (seen.pedal_known) {
        seen.pedal = r.pedal;
        seen.pedal_released = seen.pedal_released || r.pedal < 0.05;
        seen.pedal_pressed = seen.pedal_pressed || (seen.pedal_released && r.pedal > 0.9);
        seen.pedal_came_back = seen.pedal_came_back || (seen.pedal_pressed && r.pedal < 0.05);
      }
      seen.button = (r.flags & (k_button_1 | k_button_2)) != 0;
    } catch (const std::exception& e) {
      seen.error = message_from(e);
      stop_.store(true, std::memory_order_release);
    }
    before = now;
    constexpr int k_look = 50;
    if (i % k_look == 0) last.judge(now, seen);
    const std::lock_guard lock(mutex_);
    sight_ = seen;
  }
}

}  // namespace cavum::station
