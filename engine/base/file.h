// Whole files in and out, with errors that say what to do. Writing goes to a temporary file that is
// synced and renamed, so a full disk or a killed process never leaves half a file under the name.
#pragma once

#include <span>
#include <string>

#include "engine/base/bytes.h"

namespace cavum {

/// Where this station keeps a file of its own: in $CAVUM_HOME, or in ~/.config/cavum. Throws Error when neither variable is set.
[[nodiscard]] std::string station_path(const std::string& name);
/// Throws Error when the file cannot be read.
[[nodiscard]] Bytes read_file(const std::string& path);
[[nodiscard]] std::string read_text_file(const std::string& path);
/// Throws Error when no file can be put at `path`: it is a folder, a device, a pipe or a socket, or its own folder is missing or closed to us. For
/// asking before long work; the disk may still be full afterwards.
void require_writable(const std::string& path);
/// Replaces `path` as one step. Throws Error when it cannot be written, or is a device, a pipe or a socket; the old file then still stands.
void write_file(const std::string& path, std::span<const std::uint8_t> bytes);
void write_text_file(const std::string& path, const std::string& text);

}  // namespace cavum
