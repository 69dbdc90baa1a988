#include "ui/station/tissue_colours.h"

namespace cavum::station {

glm::vec3 tissue_colour(std::string_view tissue, bool high_contrast) {
  const KnownTissue known = known_tissue(tissue);
  const auto& [red, green, blue] = high_contrast ? known.lit_strong : known.lit;
  return {red, green, blue};
}

}  // namespace cavum::station
