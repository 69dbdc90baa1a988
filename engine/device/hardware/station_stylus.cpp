#include "engine/device/hardware/station_stylus.h"

#include <fmt/core.h>
#include <unistd.h>

#include <sstream>

#include "engine/base/file.h"
#include "engine/base/toml_reader.h"
#include "engine/device/device_error.h"
#include "engine/device/hardware/stylus_kind.h"

namespace cavum {
namespace {

/// The numbers of a list of `count`, each within ±`most`.
std::vector<double> numbers(TomlReader& in, std::string_view key, std::size_t count, double most) {
  const toml::array* list = in.array(key);
  if (list == nullptr)
    in.fail(key, msg("is missing"), msg("place the stylus anew: `cavum devices --place`"));
  std::vector<double> values;
  for (const auto& item : *list) {
    const auto number = item.value<double>();
    if (!number || !(std::fabs(*number) <= most))
      in.fail(key, msg("holds what is no number in its range"),
              msg("place the stylus anew: `cavum devices --place`"));
    values.push_back(*number);
  }
  if (values.size() != count)
    in.fail(key, msg("needs {} numbers", count),
            msg("place the stylus anew: `cavum devices --place`"));
  return values;
}

Quat quaternion(TomlReader& in, std::string_view key) {
  const auto q = numbers(in, key, 4, 1.0 + 1e-9);
  if (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] < 0.5)
    in.fail(key, msg("is no rotation"), msg("write w, x, y, z of a unit quaternion"));
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

StylusValue read_setting(TomlReader& in, const StylusSetting& s) {
  if (const auto* number = std::get_if<double>(&s.usual))
    return in.number_or(s.key, s.least, s.most, *number);
  return in.text_or(s.key, std::get<std::string>(s.usual));
}

std::string written(const StylusValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return quoted(*text);
  std::ostringstream out;
  out.precision(17);
  out << std::get<double>(value);
  return out.str();
}

template <class T>
const T& setting(const StationStylus& s, const std::string& key) {
  const auto found = s.settings.find(key);
  if (found == s.settings.end() || !std::holds_alternative<T>(found->second))
    throw Error(DeviceError::not_a_setting, msg("setting '{}'", key), msg("is none of this stylus"),
                msg("add it to the settings of its record"));
  return std::get<T>(found->second);
}

}  // namespace

double StationStylus::number(const std::string& key) const { return setting<double>(*this, key); }
const std::string& StationStylus::text(const std::string& key) const {
  return setting<std::string>(*this, key);
}

std::string station_stylus_path(const std::string& id) {
  return station_path(fmt::format("stylus-{}.toml", id));
}

StationStylus usual_station_stylus(const StylusKind& kind) {
  StationStylus s{.placement = kind.placement, .settings = {}};
  for (const auto& setting : kind.settings) s.settings[setting.key] = setting.usual;
  return s;
}

StationStylus parse_station_stylus(const std::string& text, const std::string& where,
                                   const StylusKind& kind) {
  const toml::table table = parse_toml(text, where);
  TomlReader in(table, where);
  StationStylus s = usual_station_stylus(kind);
  s.placement.rotation = quaternion(in, "rotation");
  const auto offset = numbers(in, "offset_mm", 3, 1000.0);
  s.placement.offset_mm = {offset[0], offset[1], offset[2]};
  s.placement.tool = quaternion(in, "tool");
  for (const auto& setting : kind.settings) s.settings[setting.key] = read_setting(in, setting);
  in.finish();
  return s;
}

StationStylus load_station_stylus(const StylusKind& kind) {
  const std::string path = station_stylus_path(kind.facts.id);
  return ::access(path.c_str(), F_OK) == 0 ? parse_station_stylus(read_text_file(path), path, kind)
                                           : usual_station_stylus(kind);
}

std::string to_toml(const StationStylus& s) {
  std::ostringstream out;
  out.precision(17);
  out << "# How a stylus of this station stands beside the tooth, by `cavum devices --place`.\nrotation = "
      << list(s.placement.rotation) << "\noffset_mm = [" << s.placement.offset_mm.x << ", "
      << s.placement.offset_mm.y << ", " << s.placement.offset_mm.z
      << "]\ntool = " << list(s.placement.tool) << "\n";
  for (const auto& [key, value] : s.settings) out << key << " = " << written(value) << "\n";
  return out.str();
}

}  // namespace cavum
