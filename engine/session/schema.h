// The tables of a session file. Comments stand inside the statements, so that `.schema` in any
// SQLite shell explains the file without this program.
#pragma once

#include <array>

namespace cavum {

/// CREATE statements, in order. A file whose schema reads otherwise is not as the recorder made it.
extern const std::array<const char*, 6> k_session_schema;

}  // namespace cavum
