// Takes up an exam that was killed. The chain is checked, the recorded inputs are simulated again to reach
// the very state the candidate left, the gap is noted, and recording goes on in the same file.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "engine/session/recorder.h"
#include "engine/session/session_reader.h"
#include "engine/session/simulation.h"

namespace cavum {

struct ResumedSession {
  Recorder recorder;
  Simulation simulation;
  SessionSetup setup;
  std::int64_t ticks = 0;  ///< already recorded: the number of the next tick
};

/// Called for every recorded tick while it is simulated again, so that a scenario can catch up.
/// `state.removed` holds the leaves removed in the tick.
using TickVisitor = std::function<void(std::int64_t tick, const TickInput& input, const TickOutput& output, const ServoState& state)>;

/// What gives the input from now on, by key (device, motion_file, operator …); noted in the gap.
using SourceNotes = std::vector<std::pair<std::string, std::string>>;

/// Throws Error when the file cannot be read, is closed, is damaged, replays differently, or is being recorded.
/// Logs a `gap` event: {"gap_utc_s", "gap_boot_s" (null after a reboot), "last_utc_ns", "resumed_utc_ns", "boot_id",
/// "station_key" of the station that goes on}, and "source", an object of `source` when that is not empty. On a full disk the gap is kept like a tick
/// that was refused (Recorder::append).
[[nodiscard]] ResumedSession resume_session(const std::string& path, const TickVisitor& visit = {}, const SourceNotes& source = {});

}  // namespace cavum
