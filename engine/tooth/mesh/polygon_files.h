// Surfaces as PLY, OBJ and OFF files hold them: corners and the polygons between them, nothing
// checked but that every polygon's corners are there. Memory stays in proportion to the file,
// whatever its head promises.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/base/vec.h"

namespace cavum {

struct Polygons {
  std::vector<Vec3> corners_mm;
  std::vector<std::vector<std::uint32_t>> polygons;  ///< three corners or more each, by number
};

/// Text, or binary of either byte order; colours, normals and other elements are passed over. These
/// throw Error(`name`, ...) on anything else.
[[nodiscard]] Polygons read_ply(const Bytes& file, const std::string& name);
/// `v` and `f` lines; numbers of corners from 1, or from the end when negative.
[[nodiscard]] Polygons read_obj(const Bytes& file, const std::string& name);
/// Text, with or without normals and colours.
[[nodiscard]] Polygons read_off(const Bytes& file, const std::string& name);

}  // namespace cavum
