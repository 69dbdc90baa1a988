#include "engine/session/chain_check.h"

#include <algorithm>
#include <cstdlib>

#include "engine/base/text.h"
#include "engine/physics/servo/servo.h"
#include "engine/session/chain.h"
#include "engine/session/station_key.h"

namespace cavum {
namespace {

using enum DamageKind;

/// Gathers the events of every chunk; one that belongs to none is a finding.
std::vector<std::vector<EventRow>> events_by_chunk(const SessionReader& session,
                                                   Damages& findings) {
  std::vector<std::vector<EventRow>> by_chunk(session.chunks().size());
  for (const auto& e : session.event_rows()) {
    if (e.chunk >= 0 && e.chunk < static_cast<std::int64_t>(by_chunk.size()))
      by_chunk[static_cast<std::size_t>(e.chunk)].push_back(e);
    else
      findings.push_back(damage<event_stray>(e.seq, e.tick));
  }
  return by_chunk;
}

void check_artifacts(const SessionReader& session, Damages& findings) {
  for (const auto& a : session.artifacts())
    if (sha256(a.bytes) != a.sha256) findings.push_back(damage<artifact_changed>(a.name));
  for (const char* name :
       {"scenario.toml", "start_tooth.cvt", "bur_000.toml", "force_model.toml", "servo.toml"})
    if (session.artifact(name) == nullptr) findings.push_back(damage<artifact_missing>(name));
}

/// Facts that say what a file of the recording says, too: neither may say otherwise.
void check_facts(const SessionReader& session, Damages& findings) {
  if (session.fact("format") != std::to_string(k_session_format))
    findings.push_back(damage<format_other>(session.fact("format"), k_session_format));
  for (const char* key : {"physics_version", "first_tip_x_nm", "first_tip_y_nm", "first_tip_z_nm",
                          "created_utc_ns", "created_boot_ns", "created_monotonic_ns"})
    if (const std::string fact = session.fact(key);
        !fact.empty() && fact != std::to_string(session.number(key, 0)))
      findings.push_back(damage<fact_malformed>(key, fact));
  for (const char* key : {"first_tip_x_nm", "first_tip_y_nm", "first_tip_z_nm"})
    if (const auto nm = session.number(key, 0); nm != static_cast<std::int32_t>(nm))
      findings.push_back(damage<fact_outside>(key));
  const auto* servo = session.artifact("servo.toml");
  if (servo == nullptr) return;
  try {
    const double tick_s =
        parse_servo_config({servo->bytes.begin(), servo->bytes.end()}, "servo.toml").tick_s;
    if (std::strtod(session.fact("tick_s").c_str(), nullptr) != tick_s)
      findings.push_back(damage<tick_other>(session.fact("tick_s"), as_s(tick_s, k_as_needed)));
  } catch (const Error& e) {
    findings.push_back(damage<artifact_unreadable>(e.where_and_problem()));
  }
}

void check_chunks(const SessionReader& session, Damages& findings) {
  Sha256 before = genesis_hash(session.meta(), session.artifacts());
  const auto events = events_by_chunk(session, findings);
  for (std::size_t i = 0; i < session.chunks().size(); ++i) {
    const ChunkRow& c = session.chunks()[i];
    const std::int64_t last_tick = c.first_tick + std::max<std::int64_t>(c.ticks - 1, 0);
    const auto part = [&]<DamageKind kind>(bool same) {
      if (!same) findings.push_back(damage<kind>(c.seq, c.first_tick, last_tick));
      return same;
    };
    if (c.prev_sha256 != before && i == 0) findings.push_back(damage<beginning_changed>());
    if (i > 0) part.operator()<chunk_order>(c.prev_sha256 == before);
    const bool same_inputs = part.operator()<chunk_inputs>(sha256(c.inputs) == c.inputs_sha256);
    const bool same_records = part.operator()<chunk_records>(sha256(c.records) == c.records_sha256);
    const bool same_removed = part.operator()<chunk_removed>(sha256(c.removed) == c.removed_sha256);
    const bool same_events =
        part.operator()<chunk_events>(events_hash(events[i]) == c.events_sha256);
    const bool same_parts = same_inputs && same_records && same_removed && same_events,
               linked = chunk_hash(c) == c.sha256;
    same_parts ? part.operator()<chunk_facts>(linked) : part.operator()<chunk_link>(linked);
    before = c.sha256;
  }
}

/// The station's signature on the beginning.
void check_beginning(const SessionReader& session, Damages& findings) {
  if (!is_signed_by(session.fact(k_station_fact),
                    begin_message(session.meta(), session.artifacts()), session.fact(k_begun_fact)))
    findings.push_back(damage<beginning_signature>());
}

void check_seal(const SessionReader& session, Damages& findings) {
  const bool has_result = !session.result_json().empty(),
             has_tooth = session.artifact(k_final_tooth) != nullptr;
  if (!session.seal()) {
    if (has_result || has_tooth) findings.push_back(damage<seal_missing>());
    return;
  }
  const Seal& seal = *session.seal();
  const auto require = [&](bool holds, const Damage& else_found) {
    if (!holds) findings.push_back(else_found);
  };
  const std::size_t chunks = session.chunks().size(), events = session.event_rows().size();
  const Sha256 end = session.chunks().empty() ? genesis_hash(session.meta(), session.artifacts())
                                              : session.chunks().back().sha256;
  require(is_signed_by(seal.public_key, seal_message(seal), seal.signature),
          damage<seal_signature>());
  require(seal.chain_sha256 == end, damage<seal_chain>());
  require(seal.chunks == static_cast<std::int64_t>(chunks),
          damage<chunk_count>(chunks, seal.chunks));
  require(seal.ticks == session.ticks(), damage<tick_count>(session.ticks(), seal.ticks));
  require(seal.events == static_cast<std::int64_t>(events),
          damage<event_count>(events, seal.events));
  require(has_result && sha256(session.result_json()) == seal.result_sha256,
          damage<result_changed>());
  require(has_tooth && sha256(session.final_tooth()) == seal.final_tooth_sha256,
          damage<final_tooth_changed>());
}

}  // namespace

Damages check_chain(const SessionReader& session) {
  Damages findings;
  check_artifacts(session, findings);
  check_facts(session, findings);
  check_beginning(session, findings);
  check_chunks(session, findings);
  check_seal(session, findings);
  return findings;
}

}  // namespace cavum
