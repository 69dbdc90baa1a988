#include "grading/ledger/stations.h"

#include <fmt/core.h>
#include <sodium.h>

#include <algorithm>

#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/text.h"
#include "engine/session/session.h"
#include "grading/ledger/ledger.h"
#include "grading/ledger/registry.h"

namespace cavum::ledger {
namespace {

using nlohmann::json;

constexpr char k_request_format[] = "cavum station request 1";
constexpr char k_code_alphabet[] = "0123456789ABCDEFGHJKMNPQRSTVWXYZ";  // Crockford's base 32
constexpr std::size_t k_code_digits = 20, k_most_devices = 8, k_longest_station_name = 80;
constexpr std::int64_t k_late_ns = 86'400'000'000'000;  // a station that ran out may hand in for a day

Bytes request_message(const json& facts) {
  const std::string text = "CVENROL1" + facts.dump();
  return {text.begin(), text.end()};
}

/// The key pair that a code stands for. What people add or mistype in writing it down (case, hyphens, O for 0, I and L for 1) does no harm.
SigningKey key_of_code(const std::string& code) {
  std::string digits;
  for (std::size_t i = code.starts_with("S-") || code.starts_with("s-") ? 2 : 0; i < code.size(); ++i) {
    char c = code[i];
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    if (c == '-' || c == ' ') continue;
    digits += c == 'O' ? '0' : c == 'I' || c == 'L' ? '1' : c;
  }
  if (digits.size() != k_code_digits || digits.find_first_not_of(k_code_alphabet) != std::string::npos)
    throw Error("station code", fmt::format("'{}' is none", one_line(code)),
                "type the code that `cavum ledger station … --invite` printed: S- and five groups of four");
  const Sha256 seed = sha256("CVCODE_1" + digits);
  SigningKey key;
  crypto_sign_seed_keypair(key.public_key.data(), key.secret_key.data(), seed.data());
  return key;
}

std::string request_of(const SigningKey& key, const std::string& school, const std::vector<MotionSource>& devices, const char* by,
                       const SigningKey& other) {
  json list = json::array();
  for (const auto& d : devices) list.push_back({{"name", d.name}, {"serial", d.serial}});
  const json facts = {{"format", k_request_format},           {"school", school},
                      {"public_key", to_hex(key.public_key)}, {"by", to_hex(other.public_key)},
                      {"made_utc_ns", read_clocks().utc_ns},  {"devices", list}};
  return json{{"request", facts}, {"signature", to_hex(key.sign(request_message(facts)))}, {by, to_hex(other.sign(request_message(facts)))}}.dump();
}

/// What a request says, when its signatures hold.
struct Request {
  std::string public_key, by, school;
  bool has_code = false;
  std::vector<MotionSource> devices;
};
Request parse_request(const json& j, const std::string& where) {
  const json& facts = member_of(j, "request");
  Request r{text_in(facts, "public_key"), text_in(facts, "by"), text_in(facts, "school"), member_of(j, "code_signature").is_string(), {}};
  if (text_in(facts, "format") != k_request_format) throw Error(where, "is no station's request", "name a file that `cavum station --enrol` wrote");
  if (!is_signed_by(r.public_key, request_message(facts), text_in(j, "signature")))
    throw Error(where, "the station's signature does not hold: the request was changed", "make it again on the station");
  if (!is_signed_by(r.by, request_message(facts), text_in(j, r.has_code ? "code_signature" : "old_signature")))
    throw Error(where, r.has_code ? "the code's signature does not hold" : "the signature of the key that is replaced does not hold",
                "make it again on the station");
  const json& devices = member_of(facts, "devices");
  if (!devices.is_array() || devices.size() > k_most_devices)
    throw Error(where, fmt::format("names no list of at most {} styluses", k_most_devices), "make it again on the station");
  for (const auto& d : devices) r.devices.push_back({"device", text_in(d, "name"), text_in(d, "serial")});
  return r;
}

Station* station_in(StationRegister& r, const std::string& key) {
  const auto found = std::find_if(r.stations.begin(), r.stations.end(), [&](const Station& s) { return s.public_key == key; });
  return found == r.stations.end() ? nullptr : &*found;
}

/// Whom the request makes a station, by code or in place of another. Throws Error when that cannot be.
Station enrolled(StationRegister& r, const Request& request, std::int64_t now_utc_ns, const std::string& where) {
  if (station_in(r, request.public_key) != nullptr) throw Error(where, "this key was enrolled before", "see `cavum ledger station`");
  Station s;
  s.public_key = request.public_key;
  s.enrolled_utc_ns = now_utc_ns;
  s.devices = request.devices;
  if (!request.has_code) {
    Station* old = station_in(r, request.by);
    if (old == nullptr || old->revoked_utc_ns || !old->replaced_by.empty())
      throw Error(where, "the key that it replaces is not, or no longer, enrolled", "invite the station anew");
    s.name = old->name;
    s.room = old->room;
    if (s.devices.empty()) s.devices = old->devices;
    old->replaced_by = s.public_key;
    old->revoked_utc_ns = now_utc_ns + k_late_ns;  // what was sat under it may still come in
    return s;
  }
  const auto code = std::find_if(r.invitations.begin(), r.invitations.end(), [&](const StationInvitation& i) { return i.code_key == request.by; });
  if (code == r.invitations.end())
    throw Error(where, "its code was not given out by this ledger", "invite the station with `cavum ledger station --invite`");
  if (code->used) throw Error(where, "its code was used before", "invite the station anew: each code is good once");
  if (now_utc_ns > code->until_utc_ns) throw Error(where, "its code ran out on " + utc_text(code->until_utc_ns), "invite the station anew");
  code->used = true;
  s.name = code->name;
  return s;
}

}  // namespace

const Station* StationRegister::of(const std::string& key) const {
  const auto found = std::find_if(stations.begin(), stations.end(), [&](const Station& s) { return s.public_key == key; });
  return found == stations.end() ? nullptr : &*found;
}

std::string StationRegister::problem(const std::string& key, std::int64_t closed_utc_ns, std::int64_t received_utc_ns) const {
  const Station* s = of(key);
  if (s == nullptr)
    return fmt::format("the station with the key {} is not enrolled: anybody can make such a recording", key.empty() ? "that is not named" : key);
  const std::string name = fmt::format("station '{}'", s->name);
  if (s->revoked_utc_ns && received_utc_ns > *s->revoked_utc_ns)
    return fmt::format("the key of {}{}{}", name, s->replaced_by.empty() ? " was revoked on " : " was replaced, and good until ",
                       utc_text(*s->revoked_utc_ns));
  if (s->until_utc_ns > 0 && (closed_utc_ns > s->until_utc_ns || received_utc_ns > s->until_utc_ns + k_late_ns))
    return fmt::format("the key of {} ran out on {}", name, utc_text(s->until_utc_ns));
  return {};
}

void apply_station_entry(StationRegister& r, const LedgerEntry& e, const std::string& school) {
  const std::string action = text_in(e.body, "action"), where = "station entry";
  if (action == "invite") {
    r.invitations.push_back(
        {e.seq, text_in(e.body, "name"), text_in(e.body, "code_key"), require_whole<std::int64_t>(e.body, "until_utc_ns", where)});
  } else if (action == "enrol") {
    const Request request = parse_request(member_of(e.body, "asked"), where);
    if (request.school != school) throw Error(where, "asks another school", "use an intact copy");
    Station s = enrolled(r, request, e.utc_ns, where);
    s.seq = e.seq;
    s.until_utc_ns = require_whole<std::int64_t>(e.body, "until_utc_ns", where);
    r.stations.push_back(std::move(s));
  } else if (action == "revoke") {
    Station* s = station_in(r, text_in(e.body, "public_key"));
    if (s == nullptr || (s->revoked_utc_ns && s->replaced_by.empty())) throw Error(where, "revokes a key that is not enrolled", "use an intact copy");
    s->revoked_utc_ns = e.utc_ns;
    s->replaced_by.clear();
  } else if (action == "room") {
    Station* s = station_in(r, text_in(e.body, "public_key"));
    if (s == nullptr) throw Error(where, "places a station that is not enrolled", "use an intact copy");
    s->room = text_in(e.body, "room");
  } else {
    throw Error(where, fmt::format("'{}' is nothing that happens to a station", one_line(action)), "use the version of Cavum that entered it");
  }
}

std::string new_station_code() {
  if (sodium_init() < 0) throw Error("libsodium", "does not start", "check the installation of libsodium");
  std::string code = "S";
  for (std::size_t i = 0; i < k_code_digits; ++i) {
    if (i % 4 == 0) code += '-';
    code += k_code_alphabet[randombytes_uniform(32)];
  }
  return code;
}

std::string station_request(const SigningKey& key, const std::string& school, const std::vector<MotionSource>& devices, const std::string& code) {
  return request_of(key, school, devices, "code_signature", key_of_code(code));
}

std::string station_request(const SigningKey& key, const std::string& school, const std::vector<MotionSource>& devices, const SigningKey& replaced) {
  return request_of(key, school, devices, "old_signature", replaced);
}

std::string invite_station(Ledger& ledger, const std::string& name, std::int64_t until_utc_ns) {
  if (name.size() > k_longest_station_name || !is_seen_text(name) || holds_unseen(name))
    throw Error("--invite", fmt::format("'{}' is no station's name", one_line(name.substr(0, k_longest_station_name))),
                fmt::format("give one line of at most {} bytes", k_longest_station_name));
  std::string code = new_station_code();
  const std::string code_key = to_hex(key_of_code(code).public_key);
  ledger.append("station", [&](const LedgerContent&) -> json {
    return {{"action", "invite"}, {"name", name}, {"code_key", code_key}, {"until_utc_ns", until_utc_ns}};
  });
  return code;
}

const LedgerEntry& enrol_station(Ledger& ledger, const std::string& text, std::int64_t until_utc_ns, const std::string& where) {
  const json asked = parse_json_or_null(text, k_json_part);
  return ledger.append("station", [&](const LedgerContent& now) -> json {
    const Request request = parse_request(asked, where);
    if (request.school != now.public_key)
      throw Error(where, "asks another school to be enrolled", "copy this school's school.pub to the station, and ask again");
    StationRegister stations = read_registry(now).stations;
    static_cast<void>(enrolled(stations, request, read_clocks().utc_ns, where));
    return {{"action", "enrol"}, {"asked", asked}, {"until_utc_ns", until_utc_ns}};
  });
}

const LedgerEntry& place_station(Ledger& ledger, const std::string& public_key, const std::string& room) {
  if (room.size() > k_longest_station_name || !is_plain_text(room))
    throw Error("the room", "is no line of text", fmt::format("give one line of at most {} bytes", k_longest_station_name));
  return ledger.append("station", [&](const LedgerContent&) -> json {
    const Station* s = ledger.registry().stations.of(public_key);
    if (s == nullptr || s->revoked_utc_ns) throw Error("station " + one_line(public_key), "is none that is enrolled", "choose one of the list");
    return {{"action", "room"}, {"public_key", public_key}, {"room", room}};
  });
}

const LedgerEntry& revoke_station(Ledger& ledger, const std::string& public_key, const std::string& reason) {
  return ledger.append("station", [&](const LedgerContent& now) -> json {
    StationRegister stations = read_registry(now).stations;
    const Station* s = stations.of(public_key);
    if (s == nullptr || (s->revoked_utc_ns && s->replaced_by.empty()))
      throw Error("--revoke " + one_line(public_key), "is not, or no longer, a station's key here", "see `cavum ledger station`");
    return {{"action", "revoke"}, {"public_key", public_key}, {"reason", one_line(reason)}};
  });
}

}  // namespace cavum::ledger
