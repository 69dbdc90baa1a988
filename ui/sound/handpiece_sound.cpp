#include "ui/sound/handpiece_sound.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cavum::ui {
namespace {

constexpr double k_reference_rpm = 200000.0;  // at which the loudnesses below are meant
constexpr double k_whine = 0.10, k_hiss = 0.02, k_grind = 0.11, k_spray = 0.011, k_suction = 0.012;
constexpr double k_bearing = 0.002, k_bearing_a_newton = 0.003;  // without load, and with it
// The speed wanders by a thousandth, for some hundredths of a second each time. Assumed.
constexpr double k_uneven = 0.001, k_uneven_s = 0.01;
constexpr double k_half_grind_n = 0.4;  // load at which grinding has half its loudness
constexpr double k_pitch_glide_s = 0.04, k_level_glide_s = 0.02;
constexpr double k_highest =
    0.45;  // of the sample rate: lines above it would come back as false ones

/// Strength of the first turns of the whine: a line a turn, and weaker ones above.
constexpr std::array<double, 4> k_harmonics{1.0, 0.4, 0.2, 0.1};
constexpr double k_blades = 0.12;

/// 1 for audible lines, falling to 0 before the sample rate can no longer hold them.
double room_for(double hz, double sample_rate_hz) {
  return std::clamp((k_highest - hz / sample_rate_hz) / 0.05, 0.0, 1.0);
}

}  // namespace

double loaded_rpm(double rpm, double load_n) noexcept {
  return rpm * (1.0 - std::clamp(load_n / k_stall_load_n, 0.0, 1.0));
}

double pitch_hz(double rpm, double load_n) noexcept { return loaded_rpm(rpm, load_n) / 60.0; }

HandpieceSound::Band::Band(double sample_rate_hz, double middle_hz, double width_hz) {
  // two poles at radius r and two zeros at 0 Hz and half the sample rate
  const double r = std::exp(-std::numbers::pi * width_hz / sample_rate_hz),
               turn = 2.0 * std::numbers::pi * middle_hz / sample_rate_hz;
  out_1_ = 2.0 * r * std::cos(turn);
  out_2_ = -r * r;
  // its power for white noise, by its impulse response; noise of -1..1 has a power of 1/3
  double power = 0.0, y1 = 0.0, y2 = 0.0;
  for (int i = 0; i < 100000 && (i < 10 || y1 * y1 + y2 * y2 > 1e-18); ++i) {
    const double y = (i == 0 ? 1.0 : i == 2 ? -1.0 : 0.0) + out_1_ * y1 + out_2_ * y2;
    power += y * y;
    y2 = y1;
    y1 = y;
  }
  gain_ = std::sqrt(3.0 / power);
}

double HandpieceSound::Band::next(double noise) noexcept {
  const double y = noise - x_[1] + out_1_ * y_[0] + out_2_ * y_[1];
  x_ = {noise, x_[0]};
  y_ = {y, y_[0]};
  return y * gain_;
}

HandpieceSound::HandpieceSound(double sample_rate_hz, std::uint64_t seed)
    : sample_rate_hz_(sample_rate_hz),
      glide_pitch_(1.0 - std::exp(-1.0 / (k_pitch_glide_s * sample_rate_hz))),
      run_down_(1.0 - std::exp(-1.0 / (k_run_down_s * sample_rate_hz))),
      glide_level_(1.0 - std::exp(-1.0 / (k_level_glide_s * sample_rate_hz))),
      forget_uneven_(1.0 - std::exp(-1.0 / (k_uneven_s * sample_rate_hz))),
      more_uneven_(k_uneven *
                   std::sqrt(3.0 * forget_uneven_ *
                             (2.0 - forget_uneven_))),  // noise of -1..1 has a power of 1/3
      random_(seed),
      air_(sample_rate_hz, 9000.0, 6000.0),
      rough_(sample_rate_hz, 45.0, 40.0),
      spray_{Band(sample_rate_hz, 4500.0, 3500.0), Band(sample_rate_hz, 12000.0, 5000.0)},
      suction_{Band(sample_rate_hz, 500.0, 500.0), Band(sample_rate_hz, 1500.0, 1500.0)},
      // Enamel rings high and sharp, dentin sounds low and dull. Assumed: chosen to be told apart,
      // not measured.
      enamel_{Band(sample_rate_hz, 6100.0, 700.0), Band(sample_rate_hz, 8400.0, 1100.0)},
      dentin_{Band(sample_rate_hz, 1100.0, 600.0), Band(sample_rate_hz, 2300.0, 1000.0)} {}

HandpieceSound::Levels HandpieceSound::levels_of(const SoundParameters& target) noexcept {
  const auto within = [](double v, double most) {
    return v > 0.0 ? std::min(v, most) : 0.0;
  };  // what is no number counts as 0
  const double rpm = within(target.rpm, 1e6), load_n = within(target.load_n, 1e3);
  const double speed = std::min(2.0, rpm / k_reference_rpm);
  Levels to;
  to.pitch_hz = ui::pitch_hz(rpm, load_n);
  to.bearing = k_bearing + k_bearing_a_newton * std::min(load_n, k_stall_load_n);
  to.spray = k_spray * within(target.spray, 1.0);
  to.suction = k_suction * within(target.suction, 1.0);
  const double grind =
      target.cutting ? k_grind * std::min(1.0, speed) * load_n / (load_n + k_half_grind_n) : 0.0;
  to.enamel = grind * within(target.enamel_share, 1.0);
  to.dentin = grind * within(target.dentin_share, 1.0);
  to.volume = within(target.volume, 1.0);
  return to;
}

/// One sample of the rotor, which turns on by one.
double HandpieceSound::whine(double pitch) noexcept {
  uneven_ += more_uneven_ * noise() - forget_uneven_ * uneven_;
  const double turned = pitch * (1.0 + uneven_) / sample_rate_hz_;
  turn_ += turned;
  turn_ -= std::floor(turn_);
  cage_ += k_cage_turns * turned;
  cage_ -= std::floor(cage_);
  const double s = std::sin(2.0 * std::numbers::pi * turn_),
               c2 = 2.0 * std::cos(2.0 * std::numbers::pi * turn_);
  double before = 0.0, line = s, sum = 0.0;  // sin(n a) = 2 cos(a) sin((n-1) a) - sin((n-2) a)
  for (int n = 1; n <= k_rotor_blades; ++n) {
    const double strength = n <= static_cast<int>(k_harmonics.size())
                                ? k_harmonics[static_cast<std::size_t>(n - 1)]
                            : n == k_rotor_blades ? k_blades
                                                  : 0.0;
    if (strength > 0.0) sum += strength * room_for(n * pitch, sample_rate_hz_) * line;
    const double next = c2 * line - before;
    before = line;
    line = next;
  }
  return sum;
}

/// The balls on both rings, as they stand.
double HandpieceSound::bearings(double pitch) const noexcept {
  const auto line = [&](double place, double turns) {
    return room_for(k_bearing_balls * turns * pitch, sample_rate_hz_) *
           std::sin(2.0 * std::numbers::pi * k_bearing_balls * place);
  };
  return line(cage_, k_cage_turns) + 0.6 * line(turn_ - cage_, 1.0 - k_cage_turns);
}

void HandpieceSound::render(const SoundParameters& target, std::span<float> out) noexcept {
  const Levels to = levels_of(target);
  const auto glide = [](double& now, double goal, double share, double close) {
    now += (goal - now) * share;
    if (std::fabs(goal - now) < close) now = goal;
  };
  const bool let_go = target.load_n <= 0.0;
  for (float& sample : out) {
    glide(now_.pitch_hz, to.pitch_hz,
          let_go && to.pitch_hz < now_.pitch_hz ? run_down_ : glide_pitch_, 1.0);
    glide(now_.bearing, to.bearing, glide_level_, 1e-6);
    glide(now_.spray, to.spray, glide_level_, 1e-6);
    glide(now_.suction, to.suction, glide_level_, 1e-6);
    glide(now_.enamel, to.enamel, glide_level_, 1e-6);
    glide(now_.dentin, to.dentin, glide_level_, 1e-6);
    glide(now_.volume, to.volume, glide_level_, 1e-6);
    // grains bite unevenly: the grinding swells and fades some forty times a second
    const double bite = std::max(0.0, 1.0 + 0.4 * rough_.next(noise()));
    const double hard = 0.8 * enamel_[0].next(noise()) + 0.6 * enamel_[1].next(noise());
    const double dull = 0.8 * dentin_[0].next(noise()) + 0.6 * dentin_[1].next(noise());
    const double speed = std::min(
        2.0, now_.pitch_hz * 60.0 /
                 k_reference_rpm);  // as it turns now: a rotor that runs down is heard to the end
    const double rotor =
        speed * (k_whine * whine(now_.pitch_hz) + now_.bearing * bearings(now_.pitch_hz)) +
        speed * speed * k_hiss * air_.next(noise());
    const double water = now_.spray * (spray_[0].next(noise()) + spray_[1].next(noise()));
    const double taken_up =
        now_.suction * (suction_[0].next(noise()) + 0.6 * suction_[1].next(noise()));
    const double sum =
        now_.volume * (rotor + water + taken_up + bite * (now_.enamel * hard + now_.dentin * dull));
    constexpr double k_knee = 0.8;  // louder peaks are rounded off below 1
    const double size = std::fabs(sum);
    sample = static_cast<float>(
        size <= k_knee
            ? sum
            : std::copysign(k_knee + (1.0 - k_knee) * std::tanh((size - k_knee) / (1.0 - k_knee)),
                            sum));
  }
}

}  // namespace cavum::ui
