#include "grading/records/ticket.h"

#include <algorithm>
#include <cstdio>

#include "engine/base/error.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "grading/records/entry_text.h"
#include "grading/records/ledger_error.h"
#include "grading/records/ledger_key.h"
#include "grading/records/opening.h"

namespace cavum::records {
namespace {

using nlohmann::json;

Bytes message_of(const Ticket& t) {
  const std::string text = "CVTICKET" + json_of(t).dump();
  return {text.begin(), text.end()};
}

/// Days from 1970-01-01, proleptic Gregorian; `month` 1..12.
std::int64_t days_since_1970(std::int64_t year, int month, int day) {
  year -= month <= 2 ? 1 : 0;
  const std::int64_t era = year / 400, of_era = year - era * 400;
  const std::int64_t of_year = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  return era * 146097 + of_era * 365 + of_era / 4 - of_era / 100 + of_year - 719468;
}

}  // namespace

std::map<std::string, std::string> examined_artifacts(const SessionSetup& setup) {
  std::map<std::string, std::string> out;
  for (const auto& a : artifacts_of(setup))
    if (a.name != "servo.toml" && a.name != k_final_tooth) out[a.name] = to_hex(sha256(a.bytes));
  return out;
}

std::vector<std::pair<std::string, std::string>> accommodations_in(const SessionSetup& setup) {
  std::vector<std::pair<std::string, std::string>> out;
  for (const auto& note : setup.notes)
    if (note.first.starts_with("accommodation.")) out.push_back(note);
  std::sort(out.begin(), out.end());
  return out;
}

SignedTicket sign_ticket(Ticket t, const SigningKey& school) {
  json grant = json::object();
  for (const auto& [key, value] : t.grant) grant[key] = value;
  const Opening opening = make_opening(grant);
  t.grant_sha256 = opening.sha256;
  t.grant.clear();
  SignedTicket out{std::move(t), {}, {}};
  out.signature = to_hex(school.sign(message_of(out.ticket)));
  out.text =
      json{{"grant", opening.text}, {"signature", out.signature}, {"ticket", json_of(out.ticket)}}
          .dump();
  return out;
}

void require_signed(const Ticket& t, const std::string& signature, const std::string& public_key,
                    const Where& where) {
  if (!public_key.empty() && t.public_key != public_key)
    throw Error(where, msg("is the ticket of another school"), msg("ask for one of this school"));
  if (!is_signed_by(fixed_from_hex<32>(t.public_key, msg("{}: {}", where, "public_key")),
                    message_of(t),
                    fixed_from_hex<64>(signature, msg("{}: {}", where, "signature"))))
    throw Error(LedgerError::bad_signature, where, msg("was changed after the school signed it"),
                msg("ask for a new ticket"));
}

Ticket parse_ticket(const std::string& text, const std::string& public_key, const Where& where) {
  const json j = parse_json_or_null(text);
  if (!member_of(j, "ticket").is_object())
    throw Error(where, msg("is no ticket"), msg("name a file that `cavum ledger ticket` wrote"));
  auto t = value_in<Ticket>(j["ticket"], where);
  const json granted =
      opened_value(text_in(j, "grant"), t.grant_sha256, msg("{}: {}", where, "grant"));
  if (!granted.is_object())
    throw Error(where, msg("grants nothing that can be read"), msg("ask for a new ticket"));
  for (const auto& [key, value] : granted.items())
    t.grant.emplace_back(key, text_in(granted, key.c_str()));
  std::sort(t.grant.begin(), t.grant.end());
  require_signed(t, text_in(j, "signature"), public_key, where);
  return t;
}

Findings check_ticket(const Ticket& t, const SessionSetup& setup, std::int64_t begun_utc_ns) {
  Findings findings;
  if (setup.candidate != t.candidate)
    findings.push_back(finding<FindingKind::ticket_candidate>(t.candidate, setup.candidate));
  const auto examined = examined_artifacts(setup);
  for (const auto& [name, hash] : t.artifacts) {
    const auto found = examined.find(name);
    if (found == examined.end())
      findings.push_back(finding<FindingKind::ticket_artifact_missing>(name));
    else if (found->second != hash)
      findings.push_back(finding<FindingKind::ticket_artifact>(name));
  }
  for (const auto& [name, hash] : examined)
    if (!t.artifacts.contains(name))
      findings.push_back(finding<FindingKind::ticket_artifact_added>(name));
  if (accommodations_in(setup) != t.grant)
    findings.push_back(finding<FindingKind::ticket_accommodations>());
  if (begun_utc_ns < t.not_before_utc_ns || begun_utc_ns > t.not_after_utc_ns)
    findings.push_back(finding<FindingKind::ticket_time>(
        utc_text(begun_utc_ns), utc_text(t.not_before_utc_ns), utc_text(t.not_after_utc_ns)));
  return findings;
}

std::int64_t parse_utc(const std::string& text, const Where& where) {
  int year = 0, month = 0, day = 0, hour = 0, minute = 0, second = 0, used = 0;
  const char* c = text.c_str();
  const auto whole = [&] { return used == static_cast<int>(text.size()); };
  const bool read = (std::sscanf(c, "%4d-%2d-%2dT%2d:%2d:%2dZ%n", &year, &month, &day, &hour,
                                 &minute, &second, &used) == 6 &&
                     whole()) ||
                    (second = 0, std::sscanf(c, "%4d-%2d-%2dT%2d:%2dZ%n", &year, &month, &day,
                                             &hour, &minute, &used) == 5 &&
                                     whole());
  static constexpr int k_days[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  const bool leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
  if (!read || year < 1970 || year > 2200 || month < 1 || month > 12 || day < 1 ||
      day > k_days[month - 1] + (month == 2 && leap ? 1 : 0) || hour < 0 || hour > 23 ||
      minute < 0 || minute > 59 || second < 0 || second > 59)
    throw Error(where, msg("'{}' is no time", text), msg("write it in UTC as 2026-11-21T09:00Z"));
  return (((days_since_1970(year, month, day) * 24 + hour) * 60 + minute) * 60 + second) *
         1'000'000'000;
}

}  // namespace cavum::records
