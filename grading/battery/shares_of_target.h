// Places that part the target's volume, or a tissue's in it, by given shares.
#pragma once

#include <algorithm>
#include <vector>

#include "grading/battery/target_field.h"

namespace cavum::grading {

/// Value of `along(place)` beyond which a share (0..1) of the leaves lies; of all, or of one tissue's. Half a leaf between leaves.
template <class Along>
[[nodiscard]] double beyond_which(const TargetField& field, double share, const Along& along, int tissue = -1) {
  std::vector<double> at;
  for (const auto& leaf : field.leaves())
    if (tissue < 0 || leaf.tissue == tissue) at.push_back(along(leaf.at));
  if (at.empty()) return 0;
  const auto rank = std::min(at.size() - 1, static_cast<std::size_t>((1 - share) * static_cast<double>(at.size())));
  std::nth_element(at.begin(), at.begin() + static_cast<std::ptrdiff_t>(rank), at.end());
  return at[rank] - 0.5 * field.tooth().octree.leaf_mm();
}

}  // namespace cavum::grading
