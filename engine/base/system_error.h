// Why the system refuses (errno): a kind that programs know, and a sentence for people.
#pragma once

#include "engine/base/error.h"

namespace cavum {

// clang-format off
#define CAVUM_SYSTEM_ERRORS(ERROR) \
  ERROR(system_error)    /* none of these */ \
  ERROR(no_permission) \
  ERROR(no_space) \
  ERROR(read_only) \
  ERROR(too_many_open) \
  ERROR(input_output) \
  ERROR(not_a_folder) \
  ERROR(name_too_long) \
  ERROR(no_memory)
// clang-format on
CAVUM_NAMED_ENUM(SystemError, CAVUM_SYSTEM_ERRORS)

/// Of an errno: one of these, or a FileError.
[[nodiscard]] ErrorCode system_code(int number) noexcept;
/// "there is no space left", "system error 71".
[[nodiscard]] Message system_words(int number);

}  // namespace cavum
