// Places on a surface in blocks of space: which is nearest is found without looking at those that
// cannot be.
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "engine/base/vec.h"

namespace cavum::grading {

class SiteBlocks {
 public:
  /// `leaf` says in which block a place is put.
  void add(IVec3 leaf, Vec3 place_mm) {
    Block& b = blocks_[{leaf.x / k_edge, leaf.y / k_edge, leaf.z / k_edge}];
    b.places.push_back(place_mm);
    b.box.add(place_mm);
  }
  [[nodiscard]] bool empty() const noexcept { return blocks_.empty(); }
  /// Puts the nearest place that is nearer than `nearest_mm` into both; false when none is. Of
  /// equals the first in an order that is the same everywhere.
  bool nearer(Vec3 from_mm, double& nearest_mm, Vec3& place_mm) const {
    bool found = false;
    for (const auto& [at, block] : blocks_) {
      if (block.at_least_mm(from_mm) >= nearest_mm) continue;
      for (const Vec3 p : block.places)
        if (const double d = length(p - from_mm); d < nearest_mm) {
          nearest_mm = d;
          place_mm = p;
          found = true;
        }
    }
    return found;
  }

 private:
  static constexpr int k_edge = 16;
  struct Block {
    std::vector<Vec3> places;
    Bounds box;
    /// No place in it is nearer.
    [[nodiscard]] double at_least_mm(Vec3 p) const {
      const auto outside = [](double v, double from, double to) {
        return std::max({from - v, v - to, 0.0});
      };
      return length({outside(p.x, box.low.x, box.high.x), outside(p.y, box.low.y, box.high.y),
                     outside(p.z, box.low.z, box.high.z)});
    }
  };
  std::map<std::array<int, 3>, Block> blocks_;
};

}  // namespace cavum::grading
