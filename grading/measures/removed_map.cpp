#include "grading/measures/removed_map.h"

#include <algorithm>

namespace cavum::grading {

RemovedMap::RemovedMap(std::span<const RemovedAt> removed, std::int64_t last_tick) {
  IVec3 low{1 << 20, 1 << 20, 1 << 20}, high{-1, -1, -1};
  for (const auto& r : removed) {
    if (r.tick > last_tick) continue;
    const IVec3 l = r.leaf.leaf();
    low = {std::min(low.x, l.x), std::min(low.y, l.y), std::min(low.z, l.z)};
    high = {std::max(high.x, l.x + 1), std::max(high.y, l.y + 1), std::max(high.z, l.z + 1)};
  }
  if (high.x < 0) return;
  low_ = low;
  size_ = high - low;
  tick_.assign(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) * static_cast<std::size_t>(size_.z), -1);
  for (const auto& r : removed) {
    if (r.tick > last_tick) continue;
    const IVec3 l = r.leaf.leaf() - low_;
    auto& t = tick_[(static_cast<std::size_t>(l.z) * static_cast<std::size_t>(size_.y) + static_cast<std::size_t>(l.y)) *
                        static_cast<std::size_t>(size_.x) +
                    static_cast<std::size_t>(l.x)];
    if (t >= 0) continue;  // listed twice: the first time counts
    t = static_cast<std::int32_t>(r.tick);
    ++count_;
  }
}

}  // namespace cavum::grading
