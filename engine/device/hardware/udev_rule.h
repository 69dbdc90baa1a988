// What to do when the system does not let us open a USB device: the udev rule that gives it to
// whoever sits at the screen.
#pragma once

#include <cstdint>
#include <string>

#include "engine/base/message.h"

namespace cavum {

/// The rule alone. `hid`: for its /dev/hidraw node instead of the device itself.
[[nodiscard]] std::string udev_rule(std::uint16_t vendor, std::uint16_t product, bool hid);
/// The rule, where to put it, and what to run then.
[[nodiscard]] Message udev_advice(std::uint16_t vendor, std::uint16_t product, bool hid);

}  // namespace cavum
