#include "ui/station/station_device.h"

#include <cmath>

#include "engine/base/error.h"
#include "engine/device/simulated_stylus.h"
#include "ui/parts/live_source.h"

namespace cavum::station {
namespace {

/// Before the exam its hand rests on the finger rest, and its foot tries the pedal once.
HandIntent resting(Vec3 at, double t_s) {
  const double tremor_mm = 0.25;
  at += Vec3{tremor_mm * std::sin(9.0 * t_s), tremor_mm * std::sin(7.0 * t_s + 1.0), 0};
  const double pressed = t_s > 0.4 && t_s < 0.9 ? 1.0 : 0.0;
  return {at, pressed};
}

class SimulatedHand final : public StationDevice {
 public:
  explicit SimulatedHand(DeviceChoice choice) : choice_(std::move(choice)) {
    static_cast<void>(scenarios::make_skill(choice_.operator_name, choice_.seed));
  }
  [[nodiscard]] MotionSource source() const override {
    return {SourceKind::simulated_operator, choice_.operator_name};
  }
  [[nodiscard]] double position_quantum_mm() const override { return OmniModel{}.quantum_mm; }
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> notes() const override {
    return {{"operator", choice_.operator_name}, {"operator_seed", std::to_string(choice_.seed)}};
  }
  void prepare(const scenarios::ExamSetup& setup) override {
    candidate_ = scenarios::make_candidate_device(setup, choice_.operator_name, choice_.seed);
    const Vec3 at = candidate_->start_mm();
    resting_ = std::make_unique<SimulatedStylus>(OmniModel{}, HandModel{}, k_tick_s,
                                                 [at](double t_s) { return resting(at, t_s); });
  }
  [[nodiscard]] ServoDevice& for_check() override { return *resting_; }
  [[nodiscard]] ServoDevice& for_exam() override { return *candidate_; }
  [[nodiscard]] Pose start() const override { return {candidate_->start_mm(), {}}; }
  [[nodiscard]] Vec3 tip_mm() override { return candidate_->start_mm(); }
  [[nodiscard]] bool simulated() const override { return true; }
  [[nodiscard]] bool done() const override { return candidate_->done(); }

 private:
  DeviceChoice choice_;
  std::unique_ptr<scenarios::CandidateDevice> candidate_;
  std::unique_ptr<SimulatedStylus> resting_;
};

class Mouse final : public StationDevice {
 public:
  explicit Mouse(const StylusKind& kind) : kind_(kind) {}
  [[nodiscard]] MotionSource source() const override {
    return {SourceKind::pointer, kind_.facts.id};
  }
  [[nodiscard]] double position_quantum_mm() const override {
    return kind_.facts.position_quantum_mm;
  }
  void prepare(const scenarios::ExamSetup& setup) override {
    constexpr double k_above_mm = 4.0;
    const scenarios::ZoneMap& zones = setup.zones;
    const Vec3 middle = (zones.target_low_mm() + zones.target_high_mm()) * 0.5;
    const Vec3 opening = zones.facing().lateral()
                             ? middle + zones.approach() * zones.below_opening_mm(middle)
                             : Vec3{middle.x, middle.y, zones.opening_z_mm()};
    first_.tip_mm = opening + zones.approach() * k_above_mm;
    first_.rotation = rotation_between({0, 0, 1}, zones.approach());
    stylus_ = std::make_unique<PointerStylus>(pointer_omni(), HandModel{}, k_tick_s, first_);
  }
  [[nodiscard]] ServoDevice& for_check() override { return *stylus_; }
  [[nodiscard]] ServoDevice& for_exam() override { return *stylus_; }
  [[nodiscard]] Pose start() const override { return {first_.tip_mm, first_.rotation}; }
  [[nodiscard]] Vec3 tip_mm() override { return stylus_->read(0.0).pose.tip_mm; }
  [[nodiscard]] PointerStylus* pointer() override { return stylus_.get(); }

 private:
  const StylusKind& kind_;
  PointerIntent first_;
  std::unique_ptr<PointerStylus> stylus_;
};

/// A stylus that is plugged in, with the station's pedal.
class PluggedIn final : public StationDevice {
 public:
  explicit PluggedIn(const DeviceChoice& choice)
      : source_(ui::open_live_source({choice.name, "", 1, ""})) {}
  [[nodiscard]] MotionSource source() const override { return source_->source(); }
  [[nodiscard]] double position_quantum_mm() const override {
    return source_->position_quantum_mm();
  }
  [[nodiscard]] double peak_n() const override { return source_->peak_n(); }
  [[nodiscard]] double continuous_n() const override { return source_->continuous_n(); }
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> notes() const override {
    return source_->notes();
  }
  void prepare(const scenarios::ExamSetup& setup) override { source_->begin(setup); }
  [[nodiscard]] ServoDevice& for_check() override { return source_->device(); }
  [[nodiscard]] ServoDevice& for_exam() override { return source_->device(); }
  [[nodiscard]] Pose start() const override { return {source_->first_tip_mm(), {}}; }
  [[nodiscard]] Vec3 tip_mm() override {
    const DeviceReading now = source_->device().read(k_tick_s);
    return is_finite(now.pose.tip_mm) ? now.pose.tip_mm : source_->first_tip_mm();
  }
  [[nodiscard]] std::optional<Error> problem() const override { return source_->problem(); }

 private:
  std::unique_ptr<ui::LiveSource> source_;
};

}  // namespace

const StylusKind& station_stylus_kind(const std::string& name) {
  return stylus_kinds().at(name, Name{"--device " + name},
                           {StylusHand::candidate, StylusHand::mouse, StylusHand::person});
}

std::unique_ptr<StationDevice> make_station_device(const DeviceChoice& choice) {
  const StylusKind& kind = station_stylus_kind(choice.name);
  switch (kind.hand) {
    case StylusHand::candidate:
      return std::make_unique<SimulatedHand>(choice);
    case StylusHand::mouse:
      return std::make_unique<Mouse>(kind);
    case StylusHand::person:
      break;
  }
  return std::make_unique<PluggedIn>(choice);
}

}  // namespace cavum::station
