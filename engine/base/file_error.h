// What can be wrong with a file, or with a text that has the form of one, for whoever has to tell
// one from another.
#pragma once

#include <cstdint>

#include "engine/base/named_enum.h"

namespace cavum {

// clang-format off
#define CAVUM_FILE_ERRORS(ERROR) \
  ERROR(missing)      /* a file, or a member of it, that is not there */ \
  ERROR(not_a_file)   /* a folder, a device, a pipe */ \
  ERROR(exists)       /* nothing is written over it */ \
  ERROR(not_written)  /* the file, or its folder */ \
  ERROR(too_large)    /* beyond a limit */ \
  ERROR(truncated)    /* ends before what it promises */ \
  ERROR(damaged)      /* its checksum, or a count of it, does not fit */ \
  ERROR(malformed)    /* not of its form at all */ \
  ERROR(wrong_type)   /* a text where a number belongs */ \
  ERROR(out_of_range) /* a value */ \
  ERROR(unknown)      /* a member that nobody asks for, a name of nothing */ \
  ERROR(duplicate) \
  ERROR(inconsistent) /* parts of it contradict one another */ \
  ERROR(unsupported)  /* whole, and not read by us */
// clang-format on
CAVUM_NAMED_ENUM(FileError, CAVUM_FILE_ERRORS)
inline constexpr std::uint32_t k_file_errors =
    static_cast<std::uint32_t>(FileError::unsupported) + 1;

}  // namespace cavum
