// The handpiece's sound by its spectrum, from the generator alone and through OpenAL into a file.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <complex>
#include <cstdio>
#include <cstring>
#include <thread>

#include "engine/base/file.h"
#include "engine/base/random.h"
#include "tests/engine/support/basics.h"
#include "ui/sound/handpiece_sound.h"
#include "ui/sound/sound_output.h"

namespace cavum::ui {
namespace {

using namespace std::chrono_literals;
constexpr double k_rate_hz = 48000.0, k_pi = 3.141592653589793;
using Samples = std::vector<float>;

SoundParameters idle(double rpm) { return {rpm, 0.0, false, 0.0, 0.0, 1.0, 0.0, 0.0}; }
SoundParameters cutting(double rpm, double load_n, double enamel, double dentin) {
  return {rpm, load_n, true, enamel, dentin, 1.0, 0.0, 0.0};
}
/// The same with water, and what takes it away.
SoundParameters wet(SoundParameters p) {
  p.spray = p.suction = 1.0;
  return p;
}

Samples render(HandpieceSound& sound, const SoundParameters& parameters, double seconds) {
  Samples samples(static_cast<std::size_t>(seconds * k_rate_hz));
  sound.render(parameters, samples);
  return samples;
}
/// Once all glides are over.
Samples steady(const SoundParameters& parameters, double seconds, std::uint64_t seed = 1) {
  HandpieceSound sound(k_rate_hz, seed);
  (void)render(sound, parameters, 0.4);
  return render(sound, parameters, seconds);
}

/// Power by frequency: the mean over halfway overlapping Hann windows of 4096 samples.
class Spectrum {
 public:
  static constexpr std::size_t k_size = 4096;
  Spectrum(std::span<const float> samples, double rate_hz)
      : bin_hz_(rate_hz / k_size), power_(k_size / 2, 0.0) {
    int windows = 0;
    for (std::size_t first = 0; first + k_size <= samples.size(); first += k_size / 2, ++windows) {
      std::vector<std::complex<double>> x(k_size);
      for (std::size_t i = 0; i < k_size; ++i)
        x[i] =
            samples[first + i] * (0.5 - 0.5 * std::cos(2 * k_pi * static_cast<double>(i) / k_size));
      transform(x);
      for (std::size_t i = 0; i < power_.size(); ++i) power_[i] += std::norm(x[i]);
    }
    for (double& p : power_) p /= std::max(1, windows);
  }
  /// Frequency of the strongest line, between bins by the parabola through its neighbours.
  [[nodiscard]] double peak_hz(double from_hz = 300, double to_hz = 20000) const {
    std::size_t best = bin(from_hz);
    for (std::size_t i = best; i < bin(to_hz); ++i)
      if (power_[i] > power_[best]) best = i;
    const double a = std::log(power_[best - 1]), b = std::log(power_[best]),
                 c = std::log(power_[best + 1]);
    return (static_cast<double>(best) + 0.5 * (a - c) / (a - 2 * b + c)) * bin_hz_;
  }
  /// Mean power a bin between two frequencies, dB, without what lies within 100 Hz of the pitch's
  /// multiples.
  [[nodiscard]] double between_lines_db(double from_hz, double to_hz, double pitch) const {
    double sum = 0.0;
    int n = 0;
    for (std::size_t i = bin(from_hz); i < bin(to_hz); ++i) {
      const double turns = static_cast<double>(i) * bin_hz_ / pitch;
      if (std::fabs(turns - std::round(turns)) * pitch < 100.0) continue;
      sum += power_[i];
      ++n;
    }
    return 10.0 * std::log10(sum / std::max(1, n) + 1e-30);
  }
  [[nodiscard]] double power_at(double hz) const { return power_[bin(hz)]; }
  [[nodiscard]] double bin_hz() const { return bin_hz_; }
  /// How much a line stands out from what lies 150 to 250 Hz beside it, dB.
  [[nodiscard]] double line_db(double hz) const {
    double most = 0.0, beside = 0.0;
    for (double d = -30; d <= 30; d += bin_hz_) most = std::max(most, power_at(hz + d));
    for (double d = 150; d <= 250; d += bin_hz_)
      beside = std::max({beside, power_at(hz - d), power_at(hz + d)});
    return 10.0 * std::log10(most / beside);
  }

 private:
  [[nodiscard]] std::size_t bin(double hz) const {
    return static_cast<std::size_t>(hz / bin_hz_ + 0.5);
  }
  static void transform(std::vector<std::complex<double>>& x) {
    for (std::size_t i = 1, j = 0; i < x.size(); ++i) {
      std::size_t bit = x.size() >> 1;
      for (; (j & bit) != 0; bit >>= 1) j ^= bit;
      j ^= bit;
      if (i < j) std::swap(x[i], x[j]);
    }
    for (std::size_t n = 2; n <= x.size(); n *= 2)
      for (std::size_t i = 0; i < x.size(); i += n)
        for (std::size_t k = 0; k < n / 2; ++k) {
          const auto turned =
              x[i + k + n / 2] *
              std::polar(1.0, -2 * k_pi * static_cast<double>(k) / static_cast<double>(n));
          x[i + k + n / 2] = x[i + k] - turned;
          x[i + k] += turned;
        }
  }
  double bin_hz_;
  std::vector<double> power_;
};

/// How much more there is of the noise between the lines above 1 kHz than in dull dentin's band:
/// the timbre, dB.
double sharpness_db(const Spectrum& s, double pitch) {
  return s.between_lines_db(5500, 9500, pitch) - s.between_lines_db(700, 3000, pitch);
}

/// A click holds all frequencies: the largest of what lies near half the sample rate, where the
/// handpiece itself has next to nothing.
double click_size(std::span<const float> samples) {
  // the sixth difference passes the highest frequencies alone
  constexpr std::array<double, 7> k_weights{1, -6, 15, -20, 15, -6, 1};
  double worst = 0.0;
  for (std::size_t i = 6; i < samples.size(); ++i) {
    double high = 0.0;
    for (std::size_t k = 0; k < 7; ++k) high += k_weights[k] / 64.0 * samples[i - k];
    worst = std::max(worst, std::fabs(high));
  }
  return worst;
}

double largest_step(std::span<const float> samples) {
  double largest = 0.0;
  for (std::size_t i = 1; i < samples.size(); ++i)
    largest = std::max(largest, std::fabs(double{samples[i]} - samples[i - 1]));
  return largest;
}

void write_wav(const std::string& path, std::span<const float> samples) {
  ByteWriter out;
  const auto text = [&](const char* four) {
    out.put_bytes(std::span(reinterpret_cast<const std::uint8_t*>(four), 4));
  };
  const auto bytes = static_cast<std::uint32_t>(2 * samples.size()),
             rate = static_cast<std::uint32_t>(k_rate_hz);
  text("RIFF");
  out.put(bytes + 36);
  text("WAVE");
  text("fmt ");
  out.put(std::uint32_t{16});
  out.put(std::uint16_t{1});  // whole numbers
  out.put(std::uint16_t{1});  // mono
  out.put(rate);
  out.put(rate * 2);
  out.put(std::uint16_t{2});
  out.put(std::uint16_t{16});
  text("data");
  out.put(bytes);
  for (const float s : samples) out.put(static_cast<std::int16_t>(std::lround(s * 32767.0f)));
  write_file(path, out.take());
}

struct Wav {
  double rate_hz = 0.0;
  Samples left;
};
/// Reads 16-bit files, of which only the first channel.
Wav read_wav(const std::string& path) {
  const Bytes file = read_file(path);
  const auto at = [&](std::size_t i, auto value) {
    std::memcpy(&value, file.data() + i, sizeof value);
    return value;
  };
  Wav wav;
  std::size_t channels = 0;
  int bits = 0;
  for (std::size_t i = 12; i + 8 <= file.size();) {
    const auto size = at(i + 4, std::uint32_t{});
    if (std::memcmp(file.data() + i, "fmt ", 4) == 0) {
      channels = at(i + 10, std::uint16_t{});
      wav.rate_hz = at(i + 12, std::uint32_t{});
      bits = at(i + 22, std::uint16_t{});
    }
    if (std::memcmp(file.data() + i, "data", 4) == 0 && channels > 0 && bits == 16)
      for (std::size_t s = i + 8; s + 2 * channels <= std::min(file.size(), i + 8 + size);
           s += 2 * channels)
        wav.left.push_back(static_cast<float>(at(s, std::int16_t{})) / 32768.0f);
    i += 8 + size + (size & 1);
  }
  return wav;
}

TEST(HandpieceSound, PitchFollowsSpeed) {
  for (const double rpm : {30000.0, 100000.0, 200000.0, 300000.0, 400000.0}) {
    const double peak = Spectrum(steady(idle(rpm), 0.5), k_rate_hz).peak_hz();
    EXPECT_NEAR(peak, rpm / 60.0, 3.0) << rpm;  // a bin is 12 Hz
  }
}

TEST(HandpieceSound, LoadLowersThePitch) {
  const double free_hz = 200000.0 / 60.0;
  double before = free_hz + 1.0;
  for (const double load : {0.0, 0.5, 1.0, 2.0, 3.3}) {
    const double peak =
        Spectrum(steady(cutting(200000, load, 0.5, 0.5), 0.5), k_rate_hz).peak_hz(1000, 4000);
    EXPECT_NEAR(peak, free_hz * (1.0 - load / k_stall_load_n), 5.0) << load;
    EXPECT_LT(peak, before);
    before = peak;
  }
}

// In every one of many short moments, at random speeds and loads: two classes are apart when the
// nearest of them still are.
TEST(HandpieceSound, IdleEnamelAndDentinAreTellableApartInAnyTenthOfASecond) {
  Random random(testing_basics::drawn_seed(
      "HandpieceSound.IdleEnamelAndDentinAreTellableApartInAnyTenthOfASecond"));
  double loudest_idle = -1e9, softest_cut = 1e9, sharpest_dentin = -1e9, dullest_enamel = 1e9;
  for (int i = 0; i < 60; ++i) {
    const double rpm = random.uniform(120000, 200000), load = random.uniform(0.4, 2.5),
                 pitch = pitch_hz(rpm, load);
    const auto seed = random.next();
    const double short_s = 0.13;
    const auto heard = [&](const SoundParameters& p) {
      return Spectrum(steady(i % 2 == 0 ? p : wet(p), short_s, seed), k_rate_hz);
    };
    const Spectrum still = heard(idle(rpm)), enamel = heard(cutting(rpm, load, 1, 0)),
                   dentin = heard(cutting(rpm, load, 0, 1));
    loudest_idle = std::max(loudest_idle, still.between_lines_db(700, 9500, rpm / 60.0));
    softest_cut = std::min({softest_cut, enamel.between_lines_db(700, 9500, pitch),
                            dentin.between_lines_db(700, 9500, pitch)});
    sharpest_dentin = std::max(sharpest_dentin, sharpness_db(dentin, pitch));
    dullest_enamel = std::min(dullest_enamel, sharpness_db(enamel, pitch));
  }
  std::printf(
      "noise between the lines: cutting at least %.1f dB over idle; sharpness: enamel at least %.1f dB over dentin\n",
      softest_cut - loudest_idle, dullest_enamel - sharpest_dentin);
  EXPECT_GT(softest_cut - loudest_idle, 3.0);
  EXPECT_GT(dullest_enamel - sharpest_dentin, 12.0);
}

TEST(HandpieceSound, AMixtureLiesBetweenItsTissues) {
  const double pitch = pitch_hz(200000, 1);
  double before = 1e9;
  for (const double enamel : {1.0, 0.5, 0.0}) {
    const double sharp = sharpness_db(
        Spectrum(steady(cutting(200000, 1, enamel, 1 - enamel), 1.0), k_rate_hz), pitch);
    EXPECT_LT(sharp, before - 6.0);
    before = sharp;
  }
}

TEST(HandpieceSound, IsSilentMutedOrStandingStill) {
  HandpieceSound sound(k_rate_hz);
  for (const float s : render(sound, SoundParameters{}, 0.2))
    ASSERT_EQ(s, 0.0f);  // before anything turned
  auto muted = cutting(200000, 1, 1, 0);
  (void)render(sound, muted, 0.5);
  muted.volume = 0.0;
  (void)render(sound, muted, 0.5);
  for (const float s : render(sound, muted, 0.2)) ASSERT_EQ(s, 0.0f);
  (void)render(sound, wet(idle(200000)), 0.5);
  (void)render(sound, idle(0), 6.0);  // it runs down
  for (const float s : render(sound, idle(0), 0.2)) ASSERT_EQ(s, 0.0f);
}

double rms(const Samples& samples) {
  double sum = 0.0;
  for (const float s : samples) sum += double{s} * s;
  return std::sqrt(sum / static_cast<double>(samples.size()));
}

TEST(HandpieceSound, LetGoItRunsDownAndALoadStopsItSooner) {
  for (const double load : {0.0, 1.0}) {
    HandpieceSound sound(k_rate_hz);
    (void)render(sound, idle(200000), 0.5);
    SoundParameters off = idle(0);
    off.load_n = load;
    (void)render(sound, off, 0.2);
    const Samples later = render(sound, off, 0.1);
    if (load > 0.0) {
      EXPECT_LT(rms(later), 1e-3);
      continue;
    }
    // exp(-0.25 s / 0.5 s) of the pitch, within what it falls in the tenth of a second
    EXPECT_NEAR(Spectrum(later, k_rate_hz).peak_hz(),
                200000 / 60.0 * std::exp(-0.25 / k_run_down_s), 200.0);
    EXPECT_GT(rms(later), 0.01);
  }
}

// A line of even turns is as narrow as the window; one whose speed wanders is not, and keeps its
// middle.
TEST(HandpieceSound, TheSpeedIsNeverQuiteEven) {
  const double hz = 200000 / 60.0;
  Samples even(static_cast<std::size_t>(k_rate_hz));
  for (std::size_t i = 0; i < even.size(); ++i)
    even[i] =
        static_cast<float>(0.1 * std::sin(2 * k_pi * hz * static_cast<double>(i) / k_rate_hz));
  const auto skirt_db = [&](const Samples& samples) {
    const Spectrum s(samples, k_rate_hz);
    return 10.0 * std::log10(s.power_at(hz + 5 * s.bin_hz()) / s.power_at(hz));
  };
  const double turbine = skirt_db(steady(idle(200000), 1.0));
  std::printf("60 Hz beside its line: turbine %.1f dB, an even line %.1f dB\n", turbine,
              skirt_db(even));
  EXPECT_GT(turbine, skirt_db(even) + 6.0);
  EXPECT_LT(turbine, -15.0);
}

// The balls pass the outer ring 2.8 times a turn, the inner one 4.2 times: equations of bearing
// diagnosis for 7 balls of a fifth.
TEST(HandpieceSound, BearingsAreHeardWhereTheirBallsPassAndLouderUnderLoad) {
  for (const double load : {0.0, 2.0}) {
    SoundParameters p = idle(180000);
    p.load_n = load;
    const double turn = pitch_hz(180000, load);
    const Spectrum s(steady(p, 1.0), k_rate_hz);
    EXPECT_GT(s.line_db(2.8 * turn), load > 0.0 ? 10.0 : 3.0) << load;
    EXPECT_GT(s.line_db(4.2 * turn), load > 0.0 ? 8.0 : 1.5) << load;
    EXPECT_LT(s.line_db(3.3 * turn), 6.0) << load << ": no line where none belongs";
  }
}

TEST(HandpieceSound, SprayHissesAndSuctionRushesBelowIt) {
  const double hz = 200000 / 60.0;
  SoundParameters water = idle(200000), taken = idle(200000);
  water.spray = taken.suction = 1.0;
  const Spectrum dry(steady(idle(200000), 1.0), k_rate_hz), spray(steady(water, 1.0), k_rate_hz),
      suction(steady(taken, 1.0), k_rate_hz);
  EXPECT_GT(spray.between_lines_db(10500, 13500, hz), dry.between_lines_db(10500, 13500, hz) + 2.0);
  EXPECT_GT(suction.between_lines_db(300, 1800, hz), dry.between_lines_db(300, 1800, hz) + 6.0);
  EXPECT_LT(suction.between_lines_db(10500, 13500, hz),
            dry.between_lines_db(10500, 13500, hz) + 1.0);
}

// Speed and volume jump, again and again. What a click is: a step of 0.15, planted in one sample,
// is found.
TEST(HandpieceSound, NeverClicks) {
  Random random(testing_basics::drawn_seed("HandpieceSound.NeverClicks"));
  HandpieceSound sound(k_rate_hz);
  const Samples fastest = steady(idle(200000), 2.0);
  const double steady_click = click_size(fastest), steady_step = largest_step(fastest);
  Samples all;
  for (int i = 0; i < 300; ++i) {
    SoundParameters p = idle(random.below(3) == 0 ? 0.0 : random.uniform(0, 200000));
    p.volume = random.below(4) == 0 ? 0.0 : 1.0;
    const Samples part = render(sound, p, 0.002 + 0.05 * random.uniform());
    all.insert(all.end(), part.begin(), part.end());
  }
  // the loudest of eight seconds of noise: by 1.32 in 2000 draws; the planted one by 1.64
  constexpr double k_click = 1.5;
  EXPECT_LT(click_size(all), k_click * steady_click);
  EXPECT_LT(largest_step(all), 1.2 * steady_step);
  Samples planted = steady(idle(200000), 0.5);
  for (std::size_t i = planted.size() / 2; i < planted.size(); ++i) planted[i] += 0.15f;
  EXPECT_GT(click_size(planted), k_click * steady_click);
}

// With one seed the noise is the same, so what cutting adds is the difference of two sounds.
TEST(HandpieceSound, CuttingBeginsAndEndsWithoutAClick) {
  for (const double enamel : {1.0, 0.0}) {
    HandpieceSound with(k_rate_hz), without(k_rate_hz);
    SoundParameters cut = cutting(200000, 2.0, enamel, 1 - enamel), still = cut;
    still.cutting = false;
    (void)render(with, still, 0.5);
    (void)render(without, still, 0.5);
    Samples begun = render(with, cut, 1.0), idle_then = render(without, still, 1.0),
            ended = render(with, still, 1.0), idle_now = render(without, still, 1.0);
    const auto largest_added = [](const Samples& a, const Samples& b, double from_s, double to_s) {
      float largest = 0.0f;
      for (auto i = static_cast<std::size_t>(from_s * k_rate_hz);
           i < static_cast<std::size_t>(to_s * k_rate_hz); ++i)
        largest = std::max(largest, std::fabs(a[i] - b[i]));
      return largest;
    };
    const double full = largest_added(begun, idle_then, 0.2, 1.0);
    EXPECT_GT(full, 0.1);
    EXPECT_LT(largest_added(begun, idle_then, 0.0, 0.001),
              0.06 * full);  // in 20 ms to 63 %: 5 % after a millisecond
    EXPECT_GT(largest_added(ended, idle_now, 0.0, 0.01), 0.2 * full);
    EXPECT_EQ(largest_added(ended, idle_now, 0.5, 1.0), 0.0f);
  }
}

TEST(HandpieceSound, NeverReachesItsLimits) {
  float largest = 0.0f;
  for (const double enamel : {1.0, 0.5, 0.0})
    for (const float s : steady(cutting(400000, 3.3, enamel, 1 - enamel), 5.0))
      largest = std::max(largest, std::fabs(s));
  EXPECT_LT(largest, 0.99f);
}

TEST(HandpieceSound, StaysSoundWhateverItIsGiven) {
  HandpieceSound sound(k_rate_hz);
  const double nan = std::nan(""), huge = 1e300;
  for (const double bad : {nan, huge, -huge, -1.0})
    for (const float s : render(sound, {bad, bad, true, bad, bad, bad, bad, bad}, 0.05))
      ASSERT_TRUE(std::isfinite(s) && std::fabs(s) <= 1.0f);
  EXPECT_NEAR(
      Spectrum((render(sound, idle(200000), 1.0), render(sound, idle(200000), 0.5)), k_rate_hz)
          .peak_hz(),
      200000 / 60.0, 3.0);
}

// Above half the sample rate lines would come back as false ones: eight blades at 200,000 rpm pass
// 26,667 times a second.
TEST(HandpieceSound, BladesAreHeardOnlyWhereTheyAreAudible) {
  const Spectrum slow(steady(idle(60000), 0.5), k_rate_hz),
      fast(steady(idle(200000), 0.5), k_rate_hz);
  const auto over_neighbours = [](const Spectrum& s, double hz) {
    return 10 * std::log10(s.power_at(hz) / (0.5 * (s.power_at(hz - 200) + s.power_at(hz + 200))));
  };
  EXPECT_GT(over_neighbours(slow, 8 * 1000.0), 15.0);
  EXPECT_LT(over_neighbours(fast, k_rate_hz - 8 * 200000 / 60.0), 6.0);
}

/// Runs `action` in a process of its own, for OpenAL reads its environment once. Returns its exit
/// code.
template <class Action>
int in_child(const Action& action) {
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    action();
    _exit(::testing::Test::HasFailure() ? 1 : 0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

TEST(SoundOutput, GoesThroughOpenAlAsItWasMade) {
  const testing_basics::Folder folder;
  const std::string file = folder.file("heard.wav");
  write_text_file(
      folder.file(".alsoftrc"),
      "[general]\ndrivers = wave\nchannels = mono\nsample-type = int16\nfrequency = 48000\ndither = false\n[wave]\nfile = " +
          file + "\n");
  ASSERT_EQ(
      in_child([&] {
        setenv("HOME", folder.path().c_str(), 1);
        unsetenv("ALSOFT_CONF");
        setenv("ALSOFT_DRIVERS", "wave", 1);
        SoundOutput out;
        const auto hear = [&](const SoundParameters& p) {
          out.set(p);
          std::this_thread::sleep_for(1s);
        };
        hear(idle(200000));
        hear(cutting(200000, 1, 1, 0));
        hear(cutting(200000, 1, 0, 1));
        for (int i = 0; i < 2; ++i)
          hear(idle(100000));  // the rotor runs down: two seconds to a hundredth
        hear(idle(100000));
        out.set_muted(true);
        std::this_thread::sleep_for(1s);
        const SoundReport report = out.report();
        EXPECT_TRUE(report.playing) << report.silent_why;
        EXPECT_GT(report.blocks, 100);
        std::printf(
            "through OpenAL (%s): %lld blocks of 5.3 ms, %lld dropouts, latency at most %.0f ms\n",
            report.device.c_str(), static_cast<long long>(report.blocks),
            static_cast<long long>(report.dropouts), report.latency_ms);
        std::fflush(nullptr);
      }),
      0);
  const Wav wav = read_wav(file);
  ASSERT_EQ(wav.rate_hz, 48000);
  ASSERT_GT(wav.left.size(), 3.5 * k_rate_hz);
  // the middle of each second, as far as a loaded machine has kept time
  const auto part = [&](int second) {
    const double scale = static_cast<double>(wav.left.size()) / 7.1;
    const auto from = static_cast<std::size_t>((second + 0.45) * scale),
               n = static_cast<std::size_t>(0.4 * scale);
    return std::span(wav.left).subspan(from, n);
  };
  const double loaded = pitch_hz(200000, 1);
  const Spectrum free_fast(part(0), 48000), enamel(part(1), 48000), dentin(part(2), 48000),
      free_slow(part(5), 48000);
  EXPECT_NEAR(free_fast.peak_hz(), 200000 / 60.0, 6.0);
  EXPECT_NEAR(enamel.peak_hz(1000, 4000), loaded, 6.0);
  EXPECT_NEAR(free_slow.peak_hz(), 100000 / 60.0, 6.0);
  EXPECT_GT(sharpness_db(enamel, loaded), sharpness_db(dentin, loaded) + 12.0);
  EXPECT_GT(enamel.between_lines_db(700, 9500, loaded),
            free_fast.between_lines_db(700, 9500, 200000 / 60.0) + 3.0);
  for (const float s : part(6)) ASSERT_EQ(s, 0.0f);

  // The same from the generator alone, as a file that can be listened to.
  HandpieceSound sound(k_rate_hz);
  Samples all;
  for (const auto& p :
       {idle(200000), cutting(200000, 1, 1, 0), cutting(200000, 1, 0, 1), idle(100000)}) {
    const Samples one = render(sound, p, 1.0);
    all.insert(all.end(), one.begin(), one.end());
  }
  const char* kept = std::getenv("CAVUM_SOUND_OUT");
  const std::string made = kept != nullptr ? kept : folder.file("made.wav");
  write_wav(made, all);
  const Wav again = read_wav(made);
  ASSERT_EQ(again.left.size(), all.size());
  for (std::size_t i = 0; i < all.size(); ++i) ASSERT_NEAR(again.left[i], all[i], 1e-4);
}

// A computer that stands still for half a second: the device plays everything that was queued, and
// more is asked for at once.
TEST(SoundOutput, GoesOnAfterAStall) {
  const testing_basics::Folder folder;
  write_text_file(folder.file(".alsoftrc"),
                  "[general]\ndrivers = wave\n[wave]\nfile = " + folder.file("heard.wav") + "\n");
  ASSERT_EQ(in_child([&] {
              setenv("HOME", folder.path().c_str(), 1);
              unsetenv("ALSOFT_CONF");
              setenv("ALSOFT_DRIVERS", "wave", 1);
              const pid_t self = getpid(), other = fork();
              if (other == 0) {
                std::this_thread::sleep_for(500ms);
                kill(self, SIGSTOP);
                std::this_thread::sleep_for(500ms);
                kill(self, SIGCONT);
                _exit(0);
              }
              SoundOutput out;
              out.set(idle(200000));
              waitpid(other, nullptr, 0);
              for (int i = 0; i < 1000 && out.report().dropouts == 0; ++i)
                std::this_thread::sleep_for(10ms);
              const SoundReport stalled = out.report();
              EXPECT_GT(stalled.dropouts, 0);
              for (int i = 0; i < 1000 && out.report().blocks < stalled.blocks + 50; ++i)
                std::this_thread::sleep_for(10ms);
              const SoundReport report = out.report();
              EXPECT_TRUE(report.playing);
              EXPECT_GE(report.blocks, stalled.blocks + 50);
              EXPECT_LT(report.blocks, 5000);  // no faster than they are played
            }),
            0);
}

TEST(SoundOutput, WithoutADeviceIsSilentAndSaysWhy) {
  const testing_basics::Folder folder;
  write_text_file(folder.file("alsoft.conf"),
                  std::string("[general]\ndrivers = oss\n[oss]\ndevice = /nowhere\n"));
  ASSERT_EQ(in_child([&] {
              setenv("ALSOFT_CONF", folder.file("alsoft.conf").c_str(), 1);
              setenv("ALSOFT_DRIVERS", "oss", 1);
              setenv("ALSOFT_LOGLEVEL", "0", 1);
              SoundOutput out;
              out.set(cutting(200000, 1, 1, 0));
              for (int i = 0; i < 1000 && out.report().silent_why.empty(); ++i)
                std::this_thread::sleep_for(10ms);
              const SoundReport report = out.report();
              EXPECT_FALSE(report.playing);
              EXPECT_FALSE(report.silent_why.empty());
              EXPECT_EQ(report.blocks, 0);
            }),
            0);
}

}  // namespace
}  // namespace cavum::ui
