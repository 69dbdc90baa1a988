#include "ui/sound/sound_output.h"

#include <AL/al.h>
#include <AL/alc.h>
#include <AL/alext.h>
#include <dlfcn.h>
#include <fmt/core.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <string_view>
#include <vector>

namespace cavum::ui {
namespace {

using namespace std::chrono_literals;

/// Parameters in one word, so that they are always of one moment: rpm in tens, load in mN, shares
/// in 255ths.
std::uint64_t pack(const SoundParameters& p) noexcept {
  const auto whole = [](double v, double most) {
    return static_cast<std::uint64_t>(std::isfinite(v) ? std::clamp(v, 0.0, most) + 0.5 : 0.0);
  };
  return whole(p.rpm / 10.0, 131000.0) | whole(p.load_n * 1000.0, 32000.0) << 17 |
         whole(p.enamel_share * 255.0, 255.0) << 32 | whole(p.dentin_share * 255.0, 255.0) << 40 |
         std::uint64_t{p.cutting} << 48;
}

SoundParameters unpack(std::uint64_t word) noexcept {
  SoundParameters p;
  p.rpm = static_cast<double>(word & 0x1ffff) * 10.0;
  p.load_n = static_cast<double>(word >> 17 & 0x7fff) / 1000.0;
  p.enamel_share = static_cast<double>(word >> 32 & 0xff) / 255.0;
  p.dentin_share = static_cast<double>(word >> 40 & 0xff) / 255.0;
  p.cutting = (word >> 48 & 1) != 0;
  return p;
}

/// OpenAL Soft takes its periods from its configuration alone, and 20 ms of them where nothing is
/// said. ALSOFT_CONF names a file that is read last: one in memory here, unless the user has one of
/// his own.
void ask_for_short_periods() noexcept {
  if (getenv("ALSOFT_CONF") != nullptr) return;
  constexpr std::string_view k_wish = "[general]\nperiod_size = 256\nperiods = 3\n";
  const int file = memfd_create("cavum-openal", MFD_CLOEXEC);
  if (file < 0 || write(file, k_wish.data(), k_wish.size()) != static_cast<ssize_t>(k_wish.size()))
    return;
  setenv("ALSOFT_CONF", fmt::format("/proc/self/fd/{}", file).c_str(),
         0);  // kept open: OpenAL may read it again
}

extern "C" void ignore_alsa(const char*, int, const char*, int, const char*, ...) {
}  // NOLINT(cert-dcl50-cpp): what ALSA calls

/// A computer without loudspeakers is said once, in our words (Player::failed): ALSA writes a dozen
/// lines to standard error otherwise.
void hush_alsa() noexcept {
  void* const alsa =
      dlopen("libasound.so.2", RTLD_NOW | RTLD_NODELETE);  // the one that OpenAL loads too
  if (alsa == nullptr) return;
  using Handler = void (*)(const char*, int, const char*, int, const char*, ...);
  if (const auto set = reinterpret_cast<int (*)(Handler)>(dlsym(alsa, "snd_lib_error_set_handler")))
    set(&ignore_alsa);
}

/// An open device with a source that plays what is queued.
class Player {
 public:
  Player() {
    hush_alsa();
    device_ = alcOpenDevice(nullptr);
    if (device_ == nullptr) {
      failed_ =
          "no sound device could be opened; plug in loudspeakers or headphones, or go on without sound";
      return;
    }
    const std::array<ALCint, 3> wish{ALC_FREQUENCY, SoundOutput::k_sample_rate_hz, 0};
    context_ = alcCreateContext(device_, wish.data());
    if (context_ == nullptr || alcMakeContextCurrent(context_) == ALC_FALSE) {
      failed_ =
          "the sound device refuses to play; see whether another program holds it, or go on without sound";
      return;
    }
    ALCint periods_a_second = 0;
    alcGetIntegerv(device_, ALC_REFRESH, 1, &periods_a_second);
    const double period =
        SoundOutput::k_sample_rate_hz / std::max(1.0, static_cast<double>(periods_a_second));
    // one period, which the device takes at once, and a block that is being made
    const double blocks = std::ceil(period / SoundOutput::k_block_samples) + 1.0;
    for (int i = 0; i < std::clamp(static_cast<int>(blocks), 3, k_max_blocks); ++i) add_block();
    alGenSources(1, &source_);
    alSourcei(source_, AL_SOURCE_RELATIVE, AL_TRUE);
    if (alGetError() != AL_NO_ERROR)
      failed_ = "the sound device gives no buffers; go on without sound";
    float_samples_ = alIsExtensionPresent("AL_EXT_float32") == AL_TRUE;
    if (alIsExtensionPresent("AL_SOFT_source_latency") == AL_TRUE)
      offset_and_latency_ =
          reinterpret_cast<LPALGETSOURCEDVSOFT>(alGetProcAddress("alGetSourcedvSOFT"));
  }
  ~Player() {
    if (context_ != nullptr) {
      alSourceStop(source_);
      alSourcei(source_, AL_BUFFER, 0);
      alDeleteSources(1, &source_);
      alDeleteBuffers(static_cast<ALsizei>(buffers_.size()), buffers_.data());
      alcMakeContextCurrent(nullptr);
      alcDestroyContext(context_);
    }
    if (device_ != nullptr) alcCloseDevice(device_);
  }
  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;

  [[nodiscard]] const std::string& failed() const { return failed_; }
  [[nodiscard]] std::string name() const {
    const ALCchar* name = alcGetString(device_, ALC_DEVICE_SPECIFIER);
    return name == nullptr ? "" : name;
  }
  [[nodiscard]] std::size_t blocks() const { return buffers_.size(); }
  [[nodiscard]] bool connected() const {
    if (alcIsExtensionPresent(device_, "ALC_EXT_disconnect") == ALC_FALSE) return true;
    ALCint connected = ALC_TRUE;
    alcGetIntegerv(device_, ALC_CONNECTED, 1, &connected);
    return connected != ALC_FALSE;
  }

  /// Takes back the buffers that were played. Once a round: a source that has stopped counts
  /// whatever is queued as played.
  void take_back() {
    ALint played = 0;
    alGetSourcei(source_, AL_BUFFERS_PROCESSED, &played);
    for (; played > 0; --played) {
      ALuint buffer = 0;
      alSourceUnqueueBuffers(source_, 1, &buffer);
      spare_.push_back(buffer);
    }
  }
  [[nodiscard]] bool wants_block() const { return !spare_.empty(); }
  void queue(std::span<const float> samples) {
    const ALuint buffer = spare_.back();
    spare_.pop_back();
    if (float_samples_) {
      alBufferData(buffer, AL_FORMAT_MONO_FLOAT32, samples.data(),
                   static_cast<ALsizei>(samples.size_bytes()), SoundOutput::k_sample_rate_hz);
    } else {
      std::vector<std::int16_t> whole(samples.size());
      std::transform(samples.begin(), samples.end(), whole.begin(),
                     [](float s) { return static_cast<std::int16_t>(std::lround(s * 32767.0f)); });
      alBufferData(buffer, AL_FORMAT_MONO16, whole.data(),
                   static_cast<ALsizei>(whole.size() * sizeof whole[0]),
                   SoundOutput::k_sample_rate_hz);
    }
    alSourceQueueBuffers(source_, 1, &buffer);
  }
  /// Plays on when everything had been played, from then on with a longer queue. True for such a
  /// dropout.
  bool play_on() {
    ALint state = 0;
    alGetSourcei(source_, AL_SOURCE_STATE, &state);
    if (state == AL_PLAYING) return false;
    alSourcePlay(source_);
    if (state == AL_INITIAL) return false;
    if (static_cast<int>(buffers_.size()) < k_max_blocks) add_block();
    return true;
  }
  /// Of the device behind the queue.
  [[nodiscard]] double device_latency_s() const {
    if (offset_and_latency_ == nullptr) return 0.0;
    std::array<ALdouble, 2> values{};
    offset_and_latency_(source_, AL_SEC_OFFSET_LATENCY_SOFT, values.data());
    return values[1];
  }

 private:
  static constexpr int k_max_blocks = 32;
  void add_block() {
    ALuint buffer = 0;
    alGenBuffers(1, &buffer);
    buffers_.push_back(buffer);
    spare_.push_back(buffer);
  }

  ALCdevice* device_ = nullptr;
  ALCcontext* context_ = nullptr;
  ALuint source_ = 0;
  std::vector<ALuint> buffers_, spare_;
  bool float_samples_ = false;
  LPALGETSOURCEDVSOFT offset_and_latency_ = nullptr;
  std::string failed_;
};

}  // namespace

struct SoundOutput::Shared {
  std::atomic<std::uint64_t> parameters{0};
  std::atomic<bool> muted{false}, stop{false};
  mutable std::mutex mutex;  // of what follows; never held while OpenAL is called
  SoundReport report;
  bool ended = false;
  std::condition_variable changed;

  [[nodiscard]] bool stopped() const noexcept { return stop.load(std::memory_order_acquire); }
  template <class Change>
  void tell(const Change& change) {
    const std::lock_guard lock(mutex);
    change(report);
  }
  void silent(const std::string& why) {
    tell([&](SoundReport& r) {
      r.playing = false;
      r.silent_why = why;
    });
  }
  /// What is to be heard now: nothing when muted or about to end.
  [[nodiscard]] SoundParameters wanted() const noexcept {
    SoundParameters now = unpack(parameters.load(std::memory_order_acquire));
    const bool quiet = stopped() || muted.load(std::memory_order_acquire);
    now.volume = quiet ? 0.0 : 1.0;
    return now;
  }
  void play(Player& player, HandpieceSound& sound);
};

/// Until the sound has faded after `stop`, or the device is gone.
void SoundOutput::Shared::play(Player& player, HandpieceSound& sound) {
  constexpr int k_blocks_to_fade = 20;
  std::array<float, k_block_samples> block;
  int faded = 0;  // blocks since `stop`
  const auto silence = [&] { return stopped() && faded > k_blocks_to_fade; };
  while (player.connected() && !silence()) {
    std::int64_t made = 0;
    player.take_back();
    while (player.wants_block() && !silence()) {
      sound.render(wanted(), block);
      player.queue(block);
      ++made;
      faded += stopped();
    }
    const bool dropout = player.play_on();
    tell([&](SoundReport& r) {
      r.blocks += made;
      r.dropouts += dropout;
      r.latency_ms =
          1000.0 * (static_cast<double>(player.blocks()) * k_block_samples / k_sample_rate_hz +
                    player.device_latency_s());
    });
    std::this_thread::sleep_for(2ms);
  }
}

SoundOutput::SoundOutput() : shared_(std::make_shared<Shared>()) {
  ask_for_short_periods();
  setenv("ALSOFT_LOGLEVEL", "0",
         0);  // OpenAL's complaints, as with ALSA's; here, for the environment is no thread's own
  try {
    thread_ = std::thread([shared = shared_] { run(shared); });
  } catch (const std::exception& e) {
    shared_->report.silent_why = fmt::format("no thread for the sound: {}", e.what());
    shared_->ended = true;
  }
}

SoundOutput::~SoundOutput() {
  shared_->stop.store(true, std::memory_order_release);
  std::unique_lock lock(shared_->mutex);
  shared_->changed.notify_all();
  const bool ended = shared_->changed.wait_for(lock, 1s, [&] { return shared_->ended; });
  lock.unlock();
  if (!thread_.joinable()) return;
  if (ended)
    thread_.join();
  else
    thread_.detach();
}

void SoundOutput::set(const SoundParameters& parameters) noexcept {
  shared_->parameters.store(pack(parameters), std::memory_order_release);
}
void SoundOutput::set_muted(bool muted) noexcept {
  shared_->muted.store(muted, std::memory_order_release);
}

SoundReport SoundOutput::report() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->report;
}

void SoundOutput::run(const std::shared_ptr<Shared>& shared) noexcept {
  try {
    HandpieceSound sound(k_sample_rate_hz);
    bool unplugged =
        false;  // a device that was there may come back; one that never was is not asked for again
    do {
      Player player;
      if (!player.failed().empty()) {
        shared->silent(player.failed());
      } else {
        shared->tell([&](SoundReport& r) {
          r.playing = true;
          r.device = player.name();
          r.silent_why.clear();
        });
        shared->play(player, sound);
        unplugged = !shared->stopped();
        if (unplugged)
          shared->silent("the sound device is gone; plug it in again, or go on without sound");
      }
      std::unique_lock lock(shared->mutex);
      shared->changed.wait_for(lock, unplugged ? 5s : 0s, [&] { return shared->stopped(); });
    } while (unplugged && !shared->stopped());
  } catch (const std::exception& e) {
    shared->silent(fmt::format("sound failed: {}", e.what()));
  }
  const std::lock_guard lock(shared->mutex);
  shared->ended = true;
  shared->changed.notify_all();
}

}  // namespace cavum::ui
