#include "scenarios/file/facing.h"

#include "engine/base/text.h"

namespace cavum::scenarios {

namespace {

const char* name_of_wall(std::size_t wall, Facing facing) {
  switch (static_cast<Wall>(wall)) {
    case Wall::mesial:
      return noop("the mesial wall");
    case Wall::distal:
      return noop("the distal wall");
    case Wall::buccal:
      if (facing.lateral())
        return facing.anterior ? noop("the incisal wall") : noop("the occlusal wall");
      return facing.anterior ? noop("the labial wall") : noop("the buccal wall");
    case Wall::lingual:
      return facing.lateral() ? noop("the gingival wall") : noop("the lingual wall");
    case Wall::floor:
      return facing.lateral() ? noop("the axial wall") : noop("the floor");
    case Wall::opening:
      break;
  }
  if (facing.lateral()) return noop("the opening");
  return facing.anterior ? noop("the incisal side") : noop("the occlusal side");
}

}  // namespace

Term wall_text(std::size_t wall, Facing facing) { return {name_of_wall(wall, facing)}; }

}  // namespace cavum::scenarios
