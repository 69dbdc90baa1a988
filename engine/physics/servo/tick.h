// One tick of an exam: what the step consumes and what it gives back. Inputs are whole numbers, so
// the recording holds exactly what was consumed and NaN cannot enter; devices are quantised on the
// way in.
#pragma once

#include <array>
#include <cstdint>

#include "engine/base/pose.h"
#include "engine/physics/force/notices.h"
#include "engine/tooth/octree.h"

namespace cavum {

/// Length of a tick of an exam, s. Rigs may choose a shorter one (ServoConfig::tick_s).
inline constexpr double k_tick_s = 0.001;
inline constexpr int k_ticks_per_second = 1000;

/// What was known in this tick, as bits of TickInput::flags.
enum TickFlag : std::uint16_t {
  k_stylus_fresh = 1,  ///< the pose was read in this tick
  k_pedal_fresh = 2,   ///< the pedal's position is known (without it the handpiece is off)
  k_button_1 = 4,
  k_button_2 = 8,
  k_stylus_fault =
      16,       ///< the device gave NaN, an error, or nothing: the pose repeats the last good one
  k_hold = 32,  ///< the exam office has paused this exam
};

/// The recorded input of one tick, exactly as the step consumes it.
struct TickInput {
  std::array<std::int32_t, 3> tip_nm{};  ///< tip of the bur in the tooth frame, nm
  std::array<std::int32_t, 4> rotation_q30{1 << 30, 0, 0,
                                           0};  ///< w, x, y, z of tool-to-tooth, 2^30 = 1
  std::uint16_t pedal_q16 = 0;                  ///< 0 = released, 65535 = pressed to the floor
  std::uint16_t flags = 0;                      ///< bits of TickFlag
  std::uint8_t bur = 0;                         ///< which bur of the tray is mounted
  friend bool operator==(const TickInput&, const TickInput&) = default;

  [[nodiscard]] Vec3 tip_mm() const noexcept {
    return {tip_nm[0] * 1e-6, tip_nm[1] * 1e-6, tip_nm[2] * 1e-6};
  }
  [[nodiscard]] Pose pose() const noexcept {
    constexpr double q = 1.0 / (1 << 30);
    return {tip_mm(), normalized(Quat{rotation_q30[0] * q, rotation_q30[1] * q, rotation_q30[2] * q,
                                      rotation_q30[3] * q})};
  }
  [[nodiscard]] double pedal() const noexcept { return pedal_q16 / 65535.0; }
};

/// Quantises a device's reading. A pose that is not finite, further than 2 m away or without
/// direction gives `previous` with k_stylus_fault and without k_stylus_fresh; a pedal outside 0..1
/// or NaN is unknown.
[[nodiscard]] TickInput make_tick_input(const Pose& pose, double pedal, std::uint16_t flags,
                                        std::uint8_t bur, const TickInput& previous) noexcept;

/// The result of one tick. `removed` lists the leaves turned to air in this tick.
struct TickOutput {
  Vec3 rendered_force_n;       ///< on the hand, tooth frame, after rendering and safety
  double model_force_n = 0.0;  ///< F = k X + c V and further terms, along the contact normal; below
                               ///< 0 only where friction holds back
  Vec3 drag_n;  ///< friction of the force terms on the hand, tooth frame, against the tip's motion,
                ///< in air too; its part along the normal is in `model_force_n` already
  double penetration_mm = 0.0;      ///< X >= 0
  double approach_mm_s = 0.0;       ///< V, positive = deeper
  double stiffness_n_per_mm = 0.0;  ///< k of the tissues touched
  Vec3 proxy_mm;                    ///< tip of the bur as the tooth allows it
  Vec3 normal;                      ///< contact normal, out of the tooth; zero out of contact
  double rpm = 0.0;
  bool contact = false;
  bool cutting = false;  ///< turning, in contact and pedal known
  std::uint16_t notices = 0;
  std::uint32_t removed_count = 0;
};

/// What the recording keeps of an output, in whole numbers; a replay must give the same.
struct TickRecord {
  std::array<std::int32_t, 3> rendered_un{};  ///< rendered force, micronewton
  std::int32_t model_un = 0;                  ///< model force, micronewton
  std::int32_t penetration_nm = 0;
  std::array<std::int32_t, 3> proxy_nm{};
  std::int32_t rpm = 0;
  std::uint32_t removed = 0;  ///< leaves removed in this tick
  std::uint16_t notices = 0;
  friend bool operator==(const TickRecord&, const TickRecord&) = default;
};

[[nodiscard]] TickRecord make_tick_record(const TickOutput& output) noexcept;

/// For state_hash: over all that was recorded so far, when `seed` is that of the record before.
[[nodiscard]] std::uint64_t hash_of(const TickRecord& record, std::uint64_t seed) noexcept;

}  // namespace cavum
