#include "tests/device/emulated_pedal.h"

#include <linux/hidraw.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <stdexcept>

namespace cavum::testing_device {
namespace {

/// Answers what hidapi asks of a hidraw node when it opens one.
gboolean answer(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer descriptor_of_device) {
  const auto& descriptor = *static_cast<const std::vector<std::uint8_t>*>(descriptor_of_device);
  UMockdevIoctlData* arg = umockdev_ioctl_client_get_arg(client);
  GError* error = nullptr;
  const auto fill = [&](const void* bytes, std::size_t size) {
    UMockdevIoctlData* place = umockdev_ioctl_data_resolve(arg, 0, size, &error);
    if (place == nullptr) return false;
    umockdev_ioctl_data_update(place, 0, const_cast<guint8*>(static_cast<const guint8*>(bytes)),
                               static_cast<gint>(size));
    umockdev_ioctl_data_unref(place);
    return true;
  };
  bool known = false;
  if (const gulong request = umockdev_ioctl_client_get_request(client);
      request == HIDIOCGRDESCSIZE) {
    const int size = static_cast<int>(descriptor.size());
    known = fill(&size, sizeof size);
  } else if (request == HIDIOCGRDESC) {
    hidraw_report_descriptor whole{};
    whole.size = static_cast<std::uint32_t>(descriptor.size());
    std::memcpy(whole.value, descriptor.data(),
                std::min<std::size_t>(descriptor.size(), sizeof whole.value));
    known = fill(&whole, sizeof whole);
  }
  umockdev_ioctl_client_complete(client, known ? 0 : -1, known ? 0 : ENOTTY);
  g_clear_error(&error);
  return TRUE;
}

}  // namespace

const std::vector<std::uint8_t>& three_axes_descriptor() {
  static const std::vector<std::uint8_t> descriptor{
      0x05, 0x01, 0x09, 0x04, 0xa1, 0x01,  // generic desktop, joystick, application
      0x09, 0x30, 0x09, 0x31, 0x09, 0x32,  // X, Y, Z
      0x15, 0x00, 0x26, 0xff, 0x00,        // 0 to 255
      0x75, 0x08, 0x95, 0x03, 0x81, 0x02, 0xc0};
  return descriptor;
}

bool EmulatedPedal::possible() {
  const char* preload = std::getenv("LD_PRELOAD");
  return preload != nullptr && std::strstr(preload, "umockdev") != nullptr;
}

EmulatedPedal::EmulatedPedal(const std::vector<std::uint8_t>& descriptor)
    : bed_(umockdev_testbed_new()), descriptor_(descriptor) {
  plug_in();
}

EmulatedPedal::~EmulatedPedal() {
  if (!raw_.empty()) unplug();
}

void EmulatedPedal::plug_in() {
  const auto add = [this](const char* subsystem, const char* name, const char* parent,
                          std::vector<const char*> attributes,
                          std::vector<const char*> properties) {
    attributes.push_back(nullptr);
    properties.push_back(nullptr);
    gchar* made = umockdev_testbed_add_devicev(bed_.get(), subsystem, name, parent,
                                               const_cast<gchar**>(attributes.data()),
                                               const_cast<gchar**>(properties.data()));
    if (made == nullptr) throw std::runtime_error(std::string("umockdev could not add ") + name);
    std::string path = made;
    g_free(made);
    return path;
  };
  usb_ = add("usb", "3-1", nullptr,
             {"idVendor", "068e", "idProduct", "00f2", "manufacturer", "CH Products", "product",
              "Pro Pedals", "bcdDevice", "0100", "busnum", "3", "devnum", "2"},
             {"DEVTYPE", "usb_device", "PRODUCT", "68e/f2/100"});
  interface_ =
      add("usb", "3-1:1.0", usb_.c_str(), {"bInterfaceNumber", "00"}, {"DEVTYPE", "usb_interface"});
  hid_ = add(
      "hid", "0003:068E:00F2.0001", interface_.c_str(), {},
      {"HID_ID", "0003:0000068E:000000F2", "HID_NAME", "CH Products Pro Pedals", "HID_UNIQ", ""});
  umockdev_testbed_set_attribute_binary(bed_.get(), hid_.c_str(), "report_descriptor",
                                        descriptor_.data(), static_cast<gint>(descriptor_.size()));
  const std::string number = std::to_string(++number_),
                    name = "hidraw" + number;  // the kernel counts on, too
  raw_ = hid_ + "/" + name;
  GError* error = nullptr;
  const std::string node_text = "P: " + raw_.substr(4) + "\nN: " + name + "\nE: DEVNAME=/dev/" +
                                name + "\nE: SUBSYSTEM=hidraw\nE: MAJOR=240\nE: MINOR=" + number +
                                "\nA: dev=240:" + number + "\nL: device=..\n";
  if (umockdev_testbed_add_from_string(bed_.get(), node_text.c_str(), &error) == FALSE)
    throw std::runtime_error(std::string("umockdev could not make the node: ") +
                             (error != nullptr ? error->message : ""));
  ioctls_.reset(umockdev_ioctl_base_new());
  g_signal_connect(ioctls_.get(), "handle-ioctl", G_CALLBACK(answer), &descriptor_);
  if (umockdev_testbed_attach_ioctl(bed_.get(), node().c_str(), ioctls_.get(), &error) == FALSE)
    throw std::runtime_error(std::string("umockdev could not answer ioctls: ") +
                             (error != nullptr ? error->message : ""));
}

void EmulatedPedal::unplug() {
  GError* error = nullptr;
  umockdev_testbed_detach_ioctl(bed_.get(), node().c_str(), &error);
  g_clear_error(&error);
  for (std::string* path : {&raw_, &hid_, &interface_, &usb_}) {
    umockdev_testbed_remove_device(bed_.get(), path->c_str());
    path->clear();
  }
}

bool EmulatedPedal::report(const std::vector<std::uint8_t>& bytes) {
  const int fd = umockdev_testbed_get_dev_fd(bed_.get(), node().c_str());
  // nobody reads it any more: what they left unread would hold up the foot
  pollfd room{fd, POLLOUT, 0};
  if (fd < 0 || ::poll(&room, 1, 0) != 1 || (room.revents & POLLOUT) == 0) return false;
  return ::write(fd, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
}

void EmulatedPedal::forbid() {
  gchar* root = umockdev_testbed_get_root_dir(bed_.get());
  ::chmod((std::string(root) + node()).c_str(), 0);
  g_free(root);
}

}  // namespace cavum::testing_device
