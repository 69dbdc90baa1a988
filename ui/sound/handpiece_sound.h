// The sound of a turbine handpiece, sample by sample: the whine of the rotor, whose speed is never
// quite even, its bearings, the hiss of its air, the spray, the suction beside it, and the grinding
// of enamel or dentin. Let go, it runs down by itself; a load stops it sooner. Whatever its
// parameters do, it glides, so that nothing clicks. It knows no sound device (see sound_output.h).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "engine/base/random.h"

namespace cavum::ui {

/// What is heard. All zero is silence.
struct SoundParameters {
  double rpm = 0.0;     ///< of the handpiece, without load
  double load_n = 0.0;  ///< force on the bur, >= 0
  bool cutting = false;
  double enamel_share = 0.0,
         dentin_share =
             0.0;       ///< of what is cut, 0..1; what is missing to 1 makes no sound of its own
  double volume = 1.0;  ///< 0 = muted .. 1
  double spray = 0.0,
         suction = 0.0;  ///< water on the bur, and the tip that takes it away: 0 = off .. 1
  friend bool operator==(const SoundParameters&, const SoundParameters&) = default;
};

/// Speed at which a turbine turns under load, rpm: it falls in proportion to the load, as the
/// torque of an air turbine rises linearly from free running to standstill. Standing still at
/// `k_stall_load_n` is assumed, without a source. Heard only: the servo's speed does not depend on
/// the load.
inline constexpr double k_stall_load_n = 6.0;
[[nodiscard]] double loaded_rpm(double rpm, double load_n) noexcept;

/// Pitch of the whine, Hz: one turn of the rotor, rpm/60. The speed of burs has been read from that
/// line (Poole and others, J Dent 2008;36:488), and a turbine at 360,000 rpm is to be heard at 6
/// kHz, where recordings of dental turbines have their prominent line ("Effect of processing of
/// dental drill noise on subjective impression": approximately 6 kHz).
[[nodiscard]] double pitch_hz(double rpm, double load_n) noexcept;

/// Blades of the rotor: their passing is heard at 8 times the pitch while that is audible. Assumed.
inline constexpr int k_rotor_blades = 8;

/// Balls of its bearings, and the cage's turns for one of the rotor, (1 - d/D) / 2 for balls of a
/// fifth of the bearing's pitch diameter: the balls pass the outer ring 7 x 0.4 = 2.8 times a turn,
/// the inner one 7 x 0.6 = 4.2 times (the usual equations of bearing diagnosis). The bearing is
/// assumed.
inline constexpr int k_bearing_balls = 7;
inline constexpr double k_cage_turns = 0.4;

/// How a rotor that nobody drives slows down: to 1/e in this time. Assumed; a hand's load stops it
/// sooner.
inline constexpr double k_run_down_s = 0.5;

/// The generator. Same seed and same calls, same samples. No call allocates.
class HandpieceSound {
 public:
  explicit HandpieceSound(double sample_rate_hz = 48000.0, std::uint64_t seed = 1);
  /// Fills `out`: mono, -1..1. Gliding towards `target`: pitch within 40 ms, down without load
  /// within k_run_down_s, loudness within 20 ms (times of 1/e).
  void render(const SoundParameters& target, std::span<float> out) noexcept;

 private:
  /// Lets one band of noise through, with the loudness of 1 (rms) for white noise of -1..1.
  class Band {
   public:
    Band() = default;
    Band(double sample_rate_hz, double middle_hz, double width_hz);
    [[nodiscard]] double next(double noise) noexcept;

   private:
    double out_1_ = 0.0, out_2_ = 0.0, gain_ = 0.0;  // coefficients
    std::array<double, 2> x_{}, y_{};
  };
  /// Loudness of each part; what glides.
  struct Levels {
    double pitch_hz = 0.0, bearing = 0.0, spray = 0.0, suction = 0.0, enamel = 0.0, dentin = 0.0,
           volume = 0.0;
  };
  [[nodiscard]] static Levels levels_of(const SoundParameters& target) noexcept;
  [[nodiscard]] double whine(double pitch) noexcept;
  [[nodiscard]] double bearings(double pitch) const noexcept;
  [[nodiscard]] double noise() noexcept { return random_.uniform(-1.0, 1.0); }

  double sample_rate_hz_, glide_pitch_, run_down_, glide_level_, forget_uneven_, more_uneven_;
  Random random_;
  Levels now_;
  double turn_ = 0.0, cage_ = 0.0;  // places of rotor and cage, turns
  double uneven_ = 0.0;             // of the speed, a share of it
  Band air_, rough_;
  std::array<Band, 2> spray_, suction_;
  std::array<Band, 2> enamel_, dentin_;
};

}  // namespace cavum::ui
