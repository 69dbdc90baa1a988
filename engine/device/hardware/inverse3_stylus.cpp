#include "engine/device/hardware/inverse3_stylus.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

#include "engine/base/error.h"
#include "engine/device/hardware/inverse3_link.h"
#include "engine/servo/scheduling.h"

namespace cavum {
namespace {

const char* const k_where = "stylus inverse3";
constexpr double k_patience_s = 0.5;  // for a service on this computer

std::uint16_t port_of(const StationStylus& station) { return static_cast<std::uint16_t>(station.number("port")); }

template <class T>
std::string ids_of(const std::vector<T>& all) {
  std::string ids;
  for (const auto& one : all) ids += (ids.empty() ? "" : ", ") + one.id;
  return ids;
}

/// The one whose id is `wanted`, or the only one there is. Throws Error.
template <class T>
const T& chosen(const std::vector<T>& all, const std::string& wanted, const std::string& what, const std::string& key) {
  if (all.empty()) throw Error(k_where, "the service knows of no " + what, "plug it in, switch it on, and look whether Haply Hub shows it");
  for (const T& one : all)
    if (one.id == wanted) return one;
  if (!wanted.empty())
    throw Error(k_where, fmt::format("the {} {} is not there", what, wanted),
                fmt::format("set {} in stylus-inverse3.toml to one of {}", key, ids_of(all)));
  if (all.size() > 1)
    throw Error(k_where, "there are several of " + what, fmt::format("set {} in stylus-inverse3.toml to one of {}", key, ids_of(all)));
  return all.front();
}

const Inverse3Device& chosen_device(const Inverse3Message& message, const StationStylus& station) {
  return chosen(message.devices, station.text("device"), "Inverse3", "device");
}

/// The first words of the service.
Inverse3Message greeting(Inverse3Link& link) {
  std::string text;
  if (!link.hear(text, k_patience_s))
    throw Error(k_where, "the service says nothing of its devices", "start the Haply Inverse Service again; 3.1 or later is needed");
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
          .name = "Haply Inverse3",
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
  NoForceAtEnd(Inverse3Link& link, std::string command) : link_(link), command_(std::move(command)) {}
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
  const Vec3 middle_mm{0, -120, 150};  // where the cursor rests in its maker's examples; x to the right, y away from the candidate, z up
  Placement placement;
  placement.offset_mm = Vec3{} - middle_mm;
  StylusKind kind{
      .facts = inverse3_facts(),
      .placement = placement,
      .settings = {{.key = "port", .usual = 10001.0, .least = 1.0, .most = 65535.0}, {.key = "device", .usual = ""}, {.key = "grip", .usual = ""}}};
  kind.look = [](const StationStylus& station, bool) {
    StylusLook look;
    try {
      look.there = !look_for_id(station).empty();
    } catch (const Error& e) {
      look.problem = e.what();
    }
    return look;
  };
  kind.serial = id_if_there;
  kind.open = [](const StylusOptions& options) -> std::unique_ptr<Stylus> { return std::make_unique<Inverse3Stylus>(options.station); };
  return kind;
}

Inverse3Stylus::Inverse3Stylus(const StationStylus& station) : station_(station), facts_(facts_of_this_one(station)), thread_([this] { run(); }) {}

Inverse3Stylus::~Inverse3Stylus() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  stop_asked_.notify_all();
  thread_.join();
}

DeviceReading Inverse3Stylus::read(double) {
  last_ = place_.take();
  if (last_.at_ns == 0) {  // nothing heard yet: not even an old place
    constexpr double k_none = std::numeric_limits<double>::quiet_NaN();
    return {.pose = {{k_none, k_none, k_none}, {}}};
  }
  const bool fresh = static_cast<double>(monotonic_ns() - last_.at_ns) * 1e-9 <= k_stale_after_s;
  const Pose pose =
      facts_.measures_direction ? to_tooth(station_.placement, last_.device_mm, last_.tool_to_device) : to_tooth(station_.placement, last_.device_mm);
  return {.pose = pose, .flags = static_cast<std::uint16_t>(fresh ? last_.flags | k_stylus_fresh : 0)};
}

void Inverse3Stylus::send_force(Vec3 force_n) {
  wanted_.put({force_n, monotonic_ns()});
  cut_.store(false, std::memory_order_release);
}

StylusHealth Inverse3Stylus::health() const {
  StylusHealth h;
  h.readings = meter_.count();
  h.plugged_in = plugged_in_.load();
  h.unplugged = unplugged_.load();
  h.forces_cut = forces_cut_.load();
  h.mean_period_s = meter_.mean_s();
  h.jitter_s = meter_.scatter_s();
  h.longest_gap_s = meter_.longest_s();
  const std::lock_guard lock(mutex_);
  h.problem = problem_;
  h.ready = problem_.empty();
  return h;
}

void Inverse3Stylus::set_problem(const std::string& problem) {
  const std::lock_guard lock(mutex_);
  problem_ = problem;
}

bool Inverse3Stylus::wait(double seconds) {
  std::unique_lock lock(mutex_);
  return stop_asked_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return stop_.load(); });
}

void Inverse3Stylus::run() {
  constexpr double k_look_again_s = 0.2;
  do {
    try {
      Inverse3Link link(port_of(station_), k_patience_s);
      serve(link);
    } catch (const std::exception& e) {
      set_problem(e.what());
    }
  } while (!wait(k_look_again_s));
}

void Inverse3Stylus::lose() {
  if (!std::exchange(lost_, true)) unplugged_.fetch_add(1);
  knows_its_place_ = false;
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
  static_cast<void>(ask_for_fifo(69));  // as the servo, where the system allows it; its periods are in the health either way
  ask_for_sharp_timers();
  const NoForceAtEnd no_force(link, inverse3_command(id, {}, vector));
  try {
    for (std::int64_t due = monotonic_ns(); !stop_.load(std::memory_order_relaxed); sleep_until(due)) {
      due = std::max(due + k_period_ns, monotonic_ns() - k_period_ns);
      exchange(link, id, vector);
    }
  } catch (const Error&) {
    lose();
    throw;
  }
}

/// One command for one state. Throws Error when the line is cut, for what is no state, and after a second of silence.
void Inverse3Stylus::exchange(Inverse3Link& link, const std::string& id, bool vector) {
  constexpr int k_most_silent = 10;
  link.send(inverse3_command(id, force_now(), vector), k_silent_after_s);
  int owed = 1;
  for (int silent = 0; owed > 0;) {
    if (link.hear(heard_, k_silent_after_s)) {
      --owed;
      take(parse_inverse3(heard_), id);
      continue;
    }
    const std::string said = "the service is silent", todo = "see whether the Haply Inverse Service still runs, and the device's cables";
    if (stop_.load(std::memory_order_relaxed) || ++silent >= k_most_silent) throw Error(k_where, said, todo);
    if (silent > 1) continue;
    lose();
    set_problem(Error(k_where, said, todo).what());
    link.send(inverse3_command(id, {}, vector), k_silent_after_s);  // it may still hear
    ++owed;
  }
}

void Inverse3Stylus::take(const Inverse3Message& message, const std::string& id) {
  const auto device = std::find_if(message.devices.begin(), message.devices.end(), [&id](const auto& d) { return d.id == id; });
  if (device == message.devices.end()) throw Error(k_where, fmt::format("the Inverse3 {} was unplugged", id), "plug it in again");
  Place place;
  std::string problem = place_of(*device, place);
  if (problem.empty() && facts_.measures_direction) problem = direction_of(message, place);
  set_problem(problem);
  knows_its_place_ = problem.empty();
  if (!knows_its_place_) return meter_.pause();
  place.at_ns = monotonic_ns();
  place_.put(place);
  meter_.add(place.at_ns);
  if (std::exchange(lost_, false)) plugged_in_.fetch_add(1);
}

std::string Inverse3Stylus::place_of(const Inverse3Device& device, Place& place) {
  calibrated_ = device.calibrated.value_or(calibrated_);
  powered_ = device.powered.value_or(powered_);
  if (!powered_) return "stylus inverse3: has no power; plug in its power supply";
  if (!calibrated_) return "stylus inverse3: is not calibrated; put the grip onto its rest until the light says so, and take it up";
  if (!device.position_mm) return "stylus inverse3: gives no place; start the Haply Inverse Service again";
  place.device_mm = *device.position_mm;
  return {};
}

std::string Inverse3Stylus::direction_of(const Inverse3Message& message, Place& place) const {
  try {
    const Inverse3Grip& grip = chosen(message.grips, station_.text("grip"), "VerseGrip", "grip");
    if (!grip.to_device) return "stylus inverse3: its grip tells no direction; switch it on and move it";
    place.tool_to_device = turned(tool_to_grip(), *grip.to_device);
    place.flags = static_cast<std::uint16_t>((grip.button_1 ? k_button_1 : 0) | (grip.button_2 ? k_button_2 : 0));
    return {};
  } catch (const Error& e) {
    return e.what();
  }
}

Vec3 Inverse3Stylus::force_now() noexcept {
  const Wanted wanted = wanted_.take();
  // A servo that says nothing any more is no servo: its last force must not stay. Nor may one be felt where the place means nothing.
  const std::int64_t now = monotonic_ns();
  const bool old = static_cast<double>(now - wanted.at_ns) * 1e-9 > k_force_lasts_s;
  if (old || !knows_its_place_ || cut_.load(std::memory_order_acquire) || !is_finite(wanted.tooth_n)) return {};
  const Vec3 force = force_to_device(station_.placement, wanted.tooth_n);
  const double size = length(force);
  if (size <= facts_.peak_n) return force;
  forces_cut_.fetch_add(1, std::memory_order_relaxed);
  return force * (facts_.peak_n / size);
}

}  // namespace cavum
