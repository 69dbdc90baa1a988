// Which leaves were removed and when: a dense map over the box of all removed leaves.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/session/session_reader.h"

namespace cavum::grading {

class RemovedMap {
 public:
  /// Leaves removed in ticks 0..last_tick.
  RemovedMap(std::span<const RemovedAt> removed, std::int64_t last_tick);

  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  /// Tick in which a leaf was removed, -1 when it was not.
  [[nodiscard]] std::int64_t tick(IVec3 leaf) const noexcept {
    const IVec3 l = leaf - low_;
    if (l.x < 0 || l.y < 0 || l.z < 0 || l.x >= size_.x || l.y >= size_.y || l.z >= size_.z) return -1;
    return tick_[(static_cast<std::size_t>(l.z) * static_cast<std::size_t>(size_.y) + static_cast<std::size_t>(l.y)) *
                     static_cast<std::size_t>(size_.x) +
                 static_cast<std::size_t>(l.x)];
  }
  [[nodiscard]] bool has(IVec3 leaf) const noexcept { return tick(leaf) >= 0; }

  /// A mark for every leaf of the box and one leaf around it.
  class Marks {
   public:
    Marks(IVec3 low, IVec3 size)
        : low_(low), size_(size), seen_(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z), 0) {}
    /// True when asked for the first time about this leaf, which must lie within.
    [[nodiscard]] bool first_time(IVec3 leaf) noexcept {
      const IVec3 l = leaf - low_;
      auto& seen = seen_[(static_cast<std::size_t>(l.z) * static_cast<std::size_t>(size_.y) + static_cast<std::size_t>(l.y)) *
                             static_cast<std::size_t>(size_.x) +
                         static_cast<std::size_t>(l.x)];
      const bool first = seen == 0;
      seen = 1;
      return first;
    }

    [[nodiscard]] bool seen(IVec3 leaf) const noexcept {
      const IVec3 l = leaf - low_;
      if (l.x < 0 || l.y < 0 || l.z < 0 || l.x >= size_.x || l.y >= size_.y || l.z >= size_.z) return false;
      return seen_[(static_cast<std::size_t>(l.z) * static_cast<std::size_t>(size_.y) + static_cast<std::size_t>(l.y)) *
                       static_cast<std::size_t>(size_.x) +
                   static_cast<std::size_t>(l.x)] != 0;
    }

   private:
    IVec3 low_, size_;
    std::vector<std::uint8_t> seen_;
  };
  [[nodiscard]] Marks marks() const { return {low_ - IVec3{1, 1, 1}, size_ + IVec3{2, 2, 2}}; }

 private:
  IVec3 low_, size_;
  std::vector<std::int32_t> tick_;  // 2^31 ms are 24 days
  std::size_t count_ = 0;
};

/// Calls `visit(removed_at)` for each leaf of the list that was removed until `last_tick`, once: at the tick that the map has.
template <class Visit>
void for_each_removed(std::span<const RemovedAt> list, const RemovedMap& removed, std::int64_t last_tick, const Visit& visit) {
  for (const auto& r : list)
    if (r.tick <= last_tick && removed.tick(r.leaf.leaf()) == r.tick) visit(r);
}

}  // namespace cavum::grading
