#include "engine/device/hardware/inverse3_protocol.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/text.h"

namespace cavum {
namespace {

using nlohmann::json;

[[noreturn]] void refuse(const Message& what) {
  throw inverse3_error(
      DeviceError::malformed_message, msg("the service sent {}", what),
      msg("start the Haply Inverse Service again; docs/inverse3.md says what is expected of it"));
}

double number_in(const json& j, const char* key) {
  const json& m = member_of(j, key);
  if (!m.is_number()) refuse(msg("no number '{}'", key));
  return m.get<double>();
}

Vec3 vector_in(const json& j) { return {number_in(j, "x"), number_in(j, "y"), number_in(j, "z")}; }

std::optional<bool> truth_in(const json& j, const char* key) {
  const json& m = member_of(j, key);
  return m.is_boolean() ? std::optional(m.get<bool>()) : std::nullopt;
}

/// It is sent back inside our own text: nothing in it may need a quote.
std::string id_in(const json& j) {
  std::string id = text_in(j, "device_id");
  const auto is_plain = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' ||
           c == '_' || c == ':';
  };
  constexpr std::size_t k_longest = 64;
  if (id.empty() || id.size() > k_longest || !std::all_of(id.begin(), id.end(), is_plain))
    refuse(msg("a device without an id that can be used"));
  return id;
}

Inverse3Device device_of(const json& j) {
  Inverse3Device d{.id = id_in(j), .position_mm = {}, .calibrated = {}, .powered = {}};
  if (const json& place = member_of(member_of(j, "state"), "cursor_position"); !place.is_null()) {
    constexpr double k_mm_per_m = 1000.0, k_farthest_mm = 2000.0;
    d.position_mm = vector_in(place) * k_mm_per_m;
    if (!(length(*d.position_mm) <= k_farthest_mm)) refuse(msg("a place beyond all reach"));
  }
  d.calibrated = truth_in(member_of(j, "status"), "calibrated");
  d.powered = truth_in(member_of(j, "status"), "power_supply");
  return d;
}

Inverse3Grip grip_of(const json& j) {
  const json& state = member_of(j, "state");
  Inverse3Grip g{.id = id_in(j), .to_device = {}};
  if (const json& q = member_of(state, "orientation"); !q.is_null()) {
    const Quat turn{number_in(q, "w"), number_in(q, "x"), number_in(q, "y"), number_in(q, "z")};
    const double size2 = turn.w * turn.w + turn.x * turn.x + turn.y * turn.y + turn.z * turn.z;
    // all 0: it has not measured yet
    if (size2 > 0.5 && size2 < 2.0) g.to_device = normalized(turn);
  }
  const json& buttons = member_of(state, "buttons");
  g.button_1 = truth_in(buttons, "a").value_or(false) || truth_in(state, "button").value_or(false);
  g.button_2 = truth_in(buttons, "b").value_or(false);
  return g;
}

/// The list `key`; an absent one is empty.
const json& list_in(const json& message, const char* key) {
  static const json k_none = json::array();
  const json& list = member_of(message, key);
  if (list.is_null()) return k_none;
  if (!list.is_array()) refuse(msg("no list '{}'", key));
  return list;
}

}  // namespace

Error inverse3_error(DeviceError code, Message problem, Message advice) {
  return stylus_error("inverse3", code, std::move(problem), std::move(advice));
}

Inverse3Message parse_inverse3(std::string_view text) {
  constexpr JsonLimits k_limits{.bytes = k_inverse3_largest, .values = 8000, .depth = 12};
  json message;
  try {
    message = parse_json(text, "inverse3", k_limits);
  } catch (const Error& e) {
    refuse(msg("what is no message of it ({})", e.where_and_problem()));
  }
  if (!message.is_object()) refuse(msg("what is no message of it"));
  Inverse3Message m;
  m.names_session = message.contains("session_id");
  for (const json& device : list_in(message, "inverse3")) m.devices.push_back(device_of(device));
  for (const char* kind : {"wireless_verse_grip", "verse_grip"})
    for (const json& grip : list_in(message, kind)) m.grips.push_back(grip_of(grip));
  return m;
}

std::string inverse3_command(const std::string& id, Vec3 force_n, bool vector) {
  constexpr int k_digits = 4;
  return R"({"inverse3":[{"device_id":")" + id + R"(","commands":{"set_cursor_force":{")" +
         (vector ? "vector" : "values") + R"(":{"x":)" + fixed(force_n.x, k_digits) + R"(,"y":)" +
         fixed(force_n.y, k_digits) + R"(,"z":)" + fixed(force_n.z, k_digits) + "}}}}]}";
}

}  // namespace cavum
