// A session file as it stands, in memory. Reading must change nothing on disk, and a killed session
// has a write-ahead log beside it: so the bytes are copied, and the log is applied to the copy.
#pragma once

#include <string>

#include "engine/base/bytes.h"
#include "engine/session/damage.h"

namespace cavum {

/// The database file at `path` with its write-ahead log or journal applied. Works while a recorder
/// is writing. Throws Error when the file is missing, not a regular file, empty, not SQLite, or
/// above 2 GB. A log that cannot be applied is left out, and `findings` says so.
[[nodiscard]] Bytes read_session_image(const std::string& path, Damages& findings);

/// Throws Error(`name`, ...) unless the bytes begin as an SQLite file does.
void require_session_image(const Bytes& file, const std::string& name);

}  // namespace cavum
