// Names that come from a file or a person, made into names of files.
#pragma once

#include <string>
#include <string_view>

namespace cavum {

/// The name of one file in one folder, whatever `text` is: letters, digits, '-', '_' and '.' of
/// ASCII stay, all else becomes '_', and so does a '.' or
/// '-' at the beginning. It names no folder, no hidden file and no option, and is 1 to 120 bytes
/// long. Where anything was changed, eight digits of the text's SHA-256 follow: two texts never
/// share a file by accident.
[[nodiscard]] std::string file_name_of(std::string_view text);

}  // namespace cavum
