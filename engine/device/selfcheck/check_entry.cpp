#include "engine/device/selfcheck/check_entry.h"

#include <array>
#include <span>

#include "engine/base/error.h"
#include "engine/base/hash.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_struct.h"

namespace cavum {
constexpr auto names_of(CheckEntry::Kind) { return std::array{"check", "decision", "new_history"}; }
std::array<const char*, 4> names_of(CheckOutcome) {
  return {outcome_name(CheckOutcome::learning), outcome_name(CheckOutcome::unchanged),
          outcome_name(CheckOutcome::changed), outcome_name(CheckOutcome::doubtful)};
}

// clang-format off
CAVUM_JSON_OF(CheckedStylus, (id), (serial))
CAVUM_JSON_OF(ArmAxis, (friction_n), (friction_error_n), (mass_kg), (mass_error), (weight_n))
void json_fields(auto& of, JsonOf<ArmFigures> auto& self) {
  of("axes", json_inside([&](auto& axes) { axes("x", self.axes[0]), axes("y", self.axes[1]), axes("z", self.axes[2]); }));
  double friction_n = self.friction_n();  // for whoever reads the file
  of("friction_n", friction_n);
  CAVUM_NAMES((quantum_mm), (rate_hz), (jitter_ms), (tick_mean_ms), (tick_p99_ms), (tick_worst_ms), (ticks_missed), (stale), (seconds), (dragged),
              (doubt, sparse))
}
CAVUM_JSON_OF(CheckChange, (quantity), (axis), (before), (now), (change), (uncertain))
CAVUM_JSON_OF(CheckVerdict, (outcome), (compared), (changes), (finds_friction_n), (finds_gain), (doubt, sparse))
void json_fields(auto& of, JsonOf<CheckEntry> auto& self) {
  CAVUM_NAMES((kind), (utc_ns), (station), (station_key), (stylus), (previous))
  if (self.kind == CheckEntry::Kind::check) {
    CAVUM_NAMES((figures), (verdict), (since_utc_ns))
  } else {
    CAVUM_NAMES((reason))
  }
  if (self.kind == CheckEntry::Kind::decision) {
    CAVUM_NAMES((go_on), (by))
  }
}
// clang-format on

namespace {

using Json = nlohmann::json;

std::string signed_text(Json j) {
  j.erase("signature");
  return "CVCHECK1" + j.dump();
}

}  // namespace

const char* kind_name(CheckEntry::Kind kind) noexcept {
  return names_of(kind)[static_cast<std::size_t>(kind)];
}

nlohmann::json to_signed_json(const CheckEntry& e, const SigningKey& key) {
  Json j = to_json_value(e);
  j["station_key"] = to_hex(key.public_key);
  const std::string text = signed_text(j);
  j["signature"] =
      to_hex(key.sign(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size())));
  return j;
}

CheckEntry read_check_entry(const nlohmann::json& j, const Where& where) {
  constexpr std::size_t k_max_changes = 16;
  Json said = j;
  if (said.is_object()) said.erase("signature");
  auto e = json_value_of<CheckEntry>(said, {.where = where,
                                            .advice = msg("use an intact copy"),
                                            .most_bytes = k_longest_check_reason,
                                            .most_elements = k_max_changes});
  const std::string text = signed_text(j);
  if (!is_signed_by(e.station_key,
                    std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()),
                    text_in(j, "signature")))
    throw Error(where, msg("does not have the signature of its station"),
                msg("somebody changed it; use an intact copy"));
  return e;
}

}  // namespace cavum
