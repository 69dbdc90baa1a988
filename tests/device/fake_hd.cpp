// A library with the names of OpenHaptics, for tests: two devices, a scheduler of its own at 1 kHz,
// and whatever can go wrong. Environment: FAKE_HD_NO_DEVICE, FAKE_HD_ERROR_AFTER_MS (of the
// scheduler's time), FAKE_HD_CALIBRATION (`update` becomes good once asked for, `manual` once
// fake_hd_inkwell is called). The functions fake_hd_* are the test's hands on it.
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace {

struct ErrorInfo {
  unsigned code;
  int internal;
  unsigned handle;
};
struct Device {
  std::string name;
  bool open = false, force_on = false, in_frame = false;
  unsigned calibration = 0x5000;
  int buttons = 0;
  double transform[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  double force[3] = {0, 0, 0};
  long frames = 0;
};
struct Task {
  unsigned (*callback)(void*);
  void* data;
};

std::recursive_mutex mutex;
std::vector<Device> devices{{.name = "Default Device"}, {.name = "left"}};
std::vector<unsigned> errors;
std::map<unsigned long, Task> tasks;
unsigned long next_task = 1;
unsigned current = 0;
std::thread scheduler;
std::atomic<bool> running{false};

bool is_set(const char* name) { return std::getenv(name) != nullptr; }
Device* device_of(unsigned handle) {
  return handle < devices.size() && devices[handle].open ? &devices[handle] : nullptr;
}

void run() {
  const auto begin = std::chrono::steady_clock::now();
  const char* after = std::getenv("FAKE_HD_ERROR_AFTER_MS");
  for (auto next = begin; running;
       std::this_thread::sleep_until(next += std::chrono::milliseconds(1))) {
    const std::lock_guard lock(mutex);
    const bool broken = after != nullptr && std::chrono::steady_clock::now() - begin >
                                                std::chrono::milliseconds(std::atoi(after));
    for (auto i = tasks.begin(); i != tasks.end();) {
      if (broken) errors.push_back(0x0302);
      const Task task = i->second;
      const unsigned long number = i->first;
      const bool again = task.callback(task.data) == 1;
      i = tasks.upper_bound(number);
      if (!again) tasks.erase(number);
    }
  }
}

}  // namespace

extern "C" {

unsigned hdInitDevice(const char* name) {
  const std::lock_guard lock(mutex);
  for (unsigned i = 0; i < devices.size() && !is_set("FAKE_HD_NO_DEVICE"); ++i) {
    if (name == nullptr ? i != 0 : devices[i].name != name) continue;
    if (devices[i].open) {
      errors.push_back(0x0301);
      return 0xffffffff;
    }
    devices[i] = {.name = devices[i].name};
    devices[i].open = true;
    const char* calibration = std::getenv("FAKE_HD_CALIBRATION");
    if (calibration != nullptr)
      devices[i].calibration = std::strcmp(calibration, "manual") == 0 ? 0x5002 : 0x5001;
    current = i;
    return i;
  }
  errors.push_back(0x0300);
  return 0xffffffff;
}
void hdDisableDevice(unsigned handle) {
  const std::lock_guard lock(mutex);
  if (Device* d = device_of(handle)) d->open = false;
}
void hdMakeCurrentDevice(unsigned handle) {
  const std::lock_guard lock(mutex);
  current = handle;
}
void hdBeginFrame(unsigned handle) {
  const std::lock_guard lock(mutex);
  current = handle;
  Device* d = device_of(handle);
  if (d == nullptr || d->in_frame) return errors.push_back(0x0400);
  d->in_frame = true;
}
void hdEndFrame(unsigned handle) {
  const std::lock_guard lock(mutex);
  Device* d = device_of(handle);
  if (d == nullptr || !d->in_frame) return errors.push_back(0x0401);
  d->in_frame = false;
  ++d->frames;
}
void hdEnable(unsigned what) {
  const std::lock_guard lock(mutex);
  if (Device* d = device_of(current); d != nullptr && what == 0x4000) d->force_on = true;
}
void hdDisable(unsigned what) {
  const std::lock_guard lock(mutex);
  if (Device* d = device_of(current); d != nullptr && what == 0x4000) d->force_on = false;
}
void hdStartScheduler() {
  running = true;
  scheduler = std::thread(run);
}
void hdStopScheduler() {
  running = false;
  if (scheduler.joinable()) scheduler.join();
}
unsigned long hdScheduleAsynchronous(unsigned (*callback)(void*), void* data,
                                     unsigned short priority) {
  const std::lock_guard lock(mutex);
  if (priority != 0xffff) errors.push_back(0x0500);
  tasks[next_task] = {callback, data};
  return next_task++;
}
void hdUnschedule(unsigned long task) {
  const std::lock_guard lock(mutex);
  tasks.erase(task);
}
void hdGetDoublev(unsigned what, double* values) {
  const std::lock_guard lock(mutex);
  const Device* d = device_of(current);
  if (d == nullptr) return errors.push_back(0x0104);
  if (what == 0x2603)
    values[0] = 3.2;
  else if (what == 0x2604)
    values[0] = 0.9;
  else if (what == 0x2052)
    std::memcpy(values, d->transform, sizeof d->transform);
  else if (what == 0x2050)
    std::memcpy(values, d->transform + 12, 3 * sizeof(double));
  else
    errors.push_back(0x0100);
}
void hdGetIntegerv(unsigned what, int* values) {
  const std::lock_guard lock(mutex);
  const Device* d = device_of(current);
  if (d == nullptr) return errors.push_back(0x0104);
  if (what == 0x2000)
    values[0] = d->buttons;
  else if (what == 0x2555)
    values[0] = 4;
  else
    errors.push_back(0x0100);
}
void hdSetDoublev(unsigned what, const double* values) {
  const std::lock_guard lock(mutex);
  Device* d = device_of(current);
  if (d == nullptr || !d->in_frame || what != 0x2700) return errors.push_back(0x0102);
  std::memcpy(d->force, values, sizeof d->force);
  if (std::hypot(values[0], values[1], values[2]) > 3.2 * (1 + 1e-9)) errors.push_back(0x0201);
}
ErrorInfo hdGetError() {
  const std::lock_guard lock(mutex);
  if (errors.empty()) return {0, 0, 0};
  const unsigned code = errors.front();
  errors.erase(errors.begin());
  return {code, -1, current};
}
unsigned hdCheckCalibration() {
  const std::lock_guard lock(mutex);
  const Device* d = device_of(current);
  return d == nullptr ? 0 : d->calibration;
}
void hdUpdateCalibration(unsigned style) {
  const std::lock_guard lock(mutex);
  if (Device* d = device_of(current); d != nullptr && style == 4 && d->calibration == 0x5001)
    d->calibration = 0x5000;
}

void fake_hd_place(unsigned handle, const double* transform, int buttons) {
  const std::lock_guard lock(mutex);
  std::memcpy(devices.at(handle).transform, transform, sizeof devices[handle].transform);
  devices[handle].buttons = buttons;
}
void fake_hd_inkwell(unsigned handle) {
  const std::lock_guard lock(mutex);
  devices.at(handle).calibration = 0x5000;
}
/// Force asked for, when force output is on; zero when it is off. Returns the frames so far.
long fake_hd_force(unsigned handle, double* force) {
  const std::lock_guard lock(mutex);
  const Device& d = devices.at(handle);
  for (int i = 0; i < 3; ++i) force[i] = d.open && d.force_on ? d.force[i] : 0.0;
  return d.frames;
}
int fake_hd_errors() {
  const std::lock_guard lock(mutex);
  return static_cast<int>(errors.size());
}

}  // extern "C"
