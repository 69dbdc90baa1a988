#include "engine/device/hardware/hid_pedal.h"

#include <fmt/core.h>
#include <hidapi/hidapi.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>

#include "engine/base/file.h"
#include "engine/device/device_error.h"
#include "engine/device/hardware/station_pedal.h"

namespace cavum {
namespace {

namespace fs = std::filesystem;

std::uint64_t now_us() noexcept {
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::microseconds>(
                                        std::chrono::steady_clock::now().time_since_epoch())
                                        .count());
}

/// Enumeration of hidapi keeps state of its own: one thread at a time.
std::mutex& hidapi_mutex() {
  static std::mutex mutex;
  return mutex;
}

struct FreeDevices {
  void operator()(hid_device_info* first) const noexcept { hid_free_enumeration(first); }
};
using Devices = std::unique_ptr<hid_device_info, FreeDevices>;
struct CloseDevice {
  void operator()(hid_device* device) const noexcept { hid_close(device); }
};
using Device = std::unique_ptr<hid_device, CloseDevice>;

/// The report descriptor as the kernel keeps it. hidapi names a device "/dev/hidraw3" or, through
/// libusb, "1-2:1.0".
Bytes descriptor_of(const std::string& path) {
  if (path.starts_with("/dev/"))
    return read_file(fmt::format("/sys/class/hidraw/{}/device/report_descriptor", path.substr(5)));
  std::error_code none;
  for (const auto& entry : fs::directory_iterator("/sys/bus/usb/devices/" + path, none))
    if (fs::exists(entry.path() / "report_descriptor", none))
      return read_file((entry.path() / "report_descriptor").string());
  throw Error(DeviceError::bad_descriptor, Name{path}, msg("has no report descriptor in /sys"),
              msg("plug the device in again, so that the kernel reads it"));
}

/// The file that must be opened: the node itself, or, through libusb, the USB device that the
/// interface "1-2:1.0" belongs to. Empty when unknown.
std::string file_of(const std::string& path) {
  if (path.starts_with("/dev/")) return path;
  const std::string device =
      fmt::format("/sys/bus/usb/devices/{}/", path.substr(0, path.find(':')));
  try {
    return fmt::format("/dev/bus/usb/{:03}/{:03}", std::stoi(read_text_file(device + "busnum")),
                       std::stoi(read_text_file(device + "devnum")));
  } catch (const std::exception&) {  // no such device, or no number: opening it will say
    return {};
  }
}

Error pedal_error(std::uint16_t vendor, std::uint16_t product, DeviceError code, Message problem,
                  Message advice) {
  return {code, msg("pedal {}", usb_id(vendor, product)), std::move(problem), std::move(advice)};
}

Error not_permitted(std::uint16_t vendor, std::uint16_t product, const std::string& path) {
  return pedal_error(vendor, product, DeviceError::not_permitted, msg("may not be opened"),
                     udev_advice(vendor, product, path.starts_with("/dev/")));
}

std::string name_of(const hid_device_info& d) {
  std::string name;
  for (const wchar_t* text : {d.manufacturer_string, d.product_string}) {
    if (text == nullptr || *text == 0) continue;
    if (!name.empty()) name += ' ';
    for (; *text != 0; ++text) name += *text >= 32 && *text < 127 ? static_cast<char>(*text) : '?';
  }
  return name.empty() ? "HID device" : name;
}

HidPedalInfo info_of(const hid_device_info& d) {
  HidPedalInfo info{.vendor = d.vendor_id,
                    .product = d.product_id,
                    .name = name_of(d),
                    .path = d.path,
                    .axes = {},
                    .problem = {}};
  try {
    const Bytes descriptor = descriptor_of(info.path);
    info.axes = parse_hid_descriptor(descriptor).axes();
  } catch (const Error& e) {
    info.problem = e;
  }
  if (const std::string file = file_of(info.path);
      !info.problem && !file.empty() && ::access(file.c_str(), R_OK | W_OK) != 0)
    info.problem = not_permitted(info.vendor, info.product, info.path);
  return info;
}

}  // namespace

std::string HidPedalInfo::id() const { return usb_id(vendor, product); }

std::vector<HidPedalInfo> list_hid_pedals() {
  const std::lock_guard lock(hidapi_mutex());
  std::vector<HidPedalInfo> found;
  const Devices devices(hid_enumerate(0, 0));
  for (const hid_device_info* d = devices.get(); d != nullptr; d = d->next) {
    HidPedalInfo info = info_of(*d);
    const bool listed = std::any_of(found.begin(), found.end(), [&info](const HidPedalInfo& other) {
      return other.path == info.path;
    });
    if (!listed && (!info.axes.empty() || info.problem))
      found.push_back(std::move(info));  // hidraw lists one entry a collection
  }
  return found;
}

/// A pedal that may be read.
struct HidPedal::Open {
  Device device;
  std::string path;
  std::vector<HidField> axes;
  bool numbered = false;
  std::size_t bytes = 0;  // to read at a time

  /// Throws Error when there is no such pedal, it cannot be used, or it has no axis of that number.
  Open(std::uint16_t vendor, std::uint16_t product, int axis, const std::string& wanted = {}) {
    const std::lock_guard lock(hidapi_mutex());
    const Devices devices(hid_enumerate(vendor, product));
    const hid_device_info* d = devices.get();
    while (d != nullptr && !wanted.empty() && wanted != d->path) d = d->next;
    if (d == nullptr)
      throw pedal_error(vendor, product, DeviceError::not_there, msg("is not plugged in"),
                        msg("plug it in; `cavum devices` lists what is there"));
    path = d->path;
    const HidLayout layout = parse_hid_descriptor(descriptor_of(path));
    axes = layout.axes();
    if (axis < 0 || static_cast<std::size_t>(axis) >= axes.size())
      throw pedal_error(vendor, product, DeviceError::no_such_axis,
                        msg("has {} axes, and axis {} is wanted", axes.size(), axis),
                        msg("calibrate it anew: `cavum devices --calibrate-pedal`"));
    numbered = layout.numbered;
    // A pseudo terminal keeps no borders between reports: where there is one kind of report,
    // exactly its length is read.
    bytes = layout.longest_bytes();
    device.reset(hid_open_path(path.c_str()));
    if (device == nullptr) throw not_permitted(vendor, product, path);
  }

  /// Bytes of the next report, 0 when none came in time, -1 when the device is gone. Unplugging may
  /// read as silence.
  [[nodiscard]] int hear(Bytes& report, int patience_ms) const {
    report.resize(bytes);
    const int n = hid_read_timeout(device.get(), report.data(), report.size(), patience_ms);
    return n == 0 && path.starts_with("/dev/") && ::access(path.c_str(), F_OK) != 0 ? -1 : n;
  }
};

PedalHearing hear_pedal(std::uint16_t vendor, std::uint16_t product, double seconds) {
  const HidPedal::Open open(vendor, product, 0);
  PedalHearing heard;
  heard.numbers.resize(open.axes.size());
  for (const HidField& axis : open.axes)
    heard.ranges.push_back(static_cast<std::int64_t>(axis.most) - axis.least);
  Bytes report;
  while (open.hear(report, 0) > 0) {  // said before anybody listened
  }
  double sum_s = 0.0, sum_square = 0.0;
  std::uint64_t last_us = 0;
  for (const std::uint64_t end_us = now_us() + static_cast<std::uint64_t>(seconds * 1e6);
       now_us() < end_us;) {
    const int n = open.hear(report, 10);
    if (n < 0)
      throw pedal_error(vendor, product, DeviceError::lost, msg("was unplugged"),
                        msg("plug it in and begin again"));
    if (n == 0) continue;
    ++heard.reports;
    const std::uint64_t now = now_us();
    if (last_us != 0) {
      const double period_s = static_cast<double>(now - last_us) * 1e-6;
      heard.longest_gap_s = std::max(heard.longest_gap_s, period_s);
      sum_s += period_s;
      sum_square += period_s * period_s;
    }
    last_us = now;
    for (std::size_t i = 0; i < open.axes.size(); ++i)
      if (const auto value = hid_value(open.axes[i], open.numbered,
                                       std::span(report).first(static_cast<std::size_t>(n))))
        heard.numbers[i].push_back(*value);
  }
  if (heard.reports > 1) {
    const auto periods = static_cast<double>(heard.reports - 1);
    heard.mean_period_s = sum_s / periods;
    heard.jitter_s =
        std::sqrt(std::max(0.0, sum_square / periods - heard.mean_period_s * heard.mean_period_s));
  }
  return heard;
}

HidPedal::HidPedal(std::uint16_t vendor, std::uint16_t product, PedalCalibration calibration,
                   std::string path)
    : vendor_(vendor),
      product_(product),
      calibration_(calibration),
      path_(std::move(path)),
      problem_(pedal_error(vendor, product, DeviceError::starting, msg("was not looked for yet"),
                           msg("wait a second"))),
      thread_([this] { run(); }) {}

HidPedal::~HidPedal() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  stop_asked_.notify_all();
  thread_.join();
}

bool HidPedal::wait(double seconds) {
  std::unique_lock lock(mutex_);
  return stop_asked_.wait_for(lock, std::chrono::duration<double>(seconds),
                              [this] { return stop_; });
}

void HidPedal::forget(Error why) {
  latest_.store(0, std::memory_order_release);
  const std::lock_guard lock(mutex_);
  problem_ = std::move(why);
}

void HidPedal::run() {
  constexpr double k_look_again_s = 0.2;
  do {
    try {
      Open open(vendor_, product_, calibration_.axis, path_);
      {
        const std::lock_guard lock(mutex_);
        ++counts_.plugged_in;
        problem_.reset();
      }
      serve(open);
    } catch (const Error& e) {
      forget(e);
    } catch (const std::exception& e) {
      forget(pedal_error(vendor_, product_, DeviceError::failed,
                         msg("cannot be served ({})", e.what()), msg("begin Cavum again")));
    }
  } while (!wait(k_look_again_s));
}

void HidPedal::hear(std::int32_t raw, const HidField& axis) {
  const bool calibrated = calibration_.released != calibration_.pressed;
  const double position = pedal_position(raw, calibrated ? calibration_.released : axis.least,
                                         calibrated ? calibration_.pressed : axis.most);
  latest_.store(now_us() << 16 | static_cast<std::uint64_t>(position * 65535.0 + 0.5),
                std::memory_order_release);
}

/// Until it is unplugged, or the pedal is no longer wanted.
void HidPedal::serve(Open& open) {
  constexpr int k_patience_ms = 10;
  Bytes report;
  std::uint64_t last_us = 0;
  const HidField& axis = open.axes[static_cast<std::size_t>(calibration_.axis)];
  for (;;) {
    const int n = open.hear(report, k_patience_ms);
    const bool gone = n < 0;
    {
      const std::lock_guard lock(mutex_);
      if (stop_) return;
      if (gone) ++counts_.unplugged;
    }
    if (gone) {
      forget(pedal_error(vendor_, product_, DeviceError::lost, msg("was unplugged"),
                         msg("plug it in again")));
      return;
    }
    if (n == 0) {
      if (const auto held = latest_.load(std::memory_order_relaxed);
          calibration_.speaks_on_change && held != 0)
        latest_.store(now_us() << 16 | (held & 0xffff), std::memory_order_release);
      continue;
    }
    const auto value =
        hid_value(axis, open.numbered, std::span(report).first(static_cast<std::size_t>(n)));
    if (value) hear(*value, axis);
    const std::uint64_t now = now_us();
    const std::lock_guard lock(mutex_);
    value ? ++counts_.reports : ++counts_.foreign_reports;
    if (last_us != 0)
      counts_.longest_gap_s =
          std::max(counts_.longest_gap_s, static_cast<double>(now - last_us) * 1e-6);
    last_us = now;
  }
}

PedalReading HidPedal::read() noexcept {
  const std::uint64_t latest = latest_.load(std::memory_order_acquire);
  if (latest == 0) return {};
  const double age_s = static_cast<double>((now_us() & ~0ULL >> 16) - (latest >> 16)) * 1e-6;
  return {static_cast<double>(latest & 0xffff) / 65535.0, age_s <= k_stale_after_s};
}

HidPedalCounts HidPedal::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

std::optional<Error> HidPedal::problem() const {
  const std::lock_guard lock(mutex_);
  return problem_;
}

}  // namespace cavum
