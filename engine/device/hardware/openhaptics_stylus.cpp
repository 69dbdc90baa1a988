#include "engine/device/hardware/openhaptics_stylus.h"

#include <dlfcn.h>
#include <fmt/core.h>

#include <array>
#include <limits>
#include <mutex>

#include "engine/device/device_error.h"
#include "engine/physics/servo/scheduling.h"

namespace cavum {
namespace {

// Numbers of OpenHaptics 3.4, as its reference has them.
enum : unsigned {
  k_buttons = 0x2000,
  k_transform = 0x2052,
  k_calibration_style = 0x2555,
  k_max_force = 0x2603,
  k_continuous_force = 0x2604,
  k_force = 0x2700,
  k_force_output = 0x4000,
  k_calibration_ok = 0x5000,
  k_calibration_update = 0x5001,
  k_calibration_manual = 0x5002,
  k_no_handle = 0xffffffff,
  k_first_device_error = 0x0300,  // below: warm motors, too fast, too strong; they pass
};
constexpr unsigned short k_highest_priority = 0xffff;
constexpr unsigned k_done = 0, k_again = 1;

struct ErrorInfo {
  unsigned code;
  int internal;
  unsigned handle;
};

Error touch_error(DeviceError code, Message problem, Message advice) {
  return stylus_error("touch", code, std::move(problem), std::move(advice));
}

Message look_at_its_cables() {
  return msg("look at its cables, run the diagnostic of its maker's driver, and begin again");
}

std::string code_text(unsigned code) { return fmt::format("0x{:04x}", code); }

StylusFacts touch_facts() {
  return {.id = "touch",
          .name = msg("Touch or PHANTOM Omni through OpenHaptics"),
          .position_quantum_mm = 0.055,
          .peak_n = 3.3,
          .continuous_n = 0.88,
          .rate_hz = 1000.0,
          .reach_mm = 35.0,
          .measures_direction = true};
}

}  // namespace

StylusKind touch_kind() {
  StylusKind kind{
      .facts = touch_facts(),
      .placement = upright_device({}),
      // the library to load; the name given in its maker's setup, none: the default device
      .settings = {{.key = "library", .usual = "libHD.so"}, {.key = "device_name", .usual = ""}}};
  kind.look = look_for_touch;
  kind.open = [](const StylusOptions& options) -> std::unique_ptr<Stylus> {
    return std::make_unique<OpenHapticsStylus>(options.station);
  };
  return kind;
}

/// The library, once for all devices of the program: its scheduler is one.
struct OpenHapticsStylus::Library {
  void* file = nullptr;
  std::mutex mutex;
  int running = 0;  // devices that need the scheduler

  unsigned (*init_device)(const char*) = nullptr;
  void (*disable_device)(unsigned) = nullptr;
  void (*make_current)(unsigned) = nullptr;
  void (*begin_frame)(unsigned) = nullptr;
  void (*end_frame)(unsigned) = nullptr;
  void (*enable)(unsigned) = nullptr;
  void (*disable)(unsigned) = nullptr;
  void (*start_scheduler)() = nullptr;
  void (*stop_scheduler)() = nullptr;
  unsigned long (*schedule)(unsigned (*)(void*), void*, unsigned short) = nullptr;
  void (*unschedule)(unsigned long) = nullptr;
  void (*get_doubles)(unsigned, double*) = nullptr;
  void (*get_integers)(unsigned, int*) = nullptr;
  void (*set_doubles)(unsigned, const double*) = nullptr;
  ErrorInfo (*get_error)() = nullptr;
  unsigned (*check_calibration)() = nullptr;
  void (*update_calibration)(unsigned) = nullptr;

  explicit Library(const std::string& path) : file(::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL)) {
    if (file == nullptr)
      throw touch_error(
          DeviceError::library_missing, msg("OpenHaptics is not there ({})", path),
          msg("install OpenHaptics and the device's driver of 3D Systems, or name the library in stylus-touch.toml"));
    find(init_device, "hdInitDevice");
    find(disable_device, "hdDisableDevice");
    find(make_current, "hdMakeCurrentDevice");
    find(begin_frame, "hdBeginFrame");
    find(end_frame, "hdEndFrame");
    find(enable, "hdEnable");
    find(disable, "hdDisable");
    find(start_scheduler, "hdStartScheduler");
    find(stop_scheduler, "hdStopScheduler");
    find(schedule, "hdScheduleAsynchronous");
    find(unschedule, "hdUnschedule");
    find(get_doubles, "hdGetDoublev");
    find(get_integers, "hdGetIntegerv");
    find(set_doubles, "hdSetDoublev");
    find(get_error, "hdGetError");
    find(check_calibration, "hdCheckCalibration");
    find(update_calibration, "hdUpdateCalibration");
  }
  // The library stays: its driver keeps threads of its own, and they would lose their code.
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  template <class Function>
  void find(Function& function, const char* name) {
    function = reinterpret_cast<Function>(::dlsym(file, name));
    if (function == nullptr)
      throw touch_error(DeviceError::library_too_old, msg("its library has no {}", name),
                        msg("install OpenHaptics 3.4 or later"));
  }

  /// Errors that wait are taken; the first one is returned, 0 = none.
  unsigned take_errors() const noexcept {
    constexpr int k_most = 16;
    unsigned first = 0;
    for (int i = 0; i < k_most; ++i) {
      const unsigned code = get_error().code;
      if (code == 0) break;
      if (first == 0) first = code;
    }
    return first;
  }

  unsigned begin(const std::string& name) const {
    static_cast<void>(take_errors());
    const unsigned handle = init_device(name.empty() ? nullptr : name.c_str());
    const unsigned error = take_errors();
    if (error != 0 || handle == k_no_handle)
      throw touch_error(
          DeviceError::refuses,
          msg("{} does not begin (error {})",
              name.empty() ? msg("the default device") : msg("the device '{}'", name),
              code_text(error)),
          msg("look at its cables and power supply, and at its name in the setup of its maker's driver"));
    return handle;
  }

  /// The one of this path that is loaded already, or a new one.
  static std::shared_ptr<Library> load(const std::string& path) {
    static std::mutex mutex;
    static std::weak_ptr<Library> loaded;
    static std::string loaded_path;
    const std::lock_guard lock(mutex);
    auto library = loaded.lock();
    if (library == nullptr || loaded_path != path) {
      library = std::make_shared<Library>(path);
      loaded = library;
      loaded_path = path;
    }
    return library;
  }
};

StylusLook look_for_touch(const StationStylus& station, bool begin) {
  StylusLook look;
  try {
    const auto library = OpenHapticsStylus::Library::load(station.text("library"));
    const std::lock_guard lock(library->mutex);
    if (begin && library->running == 0)
      library->disable_device(library->begin(station.text("device_name")));
    look.there = true;
  } catch (const Error& e) {
    look.problem = e;
  }
  return look;
}

OpenHapticsStylus::OpenHapticsStylus(const StationStylus& station)
    : station_(station), library_(Library::load(station.text("library"))), handle_(k_no_handle) {
  const std::lock_guard lock(library_->mutex);
  handle_ = library_->begin(station.text("device_name"));
  library_->make_current(handle_);
  const auto number = [this](unsigned what, double otherwise) {
    double value = 0.0;
    library_->get_doubles(what, &value);
    constexpr double k_max_n = 100.0;
    return value > 0.0 && value < k_max_n ? value : otherwise;
  };
  const std::string& name = station.text("device_name");
  facts_ = touch_facts();
  facts_.name = name.empty() ? msg("OpenHaptics, default device") : msg("OpenHaptics, {}", name);
  facts_.peak_n = number(k_max_force, facts_.peak_n);
  facts_.continuous_n = number(k_continuous_force, facts_.continuous_n);
  library_->enable(k_force_output);
  if (const unsigned error = library_->take_errors(); error != 0) {
    library_->disable_device(handle_);
    throw touch_error(DeviceError::refuses,
                      msg("cannot be made ready (error {})", code_text(error)),
                      look_at_its_cables());
  }
  task_ = library_->schedule(&OpenHapticsStylus::call, this, k_highest_priority);
  if (library_->running++ == 0) library_->start_scheduler();
  if (const unsigned error = library_->take_errors(); error != 0) error_.store(error);
}

OpenHapticsStylus::~OpenHapticsStylus() {
  cut_force();
  closing_.store(true, std::memory_order_release);
  // The scheduler may serve another device: this one's last call must be over. It comes within a
  // millisecond, unless the driver hangs.
  constexpr int k_max_ms = 200;
  constexpr std::int64_t k_ms_ns = 1'000'000;
  for (int i = 0; i < k_max_ms && !closed_.load(std::memory_order_acquire); ++i)
    sleep_until(monotonic_ns() + k_ms_ns);
  const std::lock_guard lock(library_->mutex);
  if (--library_->running == 0) library_->stop_scheduler();
  library_->unschedule(task_);
  library_->make_current(handle_);
  library_->disable(k_force_output);
  library_->disable_device(handle_);
}

unsigned OpenHapticsStylus::call(void* self) {
  auto& stylus = *static_cast<OpenHapticsStylus*>(self);
  const bool last = stylus.closing_.load(std::memory_order_acquire);
  stylus.exchange();
  if (last)
    stylus.closed_.store(true, std::memory_order_release);  // with no force, as it was cut before
  return last ? k_done : k_again;
}

bool OpenHapticsStylus::calibrated() noexcept {
  if (is_calibrated_ || --until_look_ > 0) return is_calibrated_;
  constexpr int k_look_every = 100;
  until_look_ = k_look_every;
  const unsigned said = library_->check_calibration();
  if (said == k_calibration_update) {
    int style = 0;
    library_->get_integers(k_calibration_style, &style);
    library_->update_calibration(static_cast<unsigned>(style));
  }
  calibration_.store(said, std::memory_order_release);
  is_calibrated_ = said == k_calibration_ok;
  return is_calibrated_;
}

Vec3 OpenHapticsStylus::force_now() noexcept {
  const Wanted wanted = wanted_.take();
  const bool old = static_cast<double>(monotonic_ns() - wanted.at_ns) * 1e-9 > k_force_lasts_s;
  if (old || cut_.load(std::memory_order_acquire) || !is_finite(wanted.tooth_n)) return {};
  const Vec3 force = force_to_device(station_.placement, wanted.tooth_n);
  const double size = length(force);
  if (size <= facts_.peak_n) return force;
  forces_cut_.fetch_add(1, std::memory_order_relaxed);
  return force * (facts_.peak_n / size);
}

void OpenHapticsStylus::exchange() noexcept {
  library_->begin_frame(handle_);
  const bool knows_its_position = calibrated();
  int buttons = 0;
  std::array<double, 16> m{};  // columns one after another
  library_->get_integers(k_buttons, &buttons);
  library_->get_doubles(k_transform, m.data());
  const Vec3 force = knows_its_position ? force_now() : Vec3{};
  const std::array<double, 3> sent{force.x, force.y, force.z};
  library_->set_doubles(k_force, sent.data());
  library_->end_frame(handle_);
  const unsigned error = library_->take_errors();
  if (error != 0) errors_.fetch_add(1, std::memory_order_relaxed);
  error_.store(error, std::memory_order_release);
  const Vec3 at{m[12], m[13], m[14]};
  if (!knows_its_position || error >= k_first_device_error || !is_finite(at)) return;
  const std::int64_t now = monotonic_ns();
  meter_.add(now);
  place_.put({at, rotation_of({m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}),
              static_cast<std::uint16_t>(((buttons & 1) != 0 ? k_button_1 : 0) |
                                         ((buttons & 2) != 0 ? k_button_2 : 0)),
              now});
}

DeviceReading OpenHapticsStylus::read(double) {
  last_ = place_.take();
  if (last_.at_ns == 0) {
    constexpr double k_none = std::numeric_limits<double>::quiet_NaN();
    return {.pose = {{k_none, k_none, k_none}, {}}};
  }
  const bool fresh = static_cast<double>(monotonic_ns() - last_.at_ns) * 1e-9 <= k_stale_after_s;
  return {.pose = to_tooth(station_.placement, last_.device_mm, last_.tool_to_device),
          .flags = static_cast<std::uint16_t>(fresh ? last_.flags | k_stylus_fresh : 0)};
}

void OpenHapticsStylus::send_force(Vec3 force_n) {
  wanted_.put({force_n, monotonic_ns()});
  cut_.store(false, std::memory_order_release);
}

StylusHealth OpenHapticsStylus::health() const {
  StylusHealth h;
  h.readings = meter_.count();
  h.plugged_in = 1;
  h.forces_cut = forces_cut_.load(std::memory_order_relaxed);
  h.mean_period_s = meter_.mean_s();
  h.jitter_s = meter_.scatter_s();
  h.longest_gap_s = meter_.longest_s();
  const unsigned error = error_.load(std::memory_order_acquire),
                 calibration = calibration_.load(std::memory_order_acquire);
  if (error >= k_first_device_error)
    h.problem = touch_error(DeviceError::lost, msg("was lost (error {})", code_text(error)),
                            look_at_its_cables());
  else if (calibration == 0)
    h.problem = touch_error(DeviceError::starting, msg("has not spoken yet"), msg("wait a second"));
  else if (calibration == k_calibration_manual)
    h.problem = touch_error(DeviceError::needs_calibration, msg("needs calibration"),
                            msg("put the stylus into its inkwell and take it out"));
  else if (calibration == k_calibration_update)
    h.problem = touch_error(DeviceError::needs_calibration, msg("is being calibrated"),
                            msg("hold the stylus still, in its inkwell if it has one"));
  else if (calibration != k_calibration_ok)
    h.problem = touch_error(DeviceError::refuses,
                            msg("says nothing of its calibration ({})", code_text(calibration)),
                            look_at_its_cables());
  else if (h.readings == 0)
    h.problem = touch_error(DeviceError::no_position, msg("gives no place"), look_at_its_cables());
  return h;
}

}  // namespace cavum
