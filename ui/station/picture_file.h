// Pictures of the screen as PNG files.
#pragma once

#include <span>
#include <string>

namespace cavum::station {

/// `rgb`: three bytes a pixel, the lowest row first as OpenGL gives it. Throws Error when the file
/// cannot be written.
void write_png(const std::string& path, int width, int height, std::span<const unsigned char> rgb);

}  // namespace cavum::station
