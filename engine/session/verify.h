// Is a recording true? Checks the file, its chain and its signature, then simulates the whole exam
// again from the recorded inputs and compares every tick, every removed leaf, every second's state
// and the final tooth. Says in words what does not hold, and at which tick a replay first parts
// from the record.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/session/session_reader.h"
#include "engine/session/simulation.h"
#include "engine/tooth/known_fits.h"

namespace cavum {

/// Where the replay first differs from the record.
struct Divergence {
  std::int64_t tick = 0;
  std::string what;      ///< `model_force`, `proxy_x`, `removed_leaf`, `state_hash` …
  std::string recorded;  ///< with unit
  std::string replayed;
};

struct VerifyReport {
  std::string file;
  bool verified = false;  ///< closed, and everything holds
  bool closed = false;    ///< has a seal; without one the exam was interrupted and can be resumed
  bool intact = false;    ///< everything that is there holds, closed or not
  std::int64_t ticks = 0;
  std::int64_t ticks_replayed = 0;
  std::int64_t ticks_different = 0;
  std::optional<Divergence> first_divergence;
  Damages findings;  ///< empty when verified
  double speed_x_realtime =
      0;  ///< of the replay, decoding and comparing included; 0 when nothing was replayed
  std::string station_key;  ///< public key that signed, hexadecimal; empty when not closed
};

/// Teeth that somebody else has, or wants to have: unpacking one takes as long as simulating a
/// third of a minute.
struct VerifyTeeth {
  const Tooth* start = nullptr;      ///< the session's own, as it was read already; else it is read
  const PackedFits* like = nullptr;  ///< of that, as far as reading it found some
  Tooth* final_out = nullptr;        ///< receives the final tooth as the session keeps it, when the
                                     ///< replay came to its end
};

/// Throws Error only when the file cannot be read as a session at all; damage is in the report.
/// With `expected_station_key` (hexadecimal) a session closed by any other station is not verified:
/// whoever can simulate can also forge a whole new session, but not sign it with a key that is not
/// theirs.
[[nodiscard]] VerifyReport verify_session(const std::string& path,
                                          const std::string& expected_station_key = "");
/// The same of a session that was read already; `visit` sees each tick as it is simulated.
[[nodiscard]] VerifyReport verify_session(const SessionReader& session,
                                          const std::string& expected_station_key = "",
                                          const TickVisitor& visit = {},
                                          const VerifyTeeth& teeth = {});

}  // namespace cavum
