#include "scenarios/file/facing.h"

#include "engine/base/text.h"

namespace cavum::scenarios {

namespace {

const char* name_of_wall(std::size_t wall, Facing facing) {
  switch (static_cast<Wall>(wall)) {
    case Wall::mesial:
      return said("the mesial wall");
    case Wall::distal:
      return said("the distal wall");
    case Wall::buccal:
      if (facing.lateral()) return facing.anterior ? said("the incisal wall") : said("the occlusal wall");
      return facing.anterior ? said("the labial wall") : said("the buccal wall");
    case Wall::lingual:
      return facing.lateral() ? said("the gingival wall") : said("the lingual wall");
    case Wall::floor:
      return facing.lateral() ? said("the axial wall") : said("the floor");
    case Wall::opening:
      break;
  }
  if (facing.lateral()) return said("the opening");
  return facing.anterior ? said("the incisal side") : said("the occlusal side");
}

}  // namespace

Term wall_text(std::size_t wall, Facing facing) { return {name_of_wall(wall, facing)}; }

}  // namespace cavum::scenarios
