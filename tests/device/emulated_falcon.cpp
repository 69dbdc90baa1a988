#include "tests/device/emulated_falcon.h"

#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <stdexcept>

namespace cavum::testing_device {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// As an FT232 with its maker's numbers: one configuration, one interface, bulk in 0x81 and out 0x02.
const Bytes& usb_descriptors() {
  static const Bytes bytes{18, 1, 0x00, 0x02, 0,  0,    0,    64,   0x03, 0x04, 0x48, 0xcb, 0x00, 0x04, 1, 2, 3, 1,  // device
                           9,  2, 32,   0,    1,  1,    0,    0x80, 45,                                              // configuration
                           9,  4, 0,    0,    2,  0xff, 0xff, 0xff, 0,                                               // interface
                           7,  5, 0x81, 2,    64, 0,    0,                                                           // in
                           7,  5, 0x02, 2,    64, 0,    0};
  return bytes;
}

std::string hex(const Bytes& bytes) {
  std::string text;
  char two[3];
  for (const std::uint8_t b : bytes) {
    std::snprintf(two, sizeof two, "%02X", b);
    text += two;
  }
  return text;
}

constexpr auto k_latency = std::chrono::milliseconds(1);  // the chip answers with its status when it has nothing else

}  // namespace

EmulatedFalcon::EmulatedFalcon(bool running, bool homed)
    : bed_(umockdev_testbed_new()), running_(running), homed_(static_cast<std::uint8_t>(homed ? 7 : 0)) {
  move_to(k_falcon_middle_mm);
  plug_in();
}

EmulatedFalcon::~EmulatedFalcon() {
  if (!gone_) unplug();
}

void EmulatedFalcon::plug_in() {
  const std::string number = std::to_string(++number_);
  device_ = "/sys/devices/pci0000:00/usb3/3-2";
  const std::string text =
      "P: " + device_.substr(4) + "\nN: bus/usb/003/00" + number + "\nE: DEVNAME=/dev/bus/usb/003/00" + number +
      "\nE: DEVTYPE=usb_device\nE: SUBSYSTEM=usb\nE: BUSNUM=003\nE: DEVNUM=00" + number +
      "\nE: MAJOR=189\nE: MINOR=" + std::to_string(255 + number_) + "\nE: PRODUCT=403/cb48/400\nA: busnum=3\\n\nA: devnum=" + number +
      "\\n\nA: speed=12\\n\nA: bConfigurationValue=1\\n\nA: idVendor=0403\\n\nA: idProduct=cb48\\n\nA: dev=189:" + std::to_string(255 + number_) +
      "\nH: descriptors=" + hex(usb_descriptors()) + "\n";
  GError* error = nullptr;
  if (umockdev_testbed_add_from_string(bed_.get(), text.c_str(), &error) == FALSE)
    throw std::runtime_error(std::string("umockdev could not make the Falcon: ") + (error != nullptr ? error->message : ""));
  with_lock([&] {
    gone_ = false;
    urbs_.clear();
    baud_ = loading_ = 0;
    to_host_.clear();
    partial_.clear();
  });
  ioctls_.reset(umockdev_ioctl_base_new());
  g_signal_connect(ioctls_.get(), "handle-ioctl", G_CALLBACK(answer), this);
  if (umockdev_testbed_attach_ioctl(bed_.get(), node().c_str(), ioctls_.get(), &error) == FALSE)
    throw std::runtime_error(std::string("umockdev could not answer for the Falcon: ") + (error != nullptr ? error->message : ""));
}

void EmulatedFalcon::unplug() {
  with_lock([&] { gone_ = true; });
  // As in the kernel: transfers under way end with an error, and are fetched before the file is closed.
  for (int i = 0; i < 200; ++i) {
    bool fetched = false;
    with_lock([&] { fetched = urbs_.empty(); });
    if (fetched) break;
    ::usleep(1000);
  }
  with_lock([&] { urbs_.clear(); });
  umockdev_testbed_uevent(bed_.get(), device_.c_str(), "remove");
  umockdev_testbed_remove_device(bed_.get(), device_.c_str());
}

void EmulatedFalcon::move_to(Vec3 device_mm) {
  FalconAngles angles{};
  if (!falcon_angles({}, device_mm, angles)) throw std::runtime_error("no arm reaches there");
  with_lock([&] {
    for (std::size_t i = 0; i < 3; ++i)  // 320 slots of four edges, a gear of 7.62, 35 degrees at zero
      encoders_[i] = static_cast<std::int16_t>(std::lround((angles[i] * 180.0 / M_PI - 35.0) / 360.0 * 7.62 * 1280.0));
  });
}

std::vector<std::uint8_t> EmulatedFalcon::last_frame() const {
  const std::lock_guard lock(mutex_);
  return last_frame_;
}
std::vector<std::uint8_t> EmulatedFalcon::firmware() const {
  const std::lock_guard lock(mutex_);
  return firmware_;
}
std::int64_t EmulatedFalcon::frames() const {
  const std::lock_guard lock(mutex_);
  return frames_;
}
std::vector<std::int16_t> EmulatedFalcon::motors() const {
  const Bytes frame = last_frame();
  std::vector<std::int16_t> values;
  for (std::size_t m = 0; frame.size() == 16 && m < 3; ++m) {
    int value = 0;
    for (std::size_t n = 4; n-- > 0;) value = value * 16 + frame[1 + 4 * m + n] - 'A';
    values.push_back(static_cast<std::int16_t>(value >= 32768 ? value - 65536 : value));
  }
  return values;
}

void EmulatedFalcon::control(const Bytes& setup) {
  if (setup.size() < 8 || setup[0] != 0x40) return;
  const int value = setup[2] | setup[3] << 8;
  if (setup[1] == 0 && value == 1) to_host_.clear();
  if (setup[1] == 0 && value == 2) partial_.clear();
  if (setup[1] == 3) baud_ = value;
  if (setup[1] == 1 && value == 0x101 && baud_ == 0x4138) loading_ = running_ ? 0 : 1;
}

void EmulatedFalcon::hear(const Bytes& bytes) {
  if (silent_) return;
  if (loading_ == 1 && bytes == Bytes{0x0a, 0x43, 0x0d}) {
    for (const int b : {0x0a, 0x44, 0x2c, 0x0d}) to_host_.push_back(static_cast<std::uint8_t>(b));
    loading_ = 2;
  } else if (loading_ == 2 && baud_ == 0x15 && bytes == Bytes{0x41}) {
    to_host_.push_back(0x41);
    loading_ = 3;
    firmware_.clear();
  } else if (loading_ == 3 && baud_ == 0x15) {
    firmware_.insert(firmware_.end(), bytes.begin(), bytes.end());
    for (const std::uint8_t b : bytes) to_host_.push_back(static_cast<std::uint8_t>(wrong_echo_ ? b ^ 1 : b));
  } else if (baud_ == 2) {
    if (loading_ == 3) {  // the loader hands over
      running_ = !firmware_.empty();
      loading_ = 0;
    }
    if (!running_) return;
    for (const std::uint8_t b : bytes) {
      if (b == '<') partial_.clear();
      partial_.push_back(b);
      if (b == '>' && partial_.size() == 16) hear_frame(partial_);
    }
  }
}

void EmulatedFalcon::hear_frame(const Bytes& frame) {
  last_frame_ = frame;
  ++frames_;
  Bytes reply{'<'};
  for (const std::int16_t e : encoders_)
    for (int n = 0; n < 4; ++n) reply.push_back(static_cast<std::uint8_t>('A' + (static_cast<std::uint16_t>(e) >> (4 * n)) % 16));
  reply.push_back(static_cast<std::uint8_t>('A' + homed_ * 16 + buttons_));
  reply.push_back('A');
  reply.push_back('>');
  if (garbled_ && frames_ % 2 == 0) reply[5] = 0x20;
  to_host_.insert(to_host_.end(), reply.begin(), reply.end());
}

/// Completes a transfer when there is what it waits for.
void EmulatedFalcon::settle(Urb& u) {
  if (u.done) return;
  if (gone_) {
    u.done = true;
    u.status = -ESHUTDOWN;
    return;
  }
  const auto& urb = *reinterpret_cast<const usbdevfs_urb*>(u.urb->data);
  if (urb.type == USBDEVFS_URB_TYPE_CONTROL || (urb.endpoint & 0x80) == 0) {
    const Bytes bytes(u.buffer->data, u.buffer->data + urb.buffer_length);
    if (urb.type == USBDEVFS_URB_TYPE_CONTROL)
      control(bytes);
    else
      hear(bytes);
    u.moved = urb.type == USBDEVFS_URB_TYPE_CONTROL ? 0 : urb.buffer_length;
    u.done = true;
  } else if (!to_host_.empty() || std::chrono::steady_clock::now() - u.submitted >= k_latency) {
    Bytes packet{0x01, 0x60};  // the chip's status
    while (!to_host_.empty() && packet.size() < std::min<std::size_t>(64, static_cast<std::size_t>(urb.buffer_length))) {
      packet.push_back(to_host_.front());
      to_host_.pop_front();
    }
    umockdev_ioctl_data_update(u.buffer.get(), 0, packet.data(), static_cast<gint>(packet.size()));
    u.moved = static_cast<int>(packet.size());
    u.done = true;
  }
}

gboolean EmulatedFalcon::answer(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self) {
  static_cast<EmulatedFalcon*>(self)->serve(client);
  return TRUE;
}

void EmulatedFalcon::serve(UMockdevIoctlClient* client) {
  const std::lock_guard lock(mutex_);
  const auto done = [client](int error) { umockdev_ioctl_client_complete(client, error == 0 ? 0 : -1, error); };
  UMockdevIoctlData* arg = umockdev_ioctl_client_get_arg(client);
  const auto at = [](UMockdevIoctlData* from, gsize offset, gsize size) {
    GError* error = nullptr;
    UMockdevIoctlData* data = umockdev_ioctl_data_resolve(from, static_cast<gint>(offset), static_cast<gint>(size), &error);
    g_clear_error(&error);
    return std::shared_ptr<UMockdevIoctlData>(data, [](UMockdevIoctlData* d) {
      if (d != nullptr) umockdev_ioctl_data_unref(d);
    });
  };
  const gulong request = umockdev_ioctl_client_get_request(client);
  const bool fetches = request == USBDEVFS_REAPURB || request == USBDEVFS_REAPURBNDELAY;
  if (gone_ && (!fetches || urbs_.empty())) return done(request == USBDEVFS_DISCARDURB ? EINVAL : ENODEV);
  switch (request) {
    case USBDEVFS_GET_CAPABILITIES: {
      const auto place = at(arg, 0, sizeof(std::uint32_t));
      std::uint32_t none = 0;
      umockdev_ioctl_data_update(place.get(), 0, reinterpret_cast<guint8*>(&none), sizeof none);
      return done(0);
    }
    case USBDEVFS_CLAIMINTERFACE:
    case USBDEVFS_RELEASEINTERFACE:
    case USBDEVFS_DISCONNECT_CLAIM:
    case USBDEVFS_SETCONFIGURATION:
      return done(0);
    case USBDEVFS_SUBMITURB: {
      Urb u;
      u.urb = at(arg, 0, sizeof(usbdevfs_urb));
      const auto& urb = *reinterpret_cast<const usbdevfs_urb*>(u.urb->data);
      u.buffer = at(u.urb.get(), offsetof(usbdevfs_urb, buffer), static_cast<gsize>(std::max(1, urb.buffer_length)));
      u.submitted = std::chrono::steady_clock::now();
      settle(u);
      urbs_.push_back(std::move(u));
      return done(0);
    }
    case USBDEVFS_DISCARDURB: {
      // the argument is the transfer's own address
      const auto address = *reinterpret_cast<const gulong*>(arg->data);
      for (Urb& u : urbs_)
        if (u.urb->client_addr == address && !u.done) {
          u.done = true;
          u.status = -ENOENT;
          return done(0);
        }
      return done(EINVAL);
    }
    case USBDEVFS_REAPURB:
    case USBDEVFS_REAPURBNDELAY: {
      for (auto i = urbs_.begin(); i != urbs_.end(); ++i) {
        settle(*i);
        if (!i->done) continue;
        auto urb = *reinterpret_cast<const usbdevfs_urb*>(i->urb->data);
        urb.status = i->status;
        urb.actual_length = i->moved;
        const auto put = [&i](std::size_t offset, const int& value) {
          umockdev_ioctl_data_update(i->urb.get(), static_cast<gint>(offset), reinterpret_cast<guint8*>(const_cast<int*>(&value)), sizeof value);
        };
        put(offsetof(usbdevfs_urb, status), urb.status);
        put(offsetof(usbdevfs_urb, actual_length), urb.actual_length);
        const auto place = at(arg, 0, sizeof(void*));
        GError* error = nullptr;
        umockdev_ioctl_data_set_ptr(place.get(), 0, i->urb.get());
        g_clear_error(&error);
        done(0);
        urbs_.erase(i);
        return;
      }
      ::usleep(100);  // the other side asks again at once: its poll finds the node always ready
      return done(EAGAIN);
    }
    default:
      return done(ENOTTY);
  }
}

}  // namespace cavum::testing_device
