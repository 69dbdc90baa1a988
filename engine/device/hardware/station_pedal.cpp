#include "engine/device/hardware/station_pedal.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>

#include "engine/base/file.h"
#include "engine/base/toml_reader.h"
#include "engine/device/device_error.h"

namespace cavum {

void parse_usb_id(const std::string& text, const Message& where, std::uint16_t& vendor,
                  std::uint16_t& product) {
  const char* const end = text.data() + text.size();
  const bool shaped = text.size() == 9 && text[4] == ':';
  const auto four = [&](const char* from, std::uint16_t& number) {
    const auto [rest, error] = std::from_chars(from, from + 4, number, 16);
    return error == std::errc{} && rest == from + 4;
  };
  if (!shaped || !four(text.data(), vendor) || !four(end - 4, product))
    throw Error(
        DeviceError::not_a_usb_id, where, msg("'{}' is no USB device", text),
        msg("write vendor and product as `cavum devices` shows them, for example 068e:00f2"));
}

std::string usb_id(std::uint16_t vendor, std::uint16_t product) {
  return fmt::format("{:04x}:{:04x}", vendor, product);
}

std::string station_pedal_path() { return station_path("pedal.toml"); }

StationPedal parse_station_pedal(const std::string& text, const std::string& where) {
  const toml::table table = parse_toml(text, where);
  TomlReader reader(table, where);
  StationPedal pedal;
  parse_usb_id(reader.text("id"), msg("{}: id", where), pedal.vendor, pedal.product);
  constexpr double k_most = 2147483647.0;
  pedal.calibration.axis = static_cast<int>(reader.number("axis", 0, 63));
  pedal.calibration.released =
      static_cast<std::int32_t>(reader.number("released", -k_most, k_most));
  pedal.calibration.pressed = static_cast<std::int32_t>(reader.number("pressed", -k_most, k_most));
  pedal.calibration.speaks_on_change = reader.truth_or("speaks_on_change", false);
  reader.finish();
  if (pedal.calibration.released == pedal.calibration.pressed)
    throw Error(DeviceError::ends_equal, Name{where}, msg("released and pressed are the same"),
                msg("calibrate the pedal anew: `cavum devices --calibrate-pedal`"));
  return pedal;
}

std::optional<StationPedal> load_station_pedal(const std::string& path) {
  if (::access(path.c_str(), F_OK) != 0) return std::nullopt;
  return parse_station_pedal(read_text_file(path), path);
}

std::string to_toml(const StationPedal& pedal) {
  const PedalCalibration& c = pedal.calibration;
  return fmt::format(
      "# The foot pedal of this station, by `cavum devices --calibrate-pedal`.\nid = \"{}\"\naxis = {}\nreleased = {}\npressed = "
      "{}\nspeaks_on_change = {}\n",
      usb_id(pedal.vendor, pedal.product), c.axis, c.released, c.pressed,
      c.speaks_on_change ? "true" : "false");
}

PedalCalibration calibrate_pedal(const std::vector<AxisReceived>& axes,
                                 const std::vector<std::int64_t>& ranges, bool speaks_on_change) {
  constexpr double k_min_share = 0.1, k_draw_in = 0.02;
  std::size_t best = 0;
  double best_share = 0.0;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const double share = std::abs(static_cast<double>(axes[i].pressed) - axes[i].released) /
                         static_cast<double>(std::max<std::int64_t>(1, ranges[i]));
    if (share > best_share) {
      best = i;
      best_share = share;
    }
  }
  if (best_share < k_min_share)
    throw Error(DeviceError::axes_still, msg("calibration"),
                msg("no axis moved by a tenth of its range"),
                msg("press the pedal fully when asked to, and check its cable"));
  const AxisReceived& heard = axes[best];
  const double way = static_cast<double>(heard.pressed) - heard.released,
               sign = way > 0 ? 1.0 : -1.0;
  const double in = sign * std::min(static_cast<double>(heard.jitter) + k_draw_in * std::abs(way),
                                    0.25 * std::abs(way));
  return {.axis = static_cast<int>(best),
          .released = static_cast<std::int32_t>(heard.released + in),
          .pressed = static_cast<std::int32_t>(heard.pressed - in),
          .speaks_on_change = speaks_on_change};
}

}  // namespace cavum
