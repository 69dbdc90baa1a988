#include "engine/device/hardware/usb_serial.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <vector>

#include "engine/base/text.h"

namespace cavum {
namespace {

std::string first_line(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

std::string four_digits(std::uint16_t number) { return fmt::format("{:04x}", number); }

}  // namespace

std::string usb_serial(std::uint16_t vendor, std::uint16_t product) {
  std::error_code none;
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::directory_iterator("/sys/bus/usb/devices", none))
    if (first_line(entry.path() / "idVendor") == four_digits(vendor) &&
        first_line(entry.path() / "idProduct") == four_digits(product))
      found.push_back(entry.path());
  if (found.empty()) return {};
  constexpr std::size_t k_longest = 126;  // of a USB string
  return one_line(first_line(std::min_element(found.begin(), found.end())->string() + "/serial")
                      .substr(0, k_longest));
}

}  // namespace cavum
