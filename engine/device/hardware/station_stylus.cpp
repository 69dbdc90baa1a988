#include "engine/device/hardware/station_stylus.h"

#include <unistd.h>

#include <sstream>

#include "engine/base/file.h"
#include "engine/base/toml_reader.h"

namespace cavum {
namespace {

/// The numbers of a list of `count`, each within ±`most`.
std::vector<double> numbers(TomlReader& in, std::string_view key, std::size_t count, double most) {
  const toml::array* list = in.array(key);
  if (list == nullptr) in.fail(key, "is missing", "place the stylus anew: `cavum devices --place`");
  std::vector<double> values;
  for (const auto& item : *list) {
    const auto number = item.value<double>();
    if (!number || !(std::fabs(*number) <= most))
      in.fail(key, "holds what is no number in its range", "place the stylus anew: `cavum devices --place`");
    values.push_back(*number);
  }
  if (values.size() != count) in.fail(key, "needs " + std::to_string(count) + " numbers", "place the stylus anew: `cavum devices --place`");
  return values;
}

Quat quaternion(TomlReader& in, std::string_view key) {
  const auto q = numbers(in, key, 4, 1.0 + 1e-9);
  if (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] < 0.5) in.fail(key, "is no rotation", "write w, x, y, z of a unit quaternion");
  return normalized(Quat{q[0], q[1], q[2], q[3]});
}

std::string list(const Quat& q) {
  std::ostringstream out;
  out.precision(17);
  out << "[" << q.w << ", " << q.x << ", " << q.y << ", " << q.z << "]";
  return out.str();
}

std::string quoted(const std::string& text) {
  std::ostringstream out;
  out << toml::value<std::string>(text);
  return out.str();
}

}  // namespace

std::string station_stylus_path(const std::string& id) { return station_path("stylus-" + id + ".toml"); }

StationStylus usual_station_stylus(const std::string& id) {
  // Both devices: x to the right, y up, z towards the candidate. The candidate looks at the tooth with mesial to the right and buccal away.
  StationStylus s;
  s.placement.rotation = rotation_of({1, 0, 0}, {0, 0, 1}, {0, -1, 0});
  constexpr double k_middle_of_falcon_mm = 120.0;  // in front of its base, by its kinematics
  if (id == "falcon") s.placement.offset_mm = {0, k_middle_of_falcon_mm, 0};
  if (id == "simulated") s.placement = {};
  return s;
}

StationStylus parse_station_stylus(const std::string& text, const std::string& where) {
  const toml::table table = parse_toml(text, where);
  TomlReader in(table, where);
  StationStylus s;
  s.placement.rotation = quaternion(in, "rotation");
  const auto offset = numbers(in, "offset_mm", 3, 1000.0);
  s.placement.offset_mm = {offset[0], offset[1], offset[2]};
  s.placement.tool = quaternion(in, "tool");
  s.firmware = in.text_or("firmware", s.firmware);
  s.arm_offset_deg = in.number_or("arm_offset_deg", 0, 90, s.arm_offset_deg);
  s.library = in.text_or("library", s.library);
  s.device_name = in.text_or("device_name", s.device_name);
  in.finish();
  return s;
}

StationStylus load_station_stylus(const std::string& id) {
  const std::string path = station_stylus_path(id);
  return ::access(path.c_str(), F_OK) == 0 ? parse_station_stylus(read_text_file(path), path) : usual_station_stylus(id);
}

std::string to_toml(const StationStylus& s) {
  std::ostringstream out;
  out.precision(17);
  out << "# How a stylus of this station stands beside the tooth, by `cavum devices --place`.\nrotation = " << list(s.placement.rotation)
      << "\noffset_mm = [" << s.placement.offset_mm.x << ", " << s.placement.offset_mm.y << ", " << s.placement.offset_mm.z
      << "]\ntool = " << list(s.placement.tool) << "\narm_offset_deg = " << s.arm_offset_deg << "\n";
  if (!s.firmware.empty()) out << "firmware = " << quoted(s.firmware) << "\n";
  if (s.library != StationStylus{}.library) out << "library = " << quoted(s.library) << "\n";
  if (!s.device_name.empty()) out << "device_name = " << quoted(s.device_name) << "\n";
  return out.str();
}

}  // namespace cavum
