// Plays the handpiece's sound through OpenAL, from a thread of its own and in small blocks. It
// never stands in the way of anything: without a sound device it is silent and says why, and
// setting what is heard is one atomic store.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include "ui/sound/handpiece_sound.h"

namespace cavum::ui {

/// What the output is doing.
struct SoundReport {
  bool playing = false;
  std::string device;       ///< its name, when there is one
  std::string silent_why;   ///< empty while opening or playing
  double latency_ms = 0.0;  ///< from setting parameters to hearing them begin, at most: the queue,
                            ///< and what the device says of itself
  std::int64_t blocks = 0;  ///< handed to the device
  std::int64_t dropouts = 0;  ///< times the device had played everything before the next block came
};

class SoundOutput {
 public:
  static constexpr int k_sample_rate_hz = 48000;
  static constexpr int k_block_samples = 256;  ///< 5.3 ms

  /// Begins to open the device, on its own thread, and returns at once. Never throws for want of
  /// sound. Sets ALSOFT_CONF (short periods) and ALSOFT_LOGLEVEL when they are not set, so make it
  /// before other threads read the environment.
  SoundOutput();
  /// Fades out and closes the device. One that hangs is left behind after a second.
  ~SoundOutput();
  SoundOutput(const SoundOutput&) = delete;
  SoundOutput& operator=(const SoundOutput&) = delete;

  /// What is to be heard from the next block on; the volume in it is ignored. Any thread, never
  /// waits.
  void set(const SoundParameters& parameters) noexcept;
  void set_muted(bool muted) noexcept;
  [[nodiscard]] SoundReport report() const;

 private:
  struct Shared;
  static void run(const std::shared_ptr<Shared>& shared) noexcept;
  std::shared_ptr<Shared> shared_;  // with the thread, which outlives this when a driver hangs
  std::thread thread_;
};

}  // namespace cavum::ui
