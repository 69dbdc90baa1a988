#include "ui/station/picture_file.h"

#include <stb/stb_image_write.h>

#include "engine/base/bytes.h"
#include "engine/base/file.h"

namespace cavum::station {

void write_png(const std::string& path, int width, int height, std::span<const unsigned char> rgb) {
  Bytes png;
  const auto append = [](void* to, void* data, int size) {
    const auto* first = static_cast<const std::uint8_t*>(data);
    static_cast<Bytes*>(to)->insert(static_cast<Bytes*>(to)->end(), first, first + size);
  };
  const int row = width * 3;
  const unsigned char* top =
      rgb.data() + static_cast<std::ptrdiff_t>(row) *
                       (height - 1);  // rows upwards: a negative stride turns them round
  if (stbi_write_png_to_func(append, &png, width, height, 3, top, -row) == 0)
    throw Error(Name{path}, msg("cannot be made into a PNG picture"), msg("free some memory"));
  write_file(path, png);
}

}  // namespace cavum::station
