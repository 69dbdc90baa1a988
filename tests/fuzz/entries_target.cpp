// What a ledger's entries say, behind their hashes and the school's signature: any kinds with any
// bodies, a line each, after those of a sound ledger, and what is exported of them. A line is KIND
// and, after a space, JSON; of a station's request the signatures are put right.
#include <sstream>

#include "engine/base/json_reader.h"
#include "grading/records/entry_text.h"
#include "grading/records/exports.h"
#include "grading/records/registry.h"
#include "grading/records/release.h"
#include "grading/records/stations.h"
#include "tests/fuzz/material.h"
#include "tests/fuzz/targets.h"

namespace cavum::fuzz {
namespace {

using nlohmann::json;

/// The request under the signatures of a station that takes its own place.
void sign_request(json& asked) {
  if (!asked.is_object() || !asked.contains("request") || !asked["request"].is_object() ||
      !asked.contains("signature"))
    return;
  json& facts = asked["request"];
  facts["public_key"] = facts["by"] = to_hex(station_key().public_key);
  const Bytes message =
      bytes_of("CVENROL1" + facts.dump(-1, ' ', false, json::error_handler_t::replace));
  for (const char* name : {"signature", "code_signature", "old_signature"})
    if (asked.contains(name)) asked[name] = to_hex(station_key().sign(message));
}

}  // namespace

void fuzz_entries(Data data) {
  static records::Identities identities(work_folder() + "/entries-identities.db", true);
  records::LedgerContent content = school_ledger();
  std::istringstream lines(text_of(data));
  for (std::string line; std::getline(lines, line) && content.entries.size() < 40;) {
    const auto space = line.find(' ');
    if (space == std::string::npos) continue;
    json body = parse_json_or_null(line.substr(space + 1), k_json_part);
    if (!body.is_object()) continue;
    if (body.contains("asked")) sign_request(body["asked"]);
    const json opened = body.contains("opened") ? std::move(body["opened"]) : json();
    body.erase("opened");
    const std::string text = json{{"body", body},
                                  {"kind", line.substr(0, space)},
                                  {"seq", content.entries.size()},
                                  {"utc_ns", 1'800'000'000'000'000'000}}
                                 .dump(-1, ' ', false, json::error_handler_t::replace);
    try {
      records::LedgerEntry e = records::read_entry(text, "entry");
      for (const auto& [part, opening] : records::openings_of(*e.what)) opening->value = opened;
      static_cast<void>(records::entry_text(e));
      content.entries.push_back(std::move(e));
    } catch (const Error&) {
    }
  }
  try {
    const records::Registry registry = records::read_registry(content);
    int left_out = 0;
    static_cast<void>(records::moodle_csv(registry, identities, left_out, english_text, true));
    static_cast<void>(records::lti_scores(registry, identities, english_text, true)
                          .dump(-1, ' ', false, json::error_handler_t::replace));
    static_cast<void>(records::tidy_csv(registry));
  } catch (const Error&) {
  }
}

std::vector<Bytes> entries_seeds() {
  const std::string hash(64, 'a'), key = to_hex(station_key().public_key),
                                   school = to_hex(school_key().public_key);
  const json session{
      {"candidate", "C-7K3M-92PQ-XD4V"},
      {"chain_sha256", hash},
      {"file_sha256", hash},
      {"begun_utc_ns", 1},
      {"closed_utc_ns", 2},
      {"nonce", std::string(32, '2')},
      {"simulated", ""},
      {"findings",
       json::array({{{"kind", "ticket_artifact"}, {"values", {{"artifact", "rubric.toml"}}}}})},
      {"source", {{"kind", "device"}, {"name", "Omni"}, {"serial", "7"}}},
      {"opened", parse_json_or_null(small_result())},
      {"opens", {{"result", hash}}},
      {"grading_version", 3},
      {"physics_version", 4},
      {"scenario_id", "drill"},
      {"station_key", key},
      {"ticks", 30}};
  const std::string filed = "session " + session.dump() + "\n";
  const std::string regraded = "regrade " +
                               json{{"session", 2},
                                    {"by", json::object()},
                                    {"reason", "why"},
                                    {"opens", {{"result", hash}}},
                                    {"opened", parse_json_or_null(small_result())}}
                                   .dump() +
                               "\n";
  json ticket = parse_json_or_null(small_ticket());
  ticket.erase("grant");
  const auto release = [](std::uint64_t seq) {
    return "release " + json{{"results", {seq}}}.dump() + "\n";
  };
  const std::string invited =
      "invite " +
      json{{"name", "Seat 3"}, {"code_key", key}, {"until_utc_ns", 1'900'000'000'000'000'000}}
          .dump() +
      "\n";
  const auto asked = parse_json_or_null(records::station_request(
      station_key(), school, {{SourceKind::device, "Omni", "7"}}, records::new_station_code()));
  const std::string enrolled = "enrol " + json{{"asked", asked}, {"until_utc_ns", 0}}.dump() + "\n";
  const std::string revoked =
      "revoke " + json{{"public_key", key}, {"reason", "lost"}}.dump() + "\n";
  return {bytes_of("ticket " + ticket.dump() + "\n" + filed + release(3)),
          bytes_of(filed + regraded + release(2) + release(3)),
          bytes_of(invited + enrolled + revoked),
          bytes_of(filed + filed + release(2) +
                   "forget {\"candidate\":\"C\"}\nrestore {\"backup\":{\"root\":\"" + hash +
                   "\",\"size\":1},\"lost\":[],\"missing_sessions\":[]}\n")};
}

}  // namespace cavum::fuzz
