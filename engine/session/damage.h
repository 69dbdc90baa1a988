// What is found of a recording, and does not hold or must be known: in its file, its chain and its
// motion, in the exam that marking simulates again, and in what stations and clocks say. One table
// has all kinds.
#pragma once

#include <utility>
#include <vector>

#include "engine/base/fact_table.h"

namespace cavum {

// DAMAGE(kind, group, English sentence, names of its values); `why` is what an error said
// clang-format off
#define CAVUM_DAMAGES(DAMAGE) \
  /* its file */ \
  DAMAGE(recording_unsound, recording_unsound, "{}", "why") \
  DAMAGE(log_left_out, recording_unsound, "file: the log beside it cannot be applied, and was left out: {}", "why") \
  DAMAGE(database_damaged, recording_unsound, "file: {}", "why") \
  DAMAGE(user_version, recording_unsound, "file: user_version is {}, this program reads format {}", "user_version", "format") \
  DAMAGE(application_id, recording_unsound, "file: application_id is not Cavum's", ) \
  DAMAGE(row_unreadable, recording_unsound, "table {}, row {}: {}", "table", "row", "why") \
  DAMAGE(nothing_in_it, recording_unsound, "table meta: empty", ) \
  /* facts, files, events */ \
  DAMAGE(format_other, recording_unsound, "table meta: the format is said to be '{}', and this is format {}", "stated", "format") \
  DAMAGE(fact_malformed, recording_unsound, "table meta: {} is '{}', which is no whole number in its range", "fact", "stated") \
  DAMAGE(fact_outside, recording_unsound, "table meta: {} lies outside every tooth", "fact") \
  DAMAGE(tick_other, recording_unsound, "table meta: a tick is said to last '{}' s, and by servo.toml it lasts {}", "stated", "tick_s") \
  DAMAGE(beginning_signature, recording_unsound, "table meta: the signature of the station that began the session does not hold (a fact, a file or the key was changed)", ) \
  DAMAGE(beginning_changed, recording_unsound, "table meta or artifact: not what the chain of this session began with (a fact, a file or a hash was changed)", ) \
  DAMAGE(artifact_changed, recording_unsound, "table artifact: '{}' was changed after it was recorded", "artifact") \
  DAMAGE(artifact_missing, recording_unsound, "table artifact: '{}' is missing", "artifact") \
  DAMAGE(artifact_size, recording_unsound, "table artifact, '{}': its size was changed", "artifact") \
  DAMAGE(artifact_unreadable, recording_unsound, "table artifact: {}", "why") \
  DAMAGE(event_unreadable, recording_unsound, "{}", "why") \
  DAMAGE(event_stray, recording_unsound, "table event, row {} (tick {}): belongs to no chunk", "row", "tick") \
  /* chunks */ \
  DAMAGE(chunk_order, recording_unsound, "chunk {} (ticks {} to {}): does not follow the chunk before it (one of them was changed, moved or replaced)", "chunk", "tick", "last_tick") \
  DAMAGE(chunk_inputs, recording_unsound, "chunk {} (ticks {} to {}): its motion (inputs) was changed after recording", "chunk", "tick", "last_tick") \
  DAMAGE(chunk_records, recording_unsound, "chunk {} (ticks {} to {}): its forces (records) were changed after recording", "chunk", "tick", "last_tick") \
  DAMAGE(chunk_removed, recording_unsound, "chunk {} (ticks {} to {}): its removed leaves were changed after recording", "chunk", "tick", "last_tick") \
  DAMAGE(chunk_events, recording_unsound, "chunk {} (ticks {} to {}): its events were changed after recording", "chunk", "tick", "last_tick") \
  DAMAGE(chunk_facts, recording_unsound, "chunk {} (ticks {} to {}): its clocks, tick numbers, state hash or part hashes were changed after recording", "chunk", "tick", "last_tick") \
  DAMAGE(chunk_link, recording_unsound, "chunk {} (ticks {} to {}): its link in the chain does not hold", "chunk", "tick", "last_tick") \
  /* its end */ \
  DAMAGE(not_closed, not_closed, "table seal: none, the session was never closed; ticks recorded: {}", "ticks") \
  DAMAGE(seal_missing, recording_unsound, "table seal: missing, though the session has a result or a final tooth", ) \
  DAMAGE(seal_signature, recording_unsound, "table seal: the signature does not hold (hash, count, clock or key was changed)", ) \
  DAMAGE(seal_chain, recording_unsound, "table seal: the chain does not end where the session was closed", ) \
  DAMAGE(seal_station, recording_unsound, "table seal: closed by station {}, not by the one expected", "station") \
  DAMAGE(chunk_count, recording_unsound, "table chunk: chunks: {}, when it was closed: {}", "chunks", "closed_with") \
  DAMAGE(tick_count, recording_unsound, "table chunk: ticks: {}, when it was closed: {}", "ticks", "closed_with") \
  DAMAGE(event_count, recording_unsound, "table event: events: {}, when it was closed: {}", "events", "closed_with") \
  DAMAGE(result_changed, recording_unsound, "table result: the result was changed or removed after closing", ) \
  DAMAGE(final_tooth_changed, recording_unsound, "table artifact: the final tooth was changed or removed after closing", ) \
  /* its motion, simulated again */ \
  DAMAGE(other_physics, recording_unsound, "table meta: recorded under physics {}, this program has {}: chain and signature were checked, the motion cannot be replayed", "physics", "own_physics") \
  DAMAGE(not_replayed, recording_unsound, "{} (not replayed)", "why") \
  DAMAGE(replay_stopped, recording_unsound, "{} (replay stops here)", "why") \
  DAMAGE(too_much_removed, recording_unsound, "more than {} leaves are said to be removed, and no tooth has as many (replay stops here)", "most") \
  DAMAGE(ticks_differ, recording_unsound, "tick {}: {} recorded {}, replayed {}; {} of {} ticks differ", "tick", "what", "recorded", "replayed", "different", "ticks_replayed") \
  DAMAGE(state_differs, recording_unsound, "chunk {}: state hash after tick {} differs from the replay", "chunk", "tick") \
  DAMAGE(final_tooth_unreadable, recording_unsound, "{}", "why") \
  DAMAGE(final_tooth_differs, recording_unsound, "table artifact: the final tooth is not the one that the replay leaves", ) \
  /* its exam, simulated and marked again */ \
  DAMAGE(scenario_unreadable, exam_differs, "scenario: {}", "why") \
  DAMAGE(exam_differs, exam_differs, "{}", "why") \
  DAMAGE(ended_before_end, exam_differs, "events: the exam is said to have been ended at tick {}, and it was recorded on to tick {}", "tick", "ticks") \
  DAMAGE(event_differs, exam_differs, "event {} of the exam: recorded {}, the motion gives {}", "event", "recorded", "given") \
  DAMAGE(not_markable, exam_differs, "cannot be marked: {}", "why") \
  DAMAGE(result_differs, result_differs, "the sealed result, by grading version {}, is not what this program's version {} gives: it was tampered with, or its station's program was, or is another one. Sealed {}", "grading_version", "own_version", "differences") \
  /* its stations */ \
  DAMAGE(station_changed, station_changed, "the exam was ended by another station than began it: ended by {}, begun by {}", "station", "begun_by") \
  DAMAGE(resumed_elsewhere, station_changed, "the exam was taken up again at tick {} by another station than began it: {}, begun by {}", "tick", "station", "begun_by") \
  DAMAGE(resumed_unremembered, station_changed, "the exam was taken up again at tick {} at a station that did not remember beginning it: its memory of used tickets was removed", "tick") \
  /* its clocks */ \
  DAMAGE(clock, clock, "clocks, from tick {}: the computer's own clock ran backwards", "tick") \
  DAMAGE(clock_slept, clock, "clocks, from tick {}: the computer slept for {}", "tick", "slept_s") \
  DAMAGE(clock_set_forward, clock, "clocks, from tick {}: the wall clock was set forward by {}", "tick", "by_s") \
  DAMAGE(clock_put_back, clock, "clocks, from tick {}: the wall clock was set back by {}", "tick", "by_s") \
  DAMAGE(clock_slow, clock, "clocks, from tick {}: {} of the exam took {}: the candidate had more time than the exam's clock shows", "tick", "exam_s", "took_s") \
  DAMAGE(clock_fast, clock, "clocks, from tick {}: the exam is {} ahead of the station's clock: recorded faster than real time, no hand moved it", "tick", "ahead_s") \
  DAMAGE(clock_lost, clock, "clocks, from tick {}: {} passed that the recording does not account for: its program stood still, or its clocks were changed", "tick", "lost_s") \
  DAMAGE(interrupted, clock, "clocks, from tick {}: interrupted for {} and taken up again", "tick", "away_s") \
  DAMAGE(interrupted_source, clock, "clocks, from tick {}: interrupted for {} and taken up again with {}", "tick", "away_s", "source")
// clang-format on

CAVUM_FACTS(DamageKind, CAVUM_DAMAGES)

using Damage = TableFact<DamageKind>;
using Damages = std::vector<Damage>;
/// A damage of this kind: the compiler counts its values.
template <DamageKind kind, class... A>
[[nodiscard]] Damage damage(A&&... values) {
  return fact_of<kind>(std::forward<A>(values)...);
}
[[nodiscard]] std::vector<Message> words_of(const Damages& damages);

/// For other programs: {"kind", "group", "values", "text"}.
void to_json(nlohmann::json& json, const Damage& damage);

}  // namespace cavum
