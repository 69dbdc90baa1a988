// What can be wrong with a file, or with a text that has the form of one, for whoever has to tell one from another.
#pragma once

#include <cstdint>

namespace cavum {

enum class FileError : std::uint8_t {
  missing,       ///< a file, or a member of it, that is not there
  not_a_file,    ///< a folder, a device, a pipe
  exists,        ///< nothing is written over it
  not_written,   ///< the file, or its folder
  too_large,     ///< beyond a limit
  truncated,     ///< ends before what it promises
  damaged,       ///< its checksum, or a count of it, does not fit
  malformed,     ///< not of its form at all
  wrong_type,    ///< a text where a number belongs
  out_of_range,  ///< a value
  unknown,       ///< a member that nobody asks for, a name of nothing
  duplicate,
  inconsistent,  ///< parts of it contradict one another
  unsupported,   ///< whole, and not read by us
};
inline constexpr std::uint32_t k_file_errors = static_cast<std::uint32_t>(FileError::unsupported) + 1;

}  // namespace cavum
