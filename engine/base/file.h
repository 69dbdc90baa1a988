// Whole files in, and out (write_file.h), with errors that say what to do; and where a station keeps its own.
#pragma once

#include <string>

#include "engine/base/bytes.h"
#include "engine/base/write_file.h"

namespace cavum {

/// Where this station keeps a file of its own: in $CAVUM_HOME, or in ~/.config/cavum. Throws Error when neither variable is set.
[[nodiscard]] std::string station_path(const std::string& name);
/// Throws Error when the file cannot be read.
[[nodiscard]] Bytes read_file(const std::string& path);
[[nodiscard]] std::string read_text_file(const std::string& path);

}  // namespace cavum
