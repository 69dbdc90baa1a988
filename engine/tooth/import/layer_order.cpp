#include "engine/tooth/import/layer_order.h"

#include <fmt/core.h>

#include <algorithm>

#include "engine/base/error.h"
#include "engine/tooth/make/neck_by_sector.h"

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

LayersApart layers_apart(const TissueGrid& grid) {
  constexpr double k_widest_mm = 3.0, k_seam_mm = 0.15;
  std::uint64_t apart = 0, together = 0;
  int widest = 0;
  const int most = static_cast<int>(k_widest_mm / grid.leaf_mm), seam = std::max(2, static_cast<int>(k_seam_mm / grid.leaf_mm));
  // along each axis: enamel and dentin one after the other, or with a void between them
  const auto walk = [&](int n, const auto& cell) {
    std::uint8_t before = k_air;  // last hard tissue
    int gap = 0;
    for (int i = 0; i < n; ++i) {
      const std::uint8_t t = cell(i);
      if (t == k_air) {
        ++gap;
        continue;
      }
      if ((t == k_enamel && before == k_dentin) || (t == k_dentin && before == k_enamel)) {
        together += gap <= seam;
        apart += gap > seam && gap <= most;
        if (gap > seam && gap <= most) widest = std::max(widest, gap);
      }
      before = t;
      gap = 0;
    }
  };
  const IVec3 n = grid.size;
  for (int z = 0; z < n.z; ++z)
    for (int y = 0; y < n.y; ++y) walk(n.x, [&](int x) { return grid.tissue[grid.index({x, y, z})]; });
  for (int z = 0; z < n.z; ++z)
    for (int x = 0; x < n.x; ++x) walk(n.y, [&](int y) { return grid.tissue[grid.index({x, y, z})]; });
  for (int y = 0; y < n.y; ++y)
    for (int x = 0; x < n.x; ++x) walk(n.z, [&](int z) { return grid.tissue[grid.index({x, y, z})]; });
  LayersApart found;
  if (apart + together > 0) found.share = static_cast<double>(apart) / static_cast<double>(apart + together);
  found.widest_mm = widest * grid.leaf_mm;
  return found;
}

OpenPulp open_pulp(const TissueGrid& grid) {
  constexpr double k_above_neck_mm = 0.5;
  const IVec3 n = grid.size;
  OpenPulp found;
  int lowest = n.z;
  for (int z = 0; z < n.z && lowest == n.z; ++z)
    for (int y = 0; y < n.y && lowest == n.z; ++y)
      for (int x = 0; x < n.x; ++x)
        if (grid.tissue[grid.index({x, y, z})] == k_enamel) {
          lowest = z;
          break;
        }
  std::uint64_t open = 0;
  for (int z = std::max(1, lowest + static_cast<int>(k_above_neck_mm / grid.leaf_mm)); z + 1 < n.z; ++z)
    for (int y = 1; y + 1 < n.y; ++y)
      for (int x = 1; x + 1 < n.x; ++x) {
        if (grid.tissue[grid.index({x, y, z})] != k_pulp) continue;
        for (const IVec3 step : {IVec3{1, 0, 0}, IVec3{-1, 0, 0}, IVec3{0, 1, 0}, IVec3{0, -1, 0}, IVec3{0, 0, 1}, IVec3{0, 0, -1}})
          if (grid.tissue[grid.index(IVec3{x, y, z} + step)] == k_air) {
            ++open;
            found.at_mm = grid.origin_mm + Vec3{x + 0.5, y + 0.5, z + 0.5} * grid.leaf_mm;
          }
      }
  found.mm2 = static_cast<double>(open) * grid.leaf_mm * grid.leaf_mm;
  return found;
}

BareDentin bare_dentin(const TissueGrid& grid) {
  constexpr double k_above_neck_mm = 1.0;
  const NeckBySector neck(grid);
  const auto above = static_cast<std::int32_t>(k_above_neck_mm / grid.leaf_mm);
  const IVec3 n = grid.size;
  std::vector<std::uint8_t> faces(grid.count());  // on air, of dentin that is bare and was not yet counted
  for (std::int32_t z = 1; z + 1 < n.z; ++z)
    for (std::int32_t y = 1; y + 1 < n.y; ++y)
      for (std::int32_t x = 1; x + 1 < n.x; ++x) {
        const IVec3 cell{x, y, z};
        if (grid.tissue[grid.index(cell)] != k_dentin || z <= neck.lowest_enamel(cell) + above) continue;
        for (const IVec3 step : {IVec3{1, 0, 0}, IVec3{-1, 0, 0}, IVec3{0, 1, 0}, IVec3{0, -1, 0}, IVec3{0, 0, 1}, IVec3{0, 0, -1}})
          if (grid.tissue[grid.index(cell + step)] == k_air) ++faces[grid.index(cell)];
      }
  BareDentin found;
  std::vector<IVec3> place;
  for (std::int32_t z = 1; z + 1 < n.z; ++z)
    for (std::int32_t y = 1; y + 1 < n.y; ++y)
      for (std::int32_t x = 1; x + 1 < n.x; ++x) {
        if (faces[grid.index({x, y, z})] == 0) continue;
        std::uint64_t count = 0;
        Vec3 sum;
        const auto take = [&](IVec3 cell) {
          std::uint8_t& f = faces[grid.index(cell)];
          if (f == 0) return;
          count += f;
          f = 0;
          sum += grid.centre_mm(cell);
          place.push_back(cell);
        };
        place.clear();
        take({x, y, z});
        for (std::size_t next = 0; next < place.size(); ++next)
          for (std::int32_t dz = -1; dz <= 1; ++dz)
            for (std::int32_t dy = -1; dy <= 1; ++dy)
              for (std::int32_t dx = -1; dx <= 1; ++dx) take(place[next] + IVec3{dx, dy, dz});
        const double mm2 = static_cast<double>(count) * grid.leaf_mm * grid.leaf_mm;
        found.mm2 += mm2;
        if (mm2 <= found.largest_mm2) continue;
        found.largest_mm2 = mm2;
        found.at_mm = sum / static_cast<double>(place.size());
      }
  return found;
}

void require_layers_that_fit(const LayersApart& apart, double overlap_share, const std::string& where) {
  constexpr double k_most_apart = 0.03, k_most_overlap = 0.1;  // eleven human teeth: at most 0.005 and 0.003
  constexpr const char* k_what_to_do =
      "check that all surfaces are of one tooth and in one frame, and that enamel is the enamel alone, not the whole crown";
  if (apart.share > k_most_apart)
    throw Error(where,
                fmt::format("enamel and dentin do not fit: at {:.0f} % of the places where they face each other there is a void between them, up to "
                            "{:.1f} mm wide",
                            100 * apart.share, apart.widest_mm),
                k_what_to_do);
  if (overlap_share > k_most_overlap)
    throw Error(where, fmt::format("enamel and dentin do not fit: {:.0f} % of the enamel lie in the dentin, too", 100 * overlap_share), k_what_to_do);
}

}  // namespace cavum
