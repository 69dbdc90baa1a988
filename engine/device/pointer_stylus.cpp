#include "engine/device/pointer_stylus.h"

#include <algorithm>
#include <cmath>

namespace cavum {

OmniModel pointer_omni() {
  OmniModel model;
  model.coulomb_n = 0.05;
  model.quantum_mm = 0.01;
  return model;
}

PointerStylus::PointerStylus(const OmniModel& omni, const HandModel& hand, double tick_s,
                             const PointerIntent& first)
    : omni_(omni),
      hand_(hand),
      tick_s_(tick_s),
      state_(make_omni_state(first.tip_mm)),
      intent_(first),
      followed_mm_(first.tip_mm) {
  silent_s_ = k_silent_s;  // nobody has spoken yet
}

void PointerStylus::want(const PointerIntent& intent) noexcept {
  const std::array<double, 8> values{intent.tip_mm.x,   intent.tip_mm.y,   intent.tip_mm.z,
                                     intent.rotation.w, intent.rotation.x, intent.rotation.y,
                                     intent.rotation.z, intent.pedal};
  for (const double v : values)
    if (!std::isfinite(v)) return;
  const std::uint32_t before = written_.load(std::memory_order_relaxed);
  written_.store(before + 1, std::memory_order_seq_cst);
  for (std::size_t i = 0; i < values.size(); ++i)
    shared_[i].store(values[i], std::memory_order_seq_cst);
  buttons_.store((intent.button_1 ? std::uint32_t{k_button_1} : 0u) |
                     (intent.button_2 ? std::uint32_t{k_button_2} : 0u),
                 std::memory_order_seq_cst);
  written_.store(before + 2, std::memory_order_seq_cst);
}

bool PointerStylus::take_intent() noexcept {
  const std::uint32_t before = written_.load(std::memory_order_seq_cst);
  if (before == taken_ || (before & 1u) != 0) return false;
  std::array<double, 8> v{};
  for (std::size_t i = 0; i < v.size(); ++i) v[i] = shared_[i].load(std::memory_order_seq_cst);
  const std::uint32_t buttons = buttons_.load(std::memory_order_seq_cst);
  if (written_.load(std::memory_order_seq_cst) != before) return false;
  taken_ = before;
  intent_ = {{v[0], v[1], v[2]},
             normalized(Quat{v[3], v[4], v[5], v[6]}),
             v[7],
             (buttons & k_button_1) != 0,
             (buttons & k_button_2) != 0};
  return true;
}

DeviceReading PointerStylus::read(double elapsed_s) {
  constexpr int k_max_steps = 1000;
  const int steps =
      std::clamp(static_cast<int>(std::floor(elapsed_s / tick_s_ + 0.5)), 1, k_max_steps);
  silent_s_ = take_intent() ? 0.0 : silent_s_ + elapsed_s;
  Vec3 tip;
  for (int i = 0; i < steps; ++i) {
    Vec3 way = (intent_.tip_mm - followed_mm_) * (tick_s_ / (k_hand_follows_s + tick_s_));
    const double size = length(way), most = k_fastest_mm_s * tick_s_;
    if (size > most) way = way * (most / size);
    followed_mm_ += way;
    tip =
        advance_omni(omni_, hand_, state_, cut_.load(std::memory_order_acquire) ? Vec3{} : force_n_,
                     followed_mm_, tick_s_);
  }
  const bool speaks = silent_s_ < k_silent_s;
  const auto flags = static_cast<std::uint16_t>(k_stylus_fresh | (speaks ? k_pedal_fresh : 0) |
                                                (intent_.button_1 ? k_button_1 : 0) |
                                                (intent_.button_2 ? k_button_2 : 0));
  return {{tip, intent_.rotation}, intent_.pedal, flags, 0};
}

void PointerStylus::send_force(Vec3 force_n) {
  force_n_ = force_n;
  cut_.store(false, std::memory_order_release);
}

}  // namespace cavum
