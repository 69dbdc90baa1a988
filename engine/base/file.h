// Whole files in and out, with errors that say what to do. Writing goes to a temporary file that is
// synced and renamed, so a full disk or a killed process never leaves half a file under the name.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "engine/base/bytes.h"

namespace cavum {

/// Where this station keeps a file of its own: in $CAVUM_HOME, or in ~/.config/cavum. Throws Error when neither variable is set.
[[nodiscard]] std::string station_path(const std::string& name);
/// The largest files that are read unless the caller says otherwise, bytes.
inline constexpr std::uint64_t k_largest_file = 1U << 30;   ///< sessions, teeth, meshes: an hour's session has some 20 MB
inline constexpr std::uint64_t k_largest_text = 16U << 20;  ///< what people write, and exports
inline constexpr std::uint64_t k_largest_table = 1U << 30;  ///< motion and recordings, a row each tick
/// Throws Error when the file cannot be read, is no ordinary file (a device never ends, a pipe may never begin), or has more than `largest` bytes.
[[nodiscard]] Bytes read_file(const std::string& path, std::uint64_t largest = k_largest_file);
[[nodiscard]] std::string read_text_file(const std::string& path, std::uint64_t largest = k_largest_text);
/// Throws Error when no file can be put at `path`: it is a folder, a device, a pipe or a socket, or its own folder is missing or closed to us. For
/// asking before long work; the disk may still be full afterwards.
void require_writable(const std::string& path);
/// Replaces `path` as one step. Throws Error when it cannot be written, or is a device, a pipe or a socket; the old file then still stands.
void write_file(const std::string& path, std::span<const std::uint8_t> bytes);
void write_text_file(const std::string& path, const std::string& text);

}  // namespace cavum
