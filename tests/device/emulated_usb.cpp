#include "tests/device/emulated_usb.h"

#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <stdexcept>

namespace cavum::testing_device {
namespace {

std::string hex(const std::vector<std::uint8_t>& bytes) {
  std::string text;
  char two[3];
  for (const std::uint8_t b : bytes) {
    std::snprintf(two, sizeof two, "%02X", b);
    text += two;
  }
  return text;
}

}  // namespace

EmulatedUsb::EmulatedUsb(int port, Bytes facts, UMockdevTestbed* bed)
    : bed_(bed != nullptr ? UMOCKDEV_TESTBED(g_object_ref(bed)) : umockdev_testbed_new()),
      port_(port),
      facts_(std::move(facts)) {}

EmulatedUsb::~EmulatedUsb() { leave(); }

void EmulatedUsb::leave() {
  if (!gone_) unplug();
}

std::string EmulatedUsb::node() const { return "/dev/bus/usb/003/00" + std::to_string(number_); }

void EmulatedUsb::forbid() {
  gchar* root = umockdev_testbed_get_root_dir(bed_.get());
  ::chmod((std::string(root) + node()).c_str(), 0);
  g_free(root);
}

void EmulatedUsb::plug_in() {
  const std::string number = std::to_string(++number_), minor = std::to_string(255 + number_);
  device_ = "/sys/devices/pci0000:00/usb3/3-" + std::to_string(port_);
  const auto two = [this](std::size_t at) {
    char text[8];
    std::snprintf(text, sizeof text, "%02x%02x", facts_[at + 1], facts_[at]);
    return std::string(text);
  };
  const std::string text =
      "P: " + device_.substr(4) + "\nN: bus/usb/003/00" + number +
      "\nE: DEVNAME=/dev/bus/usb/003/00" + number +
      "\nE: DEVTYPE=usb_device\nE: SUBSYSTEM=usb\nE: BUSNUM=003\nE: DEVNUM=00" + number +
      "\nE: MAJOR=189\nE: MINOR=" + minor + "\nA: busnum=3\\n\nA: devnum=" + number +
      "\\n\nA: speed=12\\n\nA: bConfigurationValue=1\\n\nA: idVendor=" + two(8) +
      "\\n\nA: idProduct=" + two(10) + "\\n\nA: dev=189:" + minor +
      "\nH: descriptors=" + hex(facts_) + "\n";
  GError* error = nullptr;
  if (umockdev_testbed_add_from_string(bed_.get(), text.c_str(), &error) == FALSE)
    throw std::runtime_error(std::string("umockdev could not make the device: ") +
                             (error != nullptr ? error->message : ""));
  with_lock([&] {
    gone_ = false;
    urbs_.clear();
    plugged_in();
  });
  ioctls_.reset(umockdev_ioctl_base_new());
  g_signal_connect(ioctls_.get(), "handle-ioctl", G_CALLBACK(answer), this);
  if (umockdev_testbed_attach_ioctl(bed_.get(), node().c_str(), ioctls_.get(), &error) == FALSE)
    throw std::runtime_error(std::string("umockdev could not answer for the device: ") +
                             (error != nullptr ? error->message : ""));
  umockdev_testbed_uevent(bed_.get(), device_.c_str(), "add");
}

void EmulatedUsb::unplug() {
  with_lock([&] { gone_ = true; });
  // As in the kernel: transfers under way end with an error, and are fetched before the file is
  // closed.
  for (int i = 0; i < 200; ++i) {
    bool fetched = false;
    with_lock([&] { fetched = urbs_.empty(); });
    if (fetched) break;
    ::usleep(1000);
  }
  with_lock([&] { urbs_.clear(); });
  unplugging();
  umockdev_testbed_uevent(bed_.get(), device_.c_str(), "remove");
  umockdev_testbed_remove_device(bed_.get(), device_.c_str());
}

/// Completes a transfer when there is what it waits for.
void EmulatedUsb::settle(Urb& u) {
  if (u.done) return;
  if (gone_) {
    u.done = true;
    u.status = -ESHUTDOWN;
    return;
  }
  const auto& urb = *reinterpret_cast<const usbdevfs_urb*>(u.urb->data);
  const auto put = [&u](std::size_t at, const Bytes& bytes) {
    umockdev_ioctl_data_update(u.buffer.get(), static_cast<gint>(at),
                               const_cast<guint8*>(bytes.data()), static_cast<gint>(bytes.size()));
    u.moved = static_cast<int>(bytes.size());
  };
  constexpr std::size_t k_setup = 8;
  if (urb.type == USBDEVFS_URB_TYPE_CONTROL) {
    const Bytes setup(u.buffer->data, u.buffer->data + urb.buffer_length);
    if (auto reply = control(setup); !reply) {
      u.status = -EPIPE;
    } else {
      reply->resize(std::min(reply->size(), setup.size() - k_setup));
      if ((setup[0] & 0x80) != 0 && !reply->empty()) put(k_setup, *reply);
    }
    u.done = true;
  } else if ((urb.endpoint & 0x80) == 0) {
    hear(Bytes(u.buffer->data, u.buffer->data + urb.buffer_length));
    u.moved = urb.buffer_length;
    u.done = true;
  } else if (auto said = say(static_cast<std::size_t>(urb.buffer_length), u.submitted)) {
    put(0, *said);
    u.done = true;
  }
}

gboolean EmulatedUsb::answer(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self) {
  static_cast<EmulatedUsb*>(self)->serve(client);
  return TRUE;
}

void EmulatedUsb::serve(UMockdevIoctlClient* client) {
  const std::lock_guard lock(mutex_);
  const auto done = [client](int error) {
    umockdev_ioctl_client_complete(client, error == 0 ? 0 : -1, error);
  };
  UMockdevIoctlData* arg = umockdev_ioctl_client_get_arg(client);
  const auto at = [](UMockdevIoctlData* from, gsize offset, gsize size) {
    GError* error = nullptr;
    UMockdevIoctlData* data = umockdev_ioctl_data_resolve(from, static_cast<gint>(offset),
                                                          static_cast<gint>(size), &error);
    g_clear_error(&error);
    return std::shared_ptr<UMockdevIoctlData>(data, [](UMockdevIoctlData* d) {
      if (d != nullptr) umockdev_ioctl_data_unref(d);
    });
  };
  const gulong request = umockdev_ioctl_client_get_request(client);
  const bool fetches = request == USBDEVFS_REAPURB || request == USBDEVFS_REAPURBNDELAY;
  if (gone_ && (!fetches || urbs_.empty()))
    return done(request == USBDEVFS_DISCARDURB ? EINVAL : ENODEV);
  switch (request) {
    case USBDEVFS_GET_CAPABILITIES: {
      const auto place = at(arg, 0, sizeof(std::uint32_t));
      std::uint32_t none = 0;
      umockdev_ioctl_data_update(place.get(), 0, reinterpret_cast<guint8*>(&none), sizeof none);
      return done(0);
    }
    case USBDEVFS_GETDRIVER:
      return done(ENODATA);
    case USBDEVFS_CLAIMINTERFACE:
    case USBDEVFS_RELEASEINTERFACE:
    case USBDEVFS_DISCONNECT_CLAIM:
    case USBDEVFS_SETCONFIGURATION:
      return done(0);
    case USBDEVFS_SUBMITURB: {
      Urb u;
      u.urb = at(arg, 0, sizeof(usbdevfs_urb));
      const auto& urb = *reinterpret_cast<const usbdevfs_urb*>(u.urb->data);
      u.buffer = at(u.urb.get(), offsetof(usbdevfs_urb, buffer),
                    static_cast<gsize>(std::max(1, urb.buffer_length)));
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
          umockdev_ioctl_data_update(i->urb.get(), static_cast<gint>(offset),
                                     reinterpret_cast<guint8*>(const_cast<int*>(&value)),
                                     sizeof value);
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
