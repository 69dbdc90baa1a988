#include "scenarios/file/facing.h"

namespace cavum::scenarios {

Message wall_text(std::size_t wall, Facing facing) {
  switch (static_cast<Wall>(wall)) {
    case Wall::mesial:
      return msg("the mesial wall");
    case Wall::distal:
      return msg("the distal wall");
    case Wall::buccal:
      if (facing.lateral()) return facing.anterior ? msg("the incisal wall") : msg("the occlusal wall");
      return facing.anterior ? msg("the labial wall") : msg("the buccal wall");
    case Wall::lingual:
      return facing.lateral() ? msg("the gingival wall") : msg("the lingual wall");
    case Wall::floor:
      return facing.lateral() ? msg("the axial wall") : msg("the floor");
    case Wall::opening:
      break;
  }
  if (facing.lateral()) return msg("the opening");
  return facing.anterior ? msg("the incisal side") : msg("the occlusal side");
}

}  // namespace cavum::scenarios
