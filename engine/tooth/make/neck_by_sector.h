// Where a crown ends: its lowest enamel in each direction. A neck is no plane.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "engine/tooth/tissue_grid.h"

namespace cavum {

/// The lowest enamel in each of 72 directions from the enamel's middle: about the cemento-enamel
/// junction.
class NeckBySector {
 public:
  explicit NeckBySector(const TissueGrid& grid)
      : NeckBySector(grid, [&grid](std::size_t cell) { return grid.tissue[cell] == k_enamel; }) {}
  /// Of the enamel of which `counts(index of a cell)` is true.
  template <class Counts>
  NeckBySector(const TissueGrid& grid, const Counts& counts) {
    std::uint64_t count = 0;
    Vec3 sum;
    const auto each = [&](const auto& visit) {
      for (std::int32_t z = 0; z < grid.size.z; ++z)
        for (std::int32_t y = 0; y < grid.size.y; ++y)
          for (std::int32_t x = 0; x < grid.size.x; ++x)
            if (counts(grid.index({x, y, z}))) visit(IVec3{x, y, z});
    };
    each([&](IVec3 c) {
      sum += Vec3{double(c.x), double(c.y), 0};
      ++count;
    });
    if (count > 0) middle_ = sum / static_cast<double>(count);
    lowest_.fill(count > 0 ? grid.size.z
                           : std::numeric_limits<std::int32_t>::max() / 2);  // no enamel: no limit
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
    const double turn = ax + ay > 0 ? (ay <= ax ? 0.5 * ay / ax : 1 - 0.5 * ax / ay)
                                    : 0.0;  // 0 to 1 over a quarter
    const double quarter = x >= 0 ? (y >= 0 ? turn : 4 - turn) : (y >= 0 ? 2 - turn : 2 + turn);
    return std::min(k_sectors - 1, static_cast<std::size_t>(quarter / 4 * k_sectors));
  }
  Vec3 middle_;
  std::array<std::int32_t, k_sectors> lowest_{};
};

}  // namespace cavum
