#include "engine/tooth/make/periodontium.h"

#include <algorithm>

#include "engine/base/error.h"
#include "engine/tooth/distance.h"
#include "engine/tooth/distance_transform.h"
#include "engine/tooth/make/neck_by_sector.h"

namespace cavum {
namespace {

constexpr double k_above_neck_mm =
    1.0;  // a cleft in the enamel further up is the crown's, and holds no periodontium

/// The same tooth with `margin` more leaves of air on the sides and below (none above: roots only).
TissueGrid with_margin(const TissueGrid& grid, int margin) {
  TissueGrid wide;
  wide.allocate(grid.size + IVec3{2 * margin, 2 * margin, margin}, grid.leaf_mm,
                grid.origin_mm - Vec3{1, 1, 1} * (margin * grid.leaf_mm));
  for (std::int32_t z = 0; z < grid.size.z; ++z)
    for (std::int32_t y = 0; y < grid.size.y; ++y) {
      const auto from = grid.index({0, y, z}), to = wide.index({margin, y + margin, z + margin});
      for (std::size_t x = 0; x < static_cast<std::size_t>(grid.size.x); ++x) {
        wide.tissue[to + x] = grid.tissue[from + x];
        wide.distance[to + x] = grid.distance[from + x];
      }
    }
  return wide;
}

}  // namespace

std::uint64_t add_periodontium(TissueGrid& grid, double thickness_mm) {
  if (!(thickness_mm >= 0 && thickness_mm <= 5))
    throw Error("--periodontium-mm", msg("must lie between 0 and 5 mm"),
                msg("give 1, or 0 for none"));
  // Air around dentin and enamel: how many leaves of it does the grid already hold?
  IVec3 low = grid.size, high{-1, -1, -1};
  std::uint64_t enamel = 0, dentin = 0;
  double enamel_z = 0.0;
  for (std::int32_t z = 0; z < grid.size.z; ++z)
    for (std::int32_t y = 0; y < grid.size.y; ++y)
      for (std::int32_t x = 0; x < grid.size.x; ++x) {
        const auto t = grid.tissue[grid.index({x, y, z})];
        if (t == k_enamel) {
          ++enamel;
          enamel_z += z;
        }
        if (t != k_dentin) continue;
        ++dentin;
        low = {std::min(low.x, x), std::min(low.y, y), std::min(low.z, z)};
        high = {std::max(high.x, x), std::max(high.y, y), std::max(high.z, z)};
      }
  if (dentin == 0 || thickness_mm == 0) return 0;
  const double radius =
      thickness_mm / grid.leaf_mm + 0.5;  // a leaf's centre lies half a leaf inside the surface
  const int needed = static_cast<int>(radius) + 4;
  const int held =
      std::min({low.x, low.y, low.z, grid.size.x - 1 - high.x, grid.size.y - 1 - high.y});
  const int margin = std::max(0, needed - held);
  if (margin > 0) {
    check_lattice(grid.size + IVec3{2 * margin, 2 * margin, margin}, grid.leaf_mm,
                  msg("periodontium"));
    grid = with_margin(grid, margin);
  }
  const double below = enamel > 0 ? enamel_z / static_cast<double>(enamel) + margin : grid.size.z;
  const NeckBySector neck(grid);

  std::vector<std::uint8_t> hard(grid.count());
  for (std::size_t i = 0; i < hard.size(); ++i)
    hard[i] = grid.tissue[i] == k_enamel || grid.tissue[i] == k_dentin;
  const auto nearest = nearest_seed(grid.size, hard, radius);
  const double above_neck = k_above_neck_mm / grid.leaf_mm;
  std::uint64_t added = 0;
  for (std::int32_t z = 0; z < grid.size.z && z < below; ++z)
    for (std::int32_t y = 0; y < grid.size.y; ++y)
      for (std::int32_t x = 0; x < grid.size.x; ++x) {
        const auto i = grid.index({x, y, z});
        if (grid.tissue[i] != k_air || nearest[i] < 0 ||
            z > neck.lowest_enamel({x, y, z}) + above_neck ||
            grid.tissue[static_cast<std::size_t>(nearest[i])] != k_dentin)
          continue;
        grid.tissue[i] = k_periodontium;
        ++added;
      }
  return added;
}

}  // namespace cavum
