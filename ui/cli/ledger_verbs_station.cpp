// `cavum ledger station`: whose recordings count.

#include "engine/base/file.h"
#include "grading/records/registry.h"
#include "grading/records/stations.h"
#include "grading/records/ticket.h"
#include "ui/cli/ledger_verbs_parts.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"

namespace cavum::ui {

using nlohmann::json;

namespace {

constexpr std::int64_t k_week_ns = 7 * 86'400'000'000'000;

/// In JSON, and for people.
std::pair<const char*, Message> state_of(const records::Station& s) {
  if (!s.replaced_by.empty())
    return {"replaced", msg("replaced by {}", s.replaced_by.substr(0, 16))};
  if (s.revoked_utc_ns) return {"revoked", msg("revoked on {}", utc_text(*s.revoked_utc_ns))};
  return {"enrolled",
          s.until_utc_ns > 0 ? msg("until {}", utc_text(s.until_utc_ns)) : msg("enrolled")};
}

void list_stations(const LedgerOptions& o) {
  const records::Ledger ledger(o.folder, key_of(o), records::LedgerUse::tell);
  const records::StationRegister stations = records::read_registry(ledger.content()).stations;
  json printed = json::array();
  for (const auto& s : stations.stations) {
    json devices = json::array();
    for (const auto& d : s.devices) devices.push_back({{"name", d.name}, {"serial", d.serial}});
    const auto [state, words] = state_of(s);
    printed.push_back({{"name", s.name},
                       {"public_key", s.public_key},
                       {"entry", s.seq},
                       {"state", state},
                       {"text", english_text(words)},
                       {"styluses", devices}});
    if (!o.as_json) say(msg("{}  {}, {}", s.public_key, s.name, words));
  }
  if (o.as_json)
    print_json(json{{"stations", printed}});
  else if (stations.stations.empty())
    say(msg("no station is enrolled: what is filed has a finding. Begin with --invite NAME"));
}

}  // namespace

void ledger_station(const LedgerOptions& o) {
  const std::int64_t until = o.until.empty() ? 0 : records::parse_utc(o.until, "--until");
  if (!o.invite.empty()) {
    records::Ledger ledger(o.folder, key_of(o));
    const std::int64_t good_until = until > 0 ? until : read_clocks().utc_ns + k_week_ns;
    const std::string code = records::invite_station(ledger, o.invite, good_until);
    if (o.as_json)
      return print_json(json{{"code", code}, {"name", o.invite}, {"until", utc_text(good_until)}});
    say(msg("{} for {}, good once until {}", code, o.invite, utc_text(good_until)));
    say(msg("on the station: cavum station --enrol {} --out request.json", code));
  } else if (!o.enrol.empty()) {
    records::Ledger ledger(o.folder, key_of(o));
    const auto seq = records::enrol_station(ledger, read_text_file(o.enrol), until, o.enrol).seq;
    const records::StationRegister stations = records::read_registry(ledger.content()).stations;
    const records::Station& s = stations.stations.back();
    if (o.as_json)
      print_json(json{{"entry", seq}, {"name", s.name}, {"public_key", s.public_key}});
    else
      say(msg("entry {}: station '{}', key {}", seq, s.name, s.public_key));
  } else if (!o.revoke.empty()) {
    records::Ledger ledger(o.folder, key_of(o));
    const auto seq =
        records::revoke_station(ledger, parse_public_key(o.revoke, "--revoke"), o.reason).seq;
    if (o.as_json)
      print_json(json{{"entry", seq}});
    else
      say(msg("entry {}: revoked", seq));
  } else {
    list_stations(o);
  }
}

}  // namespace cavum::ui
