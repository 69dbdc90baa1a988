#include "engine/selfcheck/check_entry.h"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>

#include "engine/base/error.h"
#include "engine/base/hash.h"
#include "engine/base/json_fields.h"
#include "engine/base/message_json.h"

namespace cavum {
namespace {

using Json = nlohmann::json;

constexpr std::array<const char*, 3> k_kinds{"check", "decision", "new_history"};
constexpr std::array<const char*, 3> k_axis_keys{"x", "y", "z"};
constexpr char k_use_intact[] = "use an intact copy";

std::string signed_text(Json j) {
  j.erase("signature");
  return "CVCHECK1" + j.dump();
}

double number_at(const Json& j, const char* key, const std::string& where) {
  const Json& m = member_of(j, key);
  if (!m.is_number() || !std::isfinite(m.get<double>())) throw Error(where, msg("'{}' is no number", key), msg(k_use_intact));
  return m.get<double>();
}

std::string text_at(const Json& j, const char* key, std::size_t longest, const std::string& where) {
  const Json& m = member_of(j, key);
  if (!m.is_string() || m.get_ref<const std::string&>().size() > longest)
    throw Error(where, msg("'{}' is no text of at most {} bytes", key, longest), msg(k_use_intact));
  return m.get<std::string>();
}

bool truth_at(const Json& j, const char* key, const std::string& where) {
  const Json& m = member_of(j, key);
  if (!m.is_boolean()) throw Error(where, msg("'{}' is neither true nor false", key), msg(k_use_intact));
  return m.get<bool>();
}

/// Each number of the figures by its name: writing and reading go through here, so that neither forgets one.
template <class Figures, class Visit>
void each_number(Figures& f, const Visit& visit) {
  visit("quantum_mm", f.quantum_mm);
  visit("rate_hz", f.rate_hz);
  visit("jitter_ms", f.jitter_ms);
  visit("tick_mean_ms", f.tick_mean_ms);
  visit("tick_p99_ms", f.tick_p99_ms);
  visit("tick_worst_ms", f.tick_worst_ms);
  visit("ticks_missed", f.ticks_missed);
  visit("stale", f.stale);
  visit("seconds", f.seconds);
}
template <class Axis, class Visit>
void each_axis_number(Axis& a, const Visit& visit) {
  visit("friction_n", a.friction_n);
  visit("friction_error_n", a.friction_error_n);
  visit("mass_kg", a.mass_kg);
  visit("mass_error", a.mass_error);
  visit("weight_n", a.weight_n);
}

Json doubt_json(const Message& doubt) { return doubt.empty() ? Json() : Json(encode(doubt)); }

Message read_doubt(const Json& j, const std::string& where) {
  const Json& doubt = member_of(j, "doubt");
  if (doubt.is_null()) return {};
  try {
    return decode_message(doubt);
  } catch (const std::invalid_argument& e) {
    throw Error(where, msg("'doubt' is no message: {}", e.what()), msg(k_use_intact));
  }
}

Json figures_json(const ArmFigures& f) {
  Json j = Json::object();
  each_number(f, [&j](const char* key, double value) { j[key] = value; });
  for (std::size_t i = 0; i < f.axes.size(); ++i)
    each_axis_number(f.axes[i], [&](const char* key, double value) { j["axes"][k_axis_keys[i]][key] = value; });
  j["friction_n"] = f.friction_n();
  j["dragged"] = f.dragged;
  j["doubt"] = doubt_json(f.doubt);
  return j;
}

constexpr std::size_t k_most_changes = 16;

ArmFigures read_figures(const Json& j, const std::string& where) {
  ArmFigures f;
  each_number(f, [&](const char* key, double& value) { value = number_at(j, key, where); });
  const Json& axes = member_of(j, "axes");
  for (std::size_t i = 0; i < f.axes.size(); ++i)
    each_axis_number(f.axes[i], [&](const char* key, double& value) { value = number_at(member_of(axes, k_axis_keys[i]), key, where); });
  f.dragged = truth_at(j, "dragged", where);
  f.doubt = read_doubt(j, where);
  return f;
}

Json verdict_json(const CheckVerdict& v) {
  Json changes = Json::array();
  for (const CheckChange& c : v.changes)
    changes.push_back(
        {{"quantity", c.quantity}, {"axis", c.axis}, {"before", c.before}, {"now", c.now}, {"change", c.change}, {"uncertain", c.uncertain}});
  return {{"outcome", outcome_name(v.outcome)},     {"compared", v.compared},     {"changes", changes},
          {"finds_friction_n", v.finds_friction_n}, {"finds_gain", v.finds_gain}, {"doubt", doubt_json(v.doubt)}};
}

CheckVerdict read_verdict(const Json& j, const std::string& where) {
  constexpr std::size_t k_longest_word = 40;
  CheckVerdict v;
  try {
    v.outcome = outcome_of(text_at(j, "outcome", k_longest_word, where));
  } catch (const std::invalid_argument&) {
    throw Error(where, msg("'outcome' is none that is known"), msg(k_use_intact));
  }
  v.compared = require_whole<std::size_t>(j, "compared", where);
  v.finds_friction_n = number_at(j, "finds_friction_n", where);
  v.finds_gain = number_at(j, "finds_gain", where);
  v.doubt = read_doubt(j, where);
  const Json& changes = member_of(j, "changes");
  if (!changes.is_array() || changes.size() > k_most_changes) throw Error(where, msg("'changes' is no list of changes"), msg(k_use_intact));
  for (const Json& c : changes)
    v.changes.push_back({text_at(c, "quantity", k_longest_word, where), text_at(c, "axis", 1, where), number_at(c, "before", where),
                         number_at(c, "now", where), number_at(c, "change", where), number_at(c, "uncertain", where)});
  return v;
}

}  // namespace

const char* kind_name(CheckEntry::Kind kind) noexcept { return k_kinds[static_cast<std::size_t>(kind)]; }

nlohmann::json to_signed_json(const CheckEntry& e, const SigningKey& key) {
  Json j{{"kind", kind_name(e.kind)},
         {"utc_ns", e.utc_ns},
         {"station", e.station},
         {"station_key", to_hex(key.public_key)},
         {"stylus", {{"id", e.stylus.id}, {"serial", e.stylus.serial}}},
         {"previous", e.previous}};
  if (e.kind == CheckEntry::Kind::check) {
    j["figures"] = figures_json(e.figures);
    j["verdict"] = verdict_json(e.verdict);
    j["since_utc_ns"] = e.since_utc_ns;
  } else {
    j["reason"] = e.reason;
    if (e.kind == CheckEntry::Kind::decision) {
      j["go_on"] = e.go_on;
      j["by"] = e.by;
    }
  }
  const std::string text = signed_text(j);
  j["signature"] = to_hex(key.sign(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size())));
  return j;
}

CheckEntry read_check_entry(const nlohmann::json& j, const std::string& where) {
  constexpr std::size_t k_longest_id = 200, k_hex_of_hash = 64, k_hex_of_signature = 128;
  CheckEntry e;
  const std::string kind = text_at(j, "kind", k_longest_id, where);
  std::size_t at = 0;
  while (at < k_kinds.size() && kind != k_kinds[at]) ++at;
  if (at == k_kinds.size()) throw Error(where, msg("is of a kind that is not known"), msg(k_use_intact));
  e.kind = static_cast<CheckEntry::Kind>(at);
  e.utc_ns = require_whole<std::int64_t>(j, "utc_ns", where);
  e.station = text_at(j, "station", k_longest_station_name, where);
  e.station_key = text_at(j, "station_key", k_hex_of_hash, where);
  e.stylus = {text_at(member_of(j, "stylus"), "id", k_longest_id, where), text_at(member_of(j, "stylus"), "serial", k_longest_id, where)};
  e.previous = text_at(j, "previous", k_hex_of_hash, where);
  if (e.kind == CheckEntry::Kind::check) {
    e.figures = read_figures(member_of(j, "figures"), where);
    e.verdict = read_verdict(member_of(j, "verdict"), where);
    e.since_utc_ns = require_whole<std::int64_t>(j, "since_utc_ns", where);
  } else {
    e.reason = text_at(j, "reason", k_longest_check_reason, where);
    if (e.kind == CheckEntry::Kind::decision) {
      e.go_on = truth_at(j, "go_on", where);
      e.by = text_at(j, "by", k_longest_id, where);
    }
  }
  const std::string text = signed_text(j), signature = text_at(j, "signature", k_hex_of_signature, where);
  if (!is_signed_by(e.station_key, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()), signature))
    throw Error(where, msg("does not have the signature of its station"), msg("somebody changed it; use an intact copy"));
  return e;
}

}  // namespace cavum
