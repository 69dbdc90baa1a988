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

/// What gives the input from now on, by key (motion_source.h, and what else is to be known of it); noted in the gap.
using SourceNotes = std::vector<std::pair<std::string, std::string>>;
/// A source as notes.
[[nodiscard]] SourceNotes to_notes(const MotionSource& source);

/// Throws Error when the file cannot be read, is closed, is damaged, replays differently, or is being recorded.
/// Logs a `gap` event: {"gap_utc_s", "gap_boot_s" (null after a reboot), "last_utc_ns", "resumed_utc_ns", "boot_id",
/// "station_key" of the station that goes on}, and "source", an object of `source` when that is not empty. On a full disk the gap is kept like a tick
/// that was refused (Recorder::append).
[[nodiscard]] ResumedSession resume_session(const std::string& path, const TickVisitor& visit = {}, const SourceNotes& source = {},
                                            const ReadClocks& clocks = read_clocks);

}  // namespace cavum
