// A session's file as bytes: what SQLite makes of a damaged file, and what the reader makes of
// that. Cheap questions only, the motion is asked of recording_target.
#include "engine/session/chain_check.h"
#include "engine/session/clock_check.h"
#include "engine/session/session_reader.h"
#include "tests/fuzz/material.h"
#include "tests/fuzz/targets.h"

namespace cavum::fuzz {

void fuzz_session(Data data) {
  try {
    const SessionReader session(Bytes(data.begin(), data.end()), "session");
    static_cast<void>(check_chain(session));
    static_cast<void>(check_clocks(session));
    static_cast<void>(session.setup());
    read_all_ticks(session);
  } catch (const Error&) {
  }
}

std::vector<Bytes> session_seeds() {
  Bytes cut = small_session();
  cut.resize(cut.size() / 2);
  return {small_session(), cut};
}

}  // namespace cavum::fuzz
