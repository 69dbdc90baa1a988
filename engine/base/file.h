// Whole files in, and out (write_file.h), with errors that say what to do; and where a station
// keeps its own.
#pragma once

#include <cstdint>
#include <string>

#include "engine/base/bytes.h"
#include "engine/base/write_file.h"

namespace cavum {

/// Where this station keeps a file of its own: in $CAVUM_HOME, or in ~/.config/cavum. Throws Error
/// when neither variable is set.
[[nodiscard]] std::string station_path(const std::string& name);
/// The largest files that are read unless the caller says otherwise, bytes.
inline constexpr std::uint64_t k_largest_file =
    1U << 30;  ///< sessions, teeth, meshes: an hour's session has some 20 MB
inline constexpr std::uint64_t k_largest_text = 16U << 20;  ///< what people write, and exports
inline constexpr std::uint64_t k_largest_table = 1U
                                                 << 30;  ///< motion and recordings, a row each tick
/// Throws Error when the file cannot be read, is no ordinary file (a device never ends, a pipe may
/// never begin), or has more than `largest` bytes.
[[nodiscard]] Bytes read_file(const std::string& path, std::uint64_t largest = k_largest_file);
[[nodiscard]] std::string read_text_file(const std::string& path,
                                         std::uint64_t largest = k_largest_text);

}  // namespace cavum
