#include "engine/device/hardware/inverse3_stylus.h"

#include <algorithm>
#include <utility>

#include "engine/device/hardware/inverse3_link.h"
#include "engine/physics/servo/scheduling.h"

namespace cavum {
namespace {

constexpr double k_patience_s = 0.5;  // for a service on this computer

std::uint16_t port_of(const StationStylus& station) {
  return static_cast<std::uint16_t>(station.number("port"));
}

template <class T>
List ids_of(const std::vector<T>& all) {
  List ids;
  for (const auto& one : all) ids.items.emplace_back(Name{one.id});
  return ids;
}

/// The one whose id is `wanted`, or the only one there is. Throws Error.
template <class T>
const T& chosen(const std::vector<T>& all, const std::string& wanted, const Message& what,
                const std::string& key) {
  if (all.empty())
    throw inverse3_error(DeviceError::not_there, msg("the service knows of no {}", what),
                         msg("plug it in, switch it on, and look whether Haply Hub shows it"));
  for (const T& one : all)
    if (one.id == wanted) return one;
  if (!wanted.empty())
    throw inverse3_error(DeviceError::not_there, msg("the {} {} is not there", what, wanted),
                         msg("set {} in stylus-inverse3.toml to one of {}", key, ids_of(all)));
  if (all.size() > 1)
    throw inverse3_error(DeviceError::several, msg("there are several of {}", what),
                         msg("set {} in stylus-inverse3.toml to one of {}", key, ids_of(all)));
  return all.front();
}

const Inverse3Device& chosen_device(const Inverse3Message& message, const StationStylus& station) {
  return chosen(message.devices, station.text("device"), msg("Inverse3"), "device");
}

/// The first words of the service.
Inverse3Message greeting(Inverse3Link& link) {
  std::string text;
  if (!link.hear(text, k_patience_s))
    throw inverse3_error(DeviceError::silent, msg("the service says nothing of its devices"),
                         msg("start the Haply Inverse Service again; 3.1 or later is needed"));
  return parse_inverse3(text);
}

/// Id of the device that is there now. Throws Error.
std::string look_for_id(const StationStylus& station) {
  Inverse3Link link(port_of(station), k_patience_s);
  return chosen_device(greeting(link), station).id;
}

std::string id_if_there(const StationStylus& station) {
  try {
    return look_for_id(station);
  } catch (const Error&) {
    return station.text("device");
  }
}

StylusFacts inverse3_facts() {
  return {.id = "inverse3",
          .name = cavum::Name{"Haply Inverse3"},
          .position_quantum_mm = 0.01,
          .peak_n = 5.0,
          .continuous_n = 2.0,
          .rate_hz = 1000.0,
          .reach_mm = 100.0,
          .measures_direction = true};
}

StylusFacts facts_of_this_one(const StationStylus& station) {
  StylusFacts facts = inverse3_facts();
  facts.serial = id_if_there(station);
  facts.measures_direction = station.text("grip") != "none";
  return facts;
}

/// The grip points along its y axis; our tool's z axis points from the tip to the handle.
const Quat& tool_to_grip() {
  static const Quat k_turn = rotation_of({1, 0, 0}, {0, 0, 1}, {0, -1, 0});
  return k_turn;
}

/// No force is left behind, however the line ends.
class NoForceAtEnd {
 public:
  NoForceAtEnd(Inverse3Link& link, std::string command)
      : link_(link), command_(std::move(command)) {}
  ~NoForceAtEnd() {
    try {
      link_.send(command_, Inverse3Stylus::k_silent_after_s);
    } catch (const std::exception&) {  // cut: the service lets go by itself
    }
  }
  NoForceAtEnd(const NoForceAtEnd&) = delete;
  NoForceAtEnd& operator=(const NoForceAtEnd&) = delete;

 private:
  Inverse3Link& link_;
  std::string command_;
};

}  // namespace

StylusKind inverse3_kind() {
  const Vec3 middle_mm{0, -120, 150};  // where the cursor rests in its maker's examples; x to the
                                       // right, y away from the candidate, z up
  Placement placement;
  placement.offset_mm = Vec3{} - middle_mm;
  StylusKind kind{.facts = inverse3_facts(),
                  .placement = placement,
                  .settings = {{.key = "port", .usual = 10001.0, .least = 1.0, .most = 65535.0},
                               {.key = "device", .usual = ""},
                               {.key = "grip", .usual = ""}}};
  kind.look = [](const StationStylus& station, bool) {
    StylusLook look;
    try {
      look.there = !look_for_id(station).empty();
    } catch (const Error& e) {
      look.problem = e;
    }
    return look;
  };
  kind.serial = id_if_there;
  kind.open = [](const StylusOptions& options) -> std::unique_ptr<Stylus> {
    return std::make_unique<Inverse3Stylus>(options.station);
  };
  return kind;
}

Inverse3Stylus::Inverse3Stylus(const StationStylus& station)
    : ThreadedStylus(station, facts_of_this_one(station)) {
  start([this] { run(); });
}

void Inverse3Stylus::run() {
  look_again_and_again([this] {
    Inverse3Link link(port_of(station_), k_patience_s);
    serve(link);
  });
}

void Inverse3Stylus::lose() {
  if (!std::exchange(lost_, true)) unplugged_.fetch_add(1);
  knows_its_position_ = false;
  meter_.pause();
}

/// Until the line is cut, or no longer wanted. Throws Error for all that ends it but the latter.
void Inverse3Stylus::serve(Inverse3Link& link) {
  constexpr std::int64_t k_period_ns = 1'000'000;
  const Inverse3Message first = greeting(link);
  const std::string id = chosen_device(first, station_).id;
  const bool vector = first.names_session;
  calibrated_ = powered_ = true;
  take(first, id);
  static_cast<void>(ask_for_fifo(
      69));  // as the servo, where the system allows it; its periods are in the health either way
  ask_for_sharp_timers();
  const NoForceAtEnd no_force(link, inverse3_command(id, {}, vector));
  try {
    for (std::int64_t due = monotonic_ns(); !is_to_stop(); sleep_until(due)) {
      due = std::max(due + k_period_ns, monotonic_ns() - k_period_ns);
      exchange(link, id, vector);
    }
  } catch (const Error&) {
    lose();
    throw;
  }
}

/// One command for one state. Throws Error when the line is cut, for what is no state, and after a
/// second of silence.
void Inverse3Stylus::exchange(Inverse3Link& link, const std::string& id, bool vector) {
  constexpr int k_max_silent = 10;
  link.send(inverse3_command(id, force(), vector), k_silent_after_s);
  int owed = 1;
  for (int silent = 0; owed > 0;) {
    if (link.hear(received_, k_silent_after_s)) {
      --owed;
      take(parse_inverse3(received_), id);
      continue;
    }
    const Error silence = inverse3_error(
        DeviceError::silent, msg("the service is silent"),
        msg("see whether the Haply Inverse Service still runs, and the device's cables"));
    if (is_to_stop() || ++silent >= k_max_silent) throw silence;
    if (silent > 1) continue;
    lose();
    set_problem(silence);
    link.send(inverse3_command(id, {}, vector), k_silent_after_s);  // it may still hear
    ++owed;
  }
}

void Inverse3Stylus::take(const Inverse3Message& message, const std::string& id) {
  const auto device = std::find_if(message.devices.begin(), message.devices.end(),
                                   [&id](const auto& d) { return d.id == id; });
  if (device == message.devices.end())
    throw inverse3_error(DeviceError::lost, msg("the Inverse3 {} was unplugged", id),
                         msg("plug it in again"));
  Place place;
  std::optional<Error> problem = place_of(*device, place);
  if (!problem && facts_.measures_direction) problem = direction_of(message, place);
  knows_its_position_ = !problem;
  set_problem(std::move(problem));
  if (!knows_its_position_) return meter_.pause();
  place.at_ns = monotonic_ns();
  put(place);
  if (std::exchange(lost_, false)) plugged_in_.fetch_add(1);
}

std::optional<Error> Inverse3Stylus::place_of(const Inverse3Device& device, Place& place) {
  calibrated_ = device.calibrated.value_or(calibrated_);
  powered_ = device.powered.value_or(powered_);
  if (!powered_)
    return inverse3_error(DeviceError::no_power, msg("has no power"),
                          msg("plug in its power supply"));
  if (!calibrated_)
    return inverse3_error(
        DeviceError::needs_calibration, msg("is not calibrated"),
        msg("put the grip onto its rest until the light says so, and take it up"));
  if (!device.position_mm)
    return inverse3_error(DeviceError::no_position, msg("gives no place"),
                          msg("start the Haply Inverse Service again"));
  place.device_mm = *device.position_mm;
  return {};
}

std::optional<Error> Inverse3Stylus::direction_of(const Inverse3Message& message,
                                                  Place& place) const {
  try {
    const Inverse3Grip& grip =
        chosen(message.grips, station_.text("grip"), msg("VerseGrip"), "grip");
    if (!grip.to_device)
      return inverse3_error(DeviceError::no_direction, msg("its grip tells no direction"),
                            msg("switch it on and move it"));
    place.tool_to_device = turned(tool_to_grip(), *grip.to_device);
    place.flags = static_cast<std::uint16_t>((grip.button_1 ? k_button_1 : 0) |
                                             (grip.button_2 ? k_button_2 : 0));
    return {};
  } catch (const Error& e) {
    return e;
  }
}

Vec3 Inverse3Stylus::force() noexcept {
  bool cut = false;
  const Vec3 force = force_now(cut);
  if (!knows_its_position_) return {};
  if (cut) forces_cut_.fetch_add(1, std::memory_order_relaxed);
  return force;
}

}  // namespace cavum
