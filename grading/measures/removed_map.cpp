#include "grading/measures/removed_map.h"

#include <algorithm>

namespace cavum::grading {

RemovedMap::RemovedMap(std::span<const RemovedAt> removed, std::int64_t last_tick) {
  std::vector<RemovedAt> counted;
  std::copy_if(removed.begin(), removed.end(), std::back_inserter(counted),
               [&](const RemovedAt& r) { return r.tick <= last_tick; });
  box_ = box_around(counted, 0);
  tick_ = Lattice<std::int32_t>(box_, -1);
  for (const auto& r : counted) {
    std::int32_t& t = tick_[r.leaf.leaf()];
    if (t >= 0) continue;  // listed twice: the first time counts
    t = static_cast<std::int32_t>(r.tick);
    ++count_;
  }
}

}  // namespace cavum::grading
