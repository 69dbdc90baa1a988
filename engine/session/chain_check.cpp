#include "engine/session/chain_check.h"

#include <algorithm>
#include <cstdlib>

#include "engine/base/text.h"
#include "engine/physics/servo/servo.h"
#include "engine/session/chain.h"
#include "engine/session/station_key.h"

namespace cavum {
namespace {

/// Gathers the events of every chunk; one that belongs to none is a finding.
std::vector<std::vector<EventRow>> events_by_chunk(const SessionReader& session, Damages& findings) {
  std::vector<std::vector<EventRow>> by_chunk(session.chunks().size());
  for (const auto& e : session.event_rows()) {
    if (e.chunk >= 0 && e.chunk < static_cast<std::int64_t>(by_chunk.size()))
      by_chunk[static_cast<std::size_t>(e.chunk)].push_back(e);
    else
      findings.push_back({DamageKind::event, msg("table event, row {} (tick {}): belongs to no chunk", e.seq, e.tick)});
  }
  return by_chunk;
}

Message name_of(const ChunkRow& c) {
  if (c.ticks == 0) return msg("chunk {} (events at tick {})", c.seq, c.first_tick);
  return msg("chunk {} (ticks {} to {})", c.seq, c.first_tick, c.first_tick + c.ticks - 1);
}

void check_artifacts(const SessionReader& session, Damages& findings) {
  for (const auto& a : session.artifacts())
    if (sha256(a.bytes) != a.sha256)
      findings.push_back({DamageKind::artifact, msg("table artifact: '{}' was changed after it was recorded", a.name)});
  for (const char* name : {"scenario.toml", "start_tooth.cvt", "bur_000.toml", "force_model.toml", "servo.toml"})
    if (session.artifact(name) == nullptr) findings.push_back({DamageKind::artifact, msg("table artifact: '{}' is missing", name)});
}

/// Facts that say what a file of the recording says, too: neither may say otherwise.
void check_facts(const SessionReader& session, Damages& findings) {
  if (session.fact("format") != std::to_string(k_session_format))
    findings.push_back(
        {DamageKind::meta, msg("table meta: the format is said to be '{}', and this is format {}", session.fact("format"), k_session_format)});
  for (const char* key :
       {"physics_version", "first_tip_x_nm", "first_tip_y_nm", "first_tip_z_nm", "created_utc_ns", "created_boot_ns", "created_monotonic_ns"})
    if (const std::string fact = session.fact(key); !fact.empty() && fact != std::to_string(session.number(key, 0)))
      findings.push_back({DamageKind::meta, msg("table meta: {} is '{}', which is no whole number in its range", key, fact)});
  for (const char* key : {"first_tip_x_nm", "first_tip_y_nm", "first_tip_z_nm"})
    if (const auto nm = session.number(key, 0); nm != static_cast<std::int32_t>(nm))
      findings.push_back({DamageKind::meta, msg("table meta: {} lies outside every tooth", key)});
  const auto* servo = session.artifact("servo.toml");
  if (servo == nullptr) return;
  try {
    const double tick_s = parse_servo_config({servo->bytes.begin(), servo->bytes.end()}, "servo.toml").tick_s;
    if (std::strtod(session.fact("tick_s").c_str(), nullptr) != tick_s)
      findings.push_back({DamageKind::meta, msg("table meta: a tick is said to last '{}' s, and by servo.toml it lasts {}", session.fact("tick_s"),
                                                as_s(tick_s, k_as_needed))});
  } catch (const Error& e) {
    findings.push_back({DamageKind::artifact, e.where_and_problem()});
  }
}

void check_chunks(const SessionReader& session, Damages& findings) {
  Sha256 before = genesis_hash(session.meta(), session.artifacts());
  const auto events = events_by_chunk(session, findings);
  for (std::size_t i = 0; i < session.chunks().size(); ++i) {
    const ChunkRow& c = session.chunks()[i];
    const auto say = [&](const Message& what) { findings.push_back({DamageKind::chunk, msg("{}: {}", name_of(c), what)}); };
    if (c.prev_sha256 != before) {
      if (i == 0)
        findings.push_back(
            {DamageKind::meta, msg("table meta or artifact: not what the chain of this session began with (a fact, a file or a hash was changed)")});
      else
        say(msg("does not follow the chunk before it (one of them was changed, moved or replaced)"));
    }
    const auto part = [&](bool same, const Message& what) {
      if (!same) say(what);
      return same;
    };
    const bool same_inputs = part(sha256(c.inputs) == c.inputs_sha256, msg("its motion (inputs) was changed after recording"));
    const bool same_records = part(sha256(c.records) == c.records_sha256, msg("its forces (records) were changed after recording"));
    const bool same_removed = part(sha256(c.removed) == c.removed_sha256, msg("its removed leaves were changed after recording"));
    const bool same_events = part(events_hash(events[i]) == c.events_sha256, msg("its events were changed after recording"));
    const bool same_parts = same_inputs && same_records && same_removed && same_events;
    if (chunk_hash(c) != c.sha256)
      say(same_parts ? msg("its clocks, tick numbers, state hash or part hashes were changed after recording")
                     : msg("its link in the chain does not hold"));
    before = c.sha256;
  }
}

/// The station's signature on the beginning.
void check_beginning(const SessionReader& session, Damages& findings) {
  if (!is_signed_by(session.fact(k_station_fact), begin_message(session.meta(), session.artifacts()), session.fact(k_begun_fact)))
    findings.push_back(
        {DamageKind::meta,
         msg("table meta: the signature of the station that began the session does not hold (a fact, a file or the key was changed)")});
}

void check_seal(const SessionReader& session, Damages& findings) {
  const bool has_result = !session.result_json().empty(), has_tooth = session.artifact(k_final_tooth) != nullptr;
  if (!session.seal()) {
    if (has_result || has_tooth) findings.push_back({DamageKind::seal, msg("table seal: missing, though the session has a result or a final tooth")});
    return;
  }
  const Seal& seal = *session.seal();
  const auto say = [&](bool holds, DamageKind kind, const Message& what) {
    if (!holds) findings.push_back({kind, what});
  };
  const Sha256 end = session.chunks().empty() ? genesis_hash(session.meta(), session.artifacts()) : session.chunks().back().sha256;
  say(is_signed_by(seal.public_key, seal_message(seal), seal.signature), DamageKind::seal,
      msg("table seal: the signature does not hold (hash, count, clock or key was changed)"));
  say(seal.chain_sha256 == end, DamageKind::seal, msg("table seal: the chain does not end where the session was closed"));
  say(seal.chunks == static_cast<std::int64_t>(session.chunks().size()), DamageKind::chunk,
      msg("table chunk: {} chunks, closed with {}", session.chunks().size(), seal.chunks));
  say(seal.ticks == session.ticks(), DamageKind::chunk, msg("table chunk: {} ticks, closed with {}", session.ticks(), seal.ticks));
  say(seal.events == static_cast<std::int64_t>(session.event_rows().size()), DamageKind::event,
      msg("table event: {} events, closed with {}", session.event_rows().size(), seal.events));
  say(has_result && sha256(session.result_json()) == seal.result_sha256, DamageKind::result,
      msg("table result: the result was changed or removed after closing"));
  say(has_tooth && sha256(session.final_tooth()) == seal.final_tooth_sha256, DamageKind::artifact,
      msg("table artifact: the final tooth was changed or removed after closing"));
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
