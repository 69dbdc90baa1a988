// What the session tests share: a small block of a tooth, a motion that drills it through to the
// pulp, and a private folder with a station key of its own.
#pragma once

#include <stdlib.h>

#include <string>

#include "engine/session/recorder.h"
#include "engine/session/simulation.h"
#include "tests/engine/support/basics.h"

namespace cavum::test {

using testing_basics::drawn_seed;

/// A folder that goes away with the test; CAVUM_HOME points into it.
struct Folder : testing_basics::Folder {
  Folder() { ::setenv("CAVUM_HOME", file("station").c_str(), 1); }
};

/// 2.2 x 2.2 x 2.0 mm, leaf 0.05 mm, top at z = 0: enamel 0.3, dentin 0.3, pulp 0.4, dentin 1.0 mm.
[[nodiscard]] Tooth block_tooth();
/// The block, round-1.0, the paper's force model with `tau_s` shortened so that seconds of test
/// drill through.
[[nodiscard]] SessionSetup block_setup();
/// Plunge, slide and withdraw, with tremor; the pedal is released now and then. A function of the
/// tick alone.
[[nodiscard]] TickInput motion_at(std::int64_t tick);

/// Simulates ticks first..first+ticks-1 of `motion_at` and records them.
void drill(Simulation& simulation, Recorder& recorder, std::int64_t first, std::int64_t ticks);
/// A closed session of `ticks` ticks with an event every 700 ticks. Returns the result's JSON.
std::string make_closed_session(const std::string& path, std::int64_t ticks);

/// Runs SQL on a file, as someone who tampers with it would.
void tamper(const std::string& path, const std::string& sql);

}  // namespace cavum::test
