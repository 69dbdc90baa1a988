// Takes up an exam that was killed. The chain is checked, the recorded inputs are simulated again
// to reach the very state the candidate left, the gap is noted, and recording goes on in the same
// file.
#pragma once

#include <functional>
#include <string>
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

/// Throws Error when the file cannot be read, is closed, is damaged, replays differently, or is
/// being recorded. Notes a RecordingGap; on a full disk it is kept like a tick that was refused
/// (Recorder::append).
[[nodiscard]] ResumedSession resume_session(const std::string& path, const TickVisitor& visit = {},
                                            const ResumedBy& by = {},
                                            const ReadClocks& clocks = read_clocks);

}  // namespace cavum
