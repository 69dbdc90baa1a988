// Memory set aside for the moment when there is no more: what is in the middle of something then
// comes to its end, and says so, instead of being torn out of it (a JSON value asks for memory even
// to be taken down). Nothing that counts is entered from then on.
#pragma once

#include <string>

#include "engine/base/named_enum.h"

namespace cavum {

#define CAVUM_MEMORY_ERRORS(ERROR) ERROR(ran_out)
CAVUM_NAMED_ENUM(MemoryError, CAVUM_MEMORY_ERRORS)

/// Sets 16 MB aside, which `new` takes when it finds nothing else; and again, once they were taken.
/// For programs and their longer works.
void keep_memory_reserve() noexcept;
/// True since the reserve was taken.
[[nodiscard]] bool memory_ran_out() noexcept;
/// Throws Error(MemoryError::ran_out, `where`, ...) when it was.
void require_memory(const std::string& where);

}  // namespace cavum
