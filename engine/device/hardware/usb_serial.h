// The serial number of a USB device as the kernel read it, so that a recording can name the very
// stylus that moved it.
#pragma once

#include <cstdint>
#include <string>

namespace cavum {

/// Of the first device with these numbers that is plugged in, from /sys/bus/usb/devices; one line.
/// Empty when there is none or it tells none.
[[nodiscard]] std::string usb_serial(std::uint16_t vendor, std::uint16_t product);

}  // namespace cavum
