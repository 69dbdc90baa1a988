#include "engine/tooth/make/periodontium.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/base/error.h"
#include "engine/tooth/distance.h"
#include "engine/tooth/distance_transform.h"

namespace cavum {
namespace {

constexpr double k_above_neck_mm = 1.0;  // a cleft in the enamel further up is the crown's, and holds no periodontium

/// The lowest enamel in each of 72 directions from the enamel's middle: about the cemento-enamel junction.
class NeckBySector {
 public:
  explicit NeckBySector(const TissueGrid& grid) {
    std::uint64_t count = 0;
    Vec3 sum;
    const auto each = [&](const auto& visit) {
      for (std::int32_t z = 0; z < grid.size.z; ++z)
        for (std::int32_t y = 0; y < grid.size.y; ++y)
          for (std::int32_t x = 0; x < grid.size.x; ++x)
            if (grid.tissue[grid.index({x, y, z})] == k_enamel) visit(IVec3{x, y, z});
    };
    each([&](IVec3 c) {
      sum += Vec3{double(c.x), double(c.y), 0};
      ++count;
    });
    if (count > 0) middle_ = sum / static_cast<double>(count);
    lowest_.fill(count > 0 ? grid.size.z : std::numeric_limits<std::int32_t>::max() / 2);  // no enamel: no limit
    each([&](IVec3 c) {
      std::int32_t& low = lowest_[sector(c)];
      low = std::min(low, c.z);
    });
  }
  [[nodiscard]] std::int32_t lowest_enamel(IVec3 cell) const { return lowest_[sector(cell)]; }

 private:
  static constexpr std::size_t k_sectors = 72;
  [[nodiscard]] std::size_t sector(IVec3 c) const {
    // by the slope in one of eight octants: no angle is needed
    const double x = c.x - middle_.x, y = c.y - middle_.y, ax = std::fabs(x), ay = std::fabs(y);
    const double turn = ax + ay > 0 ? (ay <= ax ? 0.5 * ay / ax : 1 - 0.5 * ax / ay) : 0.0;  // 0 to 1 over a quarter
    const double quarter = x >= 0 ? (y >= 0 ? turn : 4 - turn) : (y >= 0 ? 2 - turn : 2 + turn);
    return std::min(k_sectors - 1, static_cast<std::size_t>(quarter / 4 * k_sectors));
  }
  Vec3 middle_;
  std::array<std::int32_t, k_sectors> lowest_{};
};

/// The same tooth with `margin` more leaves of air on the sides and below (none above: roots only).
TissueGrid with_margin(const TissueGrid& grid, int margin) {
  TissueGrid wide;
  wide.allocate(grid.size + IVec3{2 * margin, 2 * margin, margin}, grid.leaf_mm, grid.origin_mm - Vec3{1, 1, 1} * (margin * grid.leaf_mm));
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
  if (!(thickness_mm >= 0 && thickness_mm <= 5)) throw Error("--periodontium-mm", "must lie between 0 and 5 mm", "give 1, or 0 for none");
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
  const double radius = thickness_mm / grid.leaf_mm + 0.5;  // a leaf's centre lies half a leaf inside the surface
  const int needed = static_cast<int>(radius) + 4;
  const int held = std::min({low.x, low.y, low.z, grid.size.x - 1 - high.x, grid.size.y - 1 - high.y});
  const int margin = std::max(0, needed - held);
  if (margin > 0) {
    check_lattice(grid.size + IVec3{2 * margin, 2 * margin, margin}, grid.leaf_mm, "periodontium");
    grid = with_margin(grid, margin);
  }
  const double below = enamel > 0 ? enamel_z / static_cast<double>(enamel) + margin : grid.size.z;
  const NeckBySector neck(grid);

  std::vector<std::uint8_t> hard(grid.count());
  for (std::size_t i = 0; i < hard.size(); ++i) hard[i] = grid.tissue[i] == k_enamel || grid.tissue[i] == k_dentin;
  const auto nearest = nearest_seed(grid.size, hard, radius);
  const double above_neck = k_above_neck_mm / grid.leaf_mm;
  std::uint64_t added = 0;
  for (std::int32_t z = 0; z < grid.size.z && z < below; ++z)
    for (std::int32_t y = 0; y < grid.size.y; ++y)
      for (std::int32_t x = 0; x < grid.size.x; ++x) {
        const auto i = grid.index({x, y, z});
        if (grid.tissue[i] != k_air || nearest[i] < 0 || z > neck.lowest_enamel({x, y, z}) + above_neck ||
            grid.tissue[static_cast<std::size_t>(nearest[i])] != k_dentin)
          continue;
        grid.tissue[i] = k_periodontium;
        ++added;
      }
  return added;
}

}  // namespace cavum
