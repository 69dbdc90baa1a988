// Which leaves were removed and when: a dense map over the box of all removed leaves.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "grading/measures/lattice.h"

namespace cavum::grading {

class RemovedMap {
 public:
  /// Leaves removed in ticks 0..last_tick.
  RemovedMap(std::span<const RemovedAt> removed, std::int64_t last_tick);

  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  /// Tick in which a leaf was removed, -1 when it was not.
  [[nodiscard]] std::int64_t tick(IVec3 leaf) const noexcept {
    return tick_.holds(leaf) ? tick_[leaf] : -1;
  }
  [[nodiscard]] bool has(IVec3 leaf) const noexcept { return tick(leaf) >= 0; }

  /// A mark for every leaf of the box and one leaf around it.
  class Marks {
   public:
    explicit Marks(const LeafBox& box) : seen_(box, 0) {}
    /// True when asked for the first time about this leaf, which must lie within.
    [[nodiscard]] bool first_time(IVec3 leaf) noexcept {
      return std::exchange(seen_[leaf], std::uint8_t{1}) == 0;
    }
    [[nodiscard]] bool seen(IVec3 leaf) const noexcept {
      return seen_.holds(leaf) && seen_[leaf] != 0;
    }

   private:
    Lattice<std::uint8_t> seen_;
  };
  [[nodiscard]] Marks marks() const {
    return Marks({box_.low - IVec3{1, 1, 1}, box_.size + IVec3{2, 2, 2}});
  }

 private:
  LeafBox box_;
  Lattice<std::int32_t> tick_;  // 2^31 ms are 24 days
  std::size_t count_ = 0;
};

/// Calls `visit(removed_at)` for each leaf of the list that was removed until `last_tick`, once: at
/// the tick that the map has.
template <class Visit>
void for_each_removed(std::span<const RemovedAt> list, const RemovedMap& removed,
                      std::int64_t last_tick, const Visit& visit) {
  for (const auto& r : list)
    if (r.tick <= last_tick && removed.tick(r.leaf.leaf()) == r.tick) visit(r);
}

}  // namespace cavum::grading
