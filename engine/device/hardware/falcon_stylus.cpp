#include "engine/device/hardware/falcon_stylus.h"

#include <cstdlib>
#include <utility>

#include "engine/device/device_error.h"
#include "engine/device/hardware/usb_serial.h"
#include "engine/physics/servo/scheduling.h"

namespace cavum {
namespace {

constexpr std::uint8_t k_all_homed = 7;

std::string firmware_of(const StationStylus& station) {
  if (!station.text("firmware").empty()) return station.text("firmware");
  const char* named = std::getenv("CAVUM_FALCON_FIRMWARE");
  return named != nullptr ? named : "";
}

FalconDrive drive_of(const StationStylus& station) {
  FalconDrive drive;
  drive.arm_offset_rad = station.number("arm_offset_deg") * k_pi / 180.0;
  return drive;
}

StylusFacts falcon_facts() {
  return {.id = "falcon",
          .name = cavum::Name{"Novint Falcon"},
          .position_quantum_mm = k_falcon_quantum_mm,
          .peak_n = 8.9,
          .continuous_n = 2.0,
          .rate_hz = 1000.0,
          .reach_mm = 50.0,
          .measures_direction = false};
}

StylusFacts facts_of_this_one() {
  StylusFacts facts = falcon_facts();
  facts.serial = usb_serial(k_falcon_vendor, k_falcon_product);
  return facts;
}

}  // namespace

StylusKind falcon_kind() {
  StylusKind kind{.facts = falcon_facts(),
                  .placement = upright_device(k_falcon_middle_mm),
                  // sources say 35 to 50; no firmware: the file in $CAVUM_FALCON_FIRMWARE
                  .settings = {{.key = "arm_offset_deg", .usual = 35.0, .least = 0.0, .most = 90.0},
                               {.key = "firmware", .usual = ""}},
                  .usb = UsbNumbers{k_falcon_vendor, k_falcon_product}};
  kind.look = [](const StationStylus&, bool) { return look_for_falcon(); };
  kind.serial = [](const StationStylus&) { return usb_serial(k_falcon_vendor, k_falcon_product); };
  kind.open = [](const StylusOptions& options) -> std::unique_ptr<Stylus> {
    if (const StylusLook look = look_for_falcon(); look.there && look.problem)
      throw Error(*look.problem);
    return std::make_unique<FalconStylus>(options.station);
  };
  return kind;
}

FalconStylus::FalconStylus(const StationStylus& station)
    : ThreadedStylus(station, facts_of_this_one()),
      firmware_(firmware_of(station)),
      drive_(drive_of(station)) {
  start([this] { run(); });
}

void FalconStylus::run() {
  const UsbWatch watch;
  look_again_and_again([this] {
    FalconUsb usb;
    set_problem(stylus_error(facts_.id, DeviceError::starting, msg("is being started"),
                             msg("wait until its lights are on")));
    usb.start(firmware_);
    plugged_in_.fetch_add(1);
    serve(usb);
  });
}

std::array<std::int16_t, 3> FalconStylus::motors(const FalconAngles& angles, Vec3 at_mm) noexcept {
  bool cut = false, motors_cut = false;
  const Vec3 force = force_now(cut);
  std::array<Vec3, 3> columns;
  if (!falcon_jacobian(geometry_, angles, at_mm, columns)) return {};
  const auto counts = falcon_counts(drive_, falcon_torques_nmm(columns, force), motors_cut);
  if (cut || motors_cut) forces_cut_.fetch_add(1, std::memory_order_relaxed);
  return counts;
}

/// Until it is unplugged, or no longer wanted.
void FalconStylus::serve(FalconUsb& usb) {
  constexpr std::int64_t k_period_ns = 1'000'000;
  constexpr int k_patience_ms = 10, k_max_silent = 50;
  FalconCommand command{.lights = k_falcon_red, .homing = true};
  Vec3 at = k_falcon_middle_mm;
  int silent = 0;
  bool reported_homing = false, reported_ready = false;
  static_cast<void>(ask_for_fifo(
      69));  // as the servo, where the system allows it; its periods are in the health either way
  ask_for_sharp_timers();
  for (std::int64_t due = monotonic_ns();; sleep_until(due)) {
    if (is_to_stop()) break;
    due = std::max(due + k_period_ns, monotonic_ns() - k_period_ns);
    FalconAnswer answer;
    const auto heard = usb.exchange(command, answer, k_patience_ms);
    if (heard == FalconUsb::Heard::silence && ++silent < k_max_silent) continue;
    if (heard != FalconUsb::Heard::answer) {
      unplugged_.fetch_add(1);
      set_problem(stylus_error(facts_.id, DeviceError::lost, msg("was unplugged, or is silent"),
                               msg("plug in its USB cable and its power supply")));
      return;
    }
    silent = 0;
    if (answer.homed != k_all_homed) {
      command = {.lights = k_falcon_red, .homing = true};
      reported_ready = false;
      if (!std::exchange(reported_homing, true))
        set_problem(stylus_error(
            facts_.id, DeviceError::needs_homing, msg("does not know its place yet"),
            msg("pull its grip out as far as it goes and push it in, until the light is no longer red")));
      continue;
    }
    const FalconAngles angles = falcon_arm_angles(drive_, answer.encoders);
    Vec3 found = at;
    if (!falcon_position(geometry_, angles, found) &&
        (found = k_falcon_middle_mm, !falcon_position(geometry_, angles, found))) {
      command = {.lights = k_falcon_blue};
      continue;  // no such place: the encoders lie, and nothing is fresh
    }
    at = found;
    reported_homing = false;
    const auto buttons = static_cast<std::uint16_t>(((answer.buttons & 1) != 0 ? k_button_1 : 0) |
                                                    ((answer.buttons & 14) != 0 ? k_button_2 : 0));
    put({at, {}, buttons, monotonic_ns()});
    if (!std::exchange(reported_ready, true)) set_problem({});
    command = {.motors = motors(angles, at), .lights = k_falcon_green};
  }
  FalconAnswer ignored;
  static_cast<void>(
      usb.exchange({.lights = 0}, ignored, k_patience_ms));  // no force is left behind
}

}  // namespace cavum
