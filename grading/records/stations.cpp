#include "grading/records/stations.h"

#include <sodium.h>

#include <algorithm>

#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/text.h"
#include "engine/session/session.h"
#include "grading/records/entry_text.h"
#include "grading/records/ledger.h"
#include "grading/records/ledger_error.h"
#include "grading/records/registry.h"

namespace cavum::records {
namespace {

using nlohmann::json;

constexpr char k_code_alphabet[] = "0123456789ABCDEFGHJKMNPQRSTVWXYZ";  // Crockford's base 32
constexpr std::size_t k_code_digits = 20, k_max_devices = 8, k_longest_station_name = 80;
constexpr std::int64_t k_late_ns =
    86'400'000'000'000;  // a station that ran out may hand in for a day

Bytes request_message(const StationRequest& request) {
  const std::string text = "CVENROL1" + json_of(request).dump();
  return {text.begin(), text.end()};
}

/// The key pair that a code stands for. What people add or mistype in writing it down (case,
/// hyphens, O for 0, I and L for 1) does no harm.
SigningKey key_of_code(const std::string& code) {
  std::string digits;
  for (std::size_t i = code.starts_with("S-") || code.starts_with("s-") ? 2 : 0; i < code.size();
       ++i) {
    char c = code[i];
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    if (c == '-' || c == ' ') continue;
    digits += c == 'O' ? '0' : c == 'I' || c == 'L' ? '1' : c;
  }
  if (digits.size() != k_code_digits ||
      digits.find_first_not_of(k_code_alphabet) != std::string::npos)
    throw Error(
        LedgerError::malformed, msg("station code"), msg("'{}' is none", one_line(code)),
        msg("type the code that `cavum ledger station … --invite` printed: S- and five groups of four"));
  const Sha256 seed = sha256("CVCODE_1" + digits);
  SigningKey key;
  crypto_sign_seed_keypair(key.public_key.data(), key.secret_key.data(), seed.data());
  return key;
}

SignedRequest request_of(const SigningKey& key, const std::string& school,
                         const std::vector<MotionSource>& devices, const SigningKey& other) {
  SignedRequest out{
      {school, to_hex(key.public_key), to_hex(other.public_key), read_clocks().utc_ns, {}},
      {},
      {},
      {}};
  for (const auto& d : devices) out.request.devices.push_back({d.name, d.serial});
  out.signature = to_hex(key.sign(request_message(out.request)));
  return out;
}

void require_signed(const SignedRequest& asked, const Where& where) {
  const StationRequest& r = asked.request;
  const bool has_code = !asked.code_signature.empty();
  if (!is_signed_by(r.public_key, request_message(r), asked.signature))
    throw Error(LedgerError::bad_signature, where,
                msg("the station's signature does not hold: the request was changed"),
                msg("make it again on the station"));
  if (!is_signed_by(r.by, request_message(r),
                    has_code ? asked.code_signature : asked.old_signature))
    throw Error(LedgerError::bad_signature, where,
                has_code ? msg("the code's signature does not hold")
                         : msg("the signature of the key that is replaced does not hold"),
                msg("make it again on the station"));
  if (r.devices.size() > k_max_devices)
    throw Error(where, msg("names no list of at most {} styluses", k_max_devices),
                msg("make it again on the station"));
}

Station* station_in(StationRegister& r, const std::string& key) {
  const auto found = std::find_if(r.stations.begin(), r.stations.end(),
                                  [&](const Station& s) { return s.public_key == key; });
  return found == r.stations.end() ? nullptr : &*found;
}

/// Whom the request makes a station, by code or in place of another. Throws Error when that cannot
/// be.
Station enrolled(StationRegister& r, const SignedRequest& asked, std::int64_t now_utc_ns,
                 const Where& where) {
  const StationRequest& request = asked.request;
  if (station_in(r, request.public_key) != nullptr)
    throw Error(LedgerError::twice, where, msg("this key was enrolled before"),
                msg("see `cavum ledger station`"));
  Station s;
  s.public_key = request.public_key;
  s.enrolled_utc_ns = now_utc_ns;
  for (const auto& d : request.devices) s.devices.push_back({SourceKind::device, d.name, d.serial});
  if (asked.code_signature.empty()) {
    Station* old = station_in(r, request.by);
    if (old == nullptr || old->revoked_utc_ns || !old->replaced_by.empty())
      throw Error(where, msg("the key that it replaces is not, or no longer, enrolled"),
                  msg("invite the station anew"));
    s.name = old->name;
    s.room = old->room;
    if (s.devices.empty()) s.devices = old->devices;
    old->replaced_by = s.public_key;
    old->revoked_utc_ns = now_utc_ns + k_late_ns;  // what was sat under it may still come in
    return s;
  }
  const auto code =
      std::find_if(r.invitations.begin(), r.invitations.end(),
                   [&](const StationInvitation& i) { return i.code_key == request.by; });
  if (code == r.invitations.end())
    throw Error(LedgerError::unknown, where, msg("its code was not given out by this ledger"),
                msg("invite the station with `cavum ledger station --invite`"));
  if (code->used)
    throw Error(LedgerError::used, where, msg("its code was used before"),
                msg("invite the station anew: each code is good once"));
  if (now_utc_ns > code->until_utc_ns)
    throw Error(LedgerError::ended, where,
                msg("its code ran out on {}", utc_text(code->until_utc_ns)),
                msg("invite the station anew"));
  code->used = true;
  s.name = code->name;
  return s;
}

}  // namespace

const Station* StationRegister::of(const std::string& key) const {
  const auto found = std::find_if(stations.begin(), stations.end(),
                                  [&](const Station& s) { return s.public_key == key; });
  return found == stations.end() ? nullptr : &*found;
}

std::optional<Finding> StationRegister::problem(const std::string& key, std::int64_t closed_utc_ns,
                                                std::int64_t received_utc_ns) const {
  const Station* s = of(key);
  if (key.empty()) return finding<FindingKind::station_unnamed>();
  if (s == nullptr) return finding<FindingKind::station_unknown>(key);
  if (s->revoked_utc_ns && received_utc_ns > *s->revoked_utc_ns)
    return s->replaced_by.empty()
               ? finding<FindingKind::station_revoked>(s->name, utc_text(*s->revoked_utc_ns))
               : finding<FindingKind::station_replaced>(s->name, utc_text(*s->revoked_utc_ns));
  if (s->until_utc_ns > 0 &&
      (closed_utc_ns > s->until_utc_ns || received_utc_ns > s->until_utc_ns + k_late_ns))
    return finding<FindingKind::station_run_out>(s->name, utc_text(s->until_utc_ns));
  return {};
}

void take_invite(StationRegister& r, const LedgerEntry& e, const InviteEntry& what) {
  r.invitations.push_back({e.seq, what.name, what.code_key, what.until_utc_ns});
}

void take_enrol(StationRegister& r, const LedgerEntry& e, const EnrolEntry& what,
                const std::string& school) {
  const Message where = msg("the entry of a station");
  require_signed(what.asked, where);
  if (what.asked.request.school != school)
    throw Error(where, msg("asks another school"), msg("use an intact copy"));
  Station s = enrolled(r, what.asked, e.utc_ns, where);
  s.seq = e.seq;
  s.until_utc_ns = what.until_utc_ns;
  r.stations.push_back(std::move(s));
}

void take_revoke(StationRegister& r, const LedgerEntry& e, const RevokeEntry& what) {
  Station* s = station_in(r, what.public_key);
  if (s == nullptr || (s->revoked_utc_ns && s->replaced_by.empty()))
    throw Error(msg("station entry"), msg("revokes a key that is not enrolled"),
                msg("use an intact copy"));
  s->revoked_utc_ns = e.utc_ns;
  s->replaced_by.clear();
}

void take_room(StationRegister& r, const RoomEntry& what) {
  Station* s = station_in(r, what.public_key);
  if (s == nullptr)
    throw Error(msg("station entry"), msg("places a station that is not enrolled"),
                msg("use an intact copy"));
  s->room = what.room;
}

std::string new_station_code() {
  if (sodium_init() < 0)
    throw Error(msg("libsodium"), msg("does not start"),
                msg("check the installation of libsodium"));
  std::string code = "S";
  for (std::size_t i = 0; i < k_code_digits; ++i) {
    if (i % 4 == 0) code += '-';
    code += k_code_alphabet[randombytes_uniform(32)];
  }
  return code;
}

std::string station_request(const SigningKey& key, const std::string& school,
                            const std::vector<MotionSource>& devices, const std::string& code) {
  const SigningKey by = key_of_code(code);
  SignedRequest asked = request_of(key, school, devices, by);
  asked.code_signature = to_hex(by.sign(request_message(asked.request)));
  return json_of(asked).dump();
}

std::string station_request(const SigningKey& key, const std::string& school,
                            const std::vector<MotionSource>& devices, const SigningKey& replaced) {
  SignedRequest asked = request_of(key, school, devices, replaced);
  asked.old_signature = to_hex(replaced.sign(request_message(asked.request)));
  return json_of(asked).dump();
}

std::string invite_station(Ledger& ledger, const std::string& name, std::int64_t until_utc_ns) {
  if (name.size() > k_longest_station_name || !is_seen_text(name) || holds_unseen(name))
    throw Error("--invite",
                msg("'{}' is no station's name", one_line(name.substr(0, k_longest_station_name))),
                msg("give one line of at most {} bytes", k_longest_station_name));
  std::string code = new_station_code();
  const std::string code_key = to_hex(key_of_code(code).public_key);
  ledger.append([&](const LedgerContent&) { return InviteEntry{name, code_key, until_utc_ns}; });
  return code;
}

const LedgerEntry& enrol_station(Ledger& ledger, const std::string& text, std::int64_t until_utc_ns,
                                 const Where& where) {
  const json j = parse_json_or_null(text, k_json_part);
  if (!member_of(j, "request").is_object())
    throw Error(where, msg("is no station's request"),
                msg("name a file that `cavum station --enrol` wrote"));
  const auto asked = value_in<SignedRequest>(j, where);
  require_signed(asked, where);
  return ledger.append([&](const LedgerContent& now) {
    if (asked.request.school != now.public_key)
      throw Error(LedgerError::another_key, where, msg("asks another school to be enrolled"),
                  msg("copy this school's school.pub to the station, and ask again"));
    StationRegister stations = ledger.registry().stations;
    static_cast<void>(enrolled(stations, asked, read_clocks().utc_ns, where));
    return EnrolEntry{asked, until_utc_ns};
  });
}

const LedgerEntry& place_station(Ledger& ledger, const std::string& public_key,
                                 const std::string& room) {
  if (room.size() > k_longest_station_name || !is_plain_text(room))
    throw Error(msg("the room"), msg("is no line of text"),
                msg("give one line of at most {} bytes", k_longest_station_name));
  return ledger.append([&](const LedgerContent&) {
    const Station* s = ledger.registry().stations.of(public_key);
    if (s == nullptr || s->revoked_utc_ns)
      throw Error(msg("station {}", one_line(public_key)), msg("is none that is enrolled"),
                  msg("choose one of the list"));
    return RoomEntry{public_key, room};
  });
}

const LedgerEntry& revoke_station(Ledger& ledger, const std::string& public_key,
                                  const std::string& reason) {
  return ledger.append(
      [&](const LedgerContent&) {
        const Station* s = ledger.registry().stations.of(public_key);
        if (s == nullptr || (s->revoked_utc_ns && s->replaced_by.empty()))
          throw Error("--revoke " + one_line(public_key),
                      msg("is not, or no longer, a station's key here"),
                      msg("see `cavum ledger station`"));
        return RevokeEntry{public_key};
      },
      one_line(reason));
}

}  // namespace cavum::records
