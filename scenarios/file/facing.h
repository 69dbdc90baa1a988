// From which side a cavity is looked at and cut: from occlusal, or from the side of the tooth. What
// is "down", "floor" and "opening" follows from it.
#pragma once

#include "engine/base/message.h"
#include "engine/base/text.h"
#include "engine/base/vec.h"
#include "scenarios/file/wall.h"

namespace cavum::scenarios {

struct Facing {
  int side = 0;  ///< 0: from occlusal; +1: from buccal, -1: from lingual
  bool anterior =
      false;  ///< of an incisor or canine: people say labial and incisal for buccal and occlusal

  [[nodiscard]] constexpr bool lateral() const noexcept { return side != 0; }
  /// Of a way in the tooth frame: its parts along mesial, along buccal (from a side: along
  /// occlusal) and out of the tooth. From occlusal, as it is.
  [[nodiscard]] constexpr Vec3 local(Vec3 v) const noexcept {
    return lateral() ? Vec3{v.x, v.z, side * v.y} : v;
  }
  [[nodiscard]] constexpr IVec3 local(IVec3 v) const noexcept {
    return lateral() ? IVec3{v.x, v.z, side * v.y} : v;
  }
  /// The way back.
  [[nodiscard]] constexpr IVec3 in_tooth(IVec3 v) const noexcept {
    return lateral() ? IVec3{v.x, side * v.z, v.y} : v;
  }
  friend constexpr bool operator==(const Facing&, const Facing&) = default;
};

/// Name of a wall for people. From a side, the two walls that are called buccal and lingual in
/// measures and in the JSON are those towards occlusal and towards the gingiva.
[[nodiscard]] constexpr const char* wall_name(Wall wall, Facing facing) noexcept {
  if (facing.lateral() && wall == Wall::buccal)
    return facing.anterior ? noop("incisal") : noop("occlusal");
  if (facing.lateral() && wall == Wall::lingual) return noop("gingival");
  if (facing.anterior && wall == Wall::buccal) return noop("labial");
  return wall_name(wall);
}
/// "the buccal wall", "the floor"; of what is no wall, the opening.
[[nodiscard]] Term wall_text(std::size_t wall, Facing facing);

}  // namespace cavum::scenarios
