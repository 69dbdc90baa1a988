// Looks for anything in a session that is not as it was written: rows against their hashes, hashes
// against the chain, the seal against its signature. Needs no physics.
#pragma once

#include <string>
#include <vector>

#include "engine/session/session_reader.h"

namespace cavum {

/// Every disagreement in words, naming chunk, ticks or table; empty when all of it holds. What the
/// reader found (SessionReader::findings) is not repeated.
[[nodiscard]] Damages check_chain(const SessionReader& session);

}  // namespace cavum
