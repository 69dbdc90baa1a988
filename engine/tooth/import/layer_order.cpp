#include "engine/tooth/import/layer_order.h"

#include "engine/base/error.h"
#include "engine/tooth/tissue_grid.h"

namespace cavum {

std::array<std::uint64_t, 256> pulp_faces(IVec3 size, const std::vector<std::uint8_t>& tissue) {
  std::array<std::uint64_t, 256> faces{};
  const auto nx = static_cast<std::size_t>(size.x), nxy = nx * static_cast<std::size_t>(size.y);
  std::size_t i = 0;
  for (std::int32_t z = 0; z < size.z; ++z)
    for (std::int32_t y = 0; y < size.y; ++y)
      for (std::int32_t x = 0; x < size.x; ++x, ++i) {
        if (tissue[i] != k_pulp) continue;
        if (x > 0) ++faces[tissue[i - 1]];
        if (x + 1 < size.x) ++faces[tissue[i + 1]];
        if (y > 0) ++faces[tissue[i - nx]];
        if (y + 1 < size.y) ++faces[tissue[i + nx]];
        if (z > 0) ++faces[tissue[i - nxy]];
        if (z + 1 < size.z) ++faces[tissue[i + nxy]];
      }
  return faces;
}

void require_layer_order(const std::array<std::uint64_t, 256>& faces, const std::string& where, const std::string& what_to_do) {
  if (faces[k_enamel] > faces[k_dentin] && faces[k_enamel] >= faces[k_air])
    throw Error(where, "enamel and dentin look exchanged: the pulp lies in the enamel", what_to_do);
}

}  // namespace cavum
