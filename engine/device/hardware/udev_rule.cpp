#include "engine/device/hardware/udev_rule.h"

#include "engine/device/hardware/station_pedal.h"

namespace cavum {

std::string udev_rule(std::uint16_t vendor, std::uint16_t product, bool hid) {
  const std::string id = usb_id(vendor, product), device = id.substr(0, 4), model = id.substr(5);
  return (hid ? R"(KERNEL=="hidraw*", ATTRS{idVendor}==")" + device + R"(", ATTRS{idProduct}==")" +
                    model
              : R"(SUBSYSTEM=="usb", ATTR{idVendor}==")" + device + R"(", ATTR{idProduct}==")" +
                    model) +
         R"(", MODE="0660", TAG+="uaccess")";
}

Message udev_advice(std::uint16_t vendor, std::uint16_t product, bool hid) {
  return msg(
      "put the line  {}  into /etc/udev/rules.d/60-cavum.rules, run `udevadm control --reload` as root, and plug the device in again",
      udev_rule(vendor, product, hid));
}

}  // namespace cavum
