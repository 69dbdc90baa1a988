#include "ui/parts/live_source.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include "engine/device/device_error.h"
#include "engine/device/hardware/hid_pedal.h"
#include "engine/device/hardware/open_stylus.h"
#include "engine/device/hardware/station_pedal.h"
#include "engine/device/selfcheck/check_history.h"
#include "engine/device/selfcheck/check_note.h"
#include "engine/device/with_desk.h"
#include "engine/device/with_pedal.h"
#include "scenarios/operators/candidate_device.h"
#include "ui/parts/interrupt.h"
#include "ui/parts/say.h"

namespace cavum::ui {
namespace {

class SimulatedSource final : public LiveSource {
 public:
  explicit SimulatedSource(LiveSourceOptions options) : options_(std::move(options)) {}
  [[nodiscard]] MotionSource source() const override {
    return {SourceKind::simulated_operator, options_.operator_name};
  }
  [[nodiscard]] double position_quantum_mm() const override { return OmniModel{}.quantum_mm; }
  [[nodiscard]] Notes notes() const override {
    return {{"operator", options_.operator_name},
            {"operator_seed", std::to_string(options_.seed)},
            {"in_real_time", "yes"}};
  }
  void begin(const scenarios::ExamSetup& setup) override {
    candidate_ = scenarios::make_candidate_device(setup, options_.operator_name, options_.seed);
  }
  [[nodiscard]] ServoDevice& device() override { return *candidate_; }
  [[nodiscard]] Vec3 first_tip_mm() const override { return candidate_->start_mm(); }
  [[nodiscard]] bool done() const override { return candidate_->done(); }

 private:
  LiveSourceOptions options_;
  std::unique_ptr<scenarios::CandidateDevice> candidate_;
};

class StylusSource final : public LiveSource {
 public:
  StylusSource(LiveSourceOptions options, const StylusKind& kind) : options_(std::move(options)) {
    stylus_options_.station = load_station_stylus(kind);
    stylus_ = kind.open(stylus_options_);
    station_pedal_ = require_pedal();
    const auto& p = station_pedal_;
    pedal_ = std::make_unique<HidPedal>(p.vendor, p.product, p.calibration);
    with_pedal_ = std::make_unique<WithPedal>(*stylus_, *pedal_);
    with_desk_ = std::make_unique<WithDesk>(*with_pedal_, desk_);
  }
  [[nodiscard]] MotionSource source() const override {
    return {SourceKind::device, stylus_->facts().id, stylus_->facts().serial};
  }
  [[nodiscard]] double position_quantum_mm() const override {
    return stylus_->facts().position_quantum_mm;
  }
  [[nodiscard]] double peak_n() const override { return stylus_->facts().peak_n; }
  [[nodiscard]] double continuous_n() const override { return stylus_->facts().continuous_n; }
  [[nodiscard]] Notes notes() const override {
    Notes notes{{"stylus", stylus_->facts().id},
                {"stylus_calibration", to_toml(stylus_options_.station)},
                {"pedal_calibration", to_toml(station_pedal_)}};
    const std::string checked = CheckHistory(check_history_path())
                                    .session_note({stylus_->facts().id, stylus_->facts().serial});
    if (!checked.empty()) notes.emplace_back(k_self_check_note, checked);
    return notes;
  }
  void begin(const scenarios::ExamSetup& setup) override {
    if (!options_.bur.empty()) {
      const auto at = std::find(setup.bur_names.begin(), setup.bur_names.end(), options_.bur);
      if (at == setup.bur_names.end())
        throw Error(Name{"--bur " + options_.bur}, msg("is not on this scenario's tray"),
                    msg("name one of its burs"));
      desk_.bur = static_cast<int>(at - setup.bur_names.begin());
    }
    using Clock = std::chrono::steady_clock;
    constexpr auto k_patience = std::chrono::seconds(60);
    Message told;
    for (const auto until = Clock::now() + k_patience; Clock::now() < until;
         std::this_thread::sleep_for(std::chrono::milliseconds(20))) {
      const std::optional<Error> now = stylus_->health().problem;
      if (!now) break;
      if (Interrupt::asked())
        throw Error(msg("exam"), msg("was interrupted before it began"), msg("begin it again"));
      if (now->message() == told) continue;
      told = now->message();
      say_error(told);
    }
    first_mm_ = first_pose(*stylus_, 1.0).tip_mm;
  }
  [[nodiscard]] ServoDevice& device() override { return *with_desk_; }
  [[nodiscard]] Vec3 first_tip_mm() const override { return first_mm_; }
  [[nodiscard]] bool done() const override { return false; }
  [[nodiscard]] std::optional<Error> problem() const override {
    std::optional<Error> stylus = stylus_->health().problem;
    return stylus ? stylus : pedal_->problem();
  }

 private:
  static StationPedal require_pedal() {
    auto pedal = load_station_pedal(station_pedal_path());
    if (!pedal)
      throw Error(
          DeviceError::no_pedal, msg("stylus"),
          msg("this station has no foot pedal, and without one the handpiece stands still"),
          msg("plug one in and run `cavum devices --calibrate-pedal`; `cavum devices` shows what is plugged in, stylus and pedal"));
    return *pedal;
  }

  LiveSourceOptions options_;
  StationPedal station_pedal_;
  StylusOptions stylus_options_;
  std::unique_ptr<Stylus> stylus_;
  std::unique_ptr<HidPedal> pedal_;
  std::unique_ptr<WithPedal> with_pedal_;
  Desk desk_;
  std::unique_ptr<WithDesk> with_desk_;
  Vec3 first_mm_;
};

}  // namespace

std::unique_ptr<LiveSource> open_live_source(const LiveSourceOptions& options) {
  const StylusKind& kind = stylus_kinds().at(options.device, Name{"--device " + options.device},
                                             {StylusHand::candidate, StylusHand::person});
  if (kind.hand == StylusHand::candidate) {
    if (options.operator_name.empty())
      throw Error(Name{"--device simulated"}, msg("needs a hand"),
                  msg("add --operator expert, novice, perforator or careless"));
    if (!options.bur.empty())
      throw Error(Name{"--bur"}, msg("is for a stylus in a hand"),
                  msg("leave it out: the operator chooses the bur that fits"));
    return std::make_unique<SimulatedSource>(options);
  }
  if (!options.operator_name.empty())
    throw Error(Name{"--operator " + options.operator_name}, msg("holds only the simulated stylus"),
                msg("leave it out, or take --device simulated"));
  return std::make_unique<StylusSource>(options, kind);
}

}  // namespace cavum::ui
