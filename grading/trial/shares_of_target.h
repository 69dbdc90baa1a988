// Places that part the target's volume, or a tissue's in it, by given shares.
#pragma once

#include <algorithm>
#include <vector>

#include "grading/trial/target_field.h"

namespace cavum::grading {

/// Value of `along(place)` beyond which a share (0..1) of the leaves lies; of all, or of one
/// tissue's. Half a leaf between leaves. Leaves at one value go together, and no more lie beyond
/// than the share: the upper 85 % of a shallow target must not be 88.
template <class Along>
[[nodiscard]] double beyond_which(const TargetField& field, double share, const Along& along,
                                  int tissue = -1) {
  std::vector<double> at;
  for (const auto& leaf : field.leaves())
    if (tissue < 0 || leaf.tissue == tissue) at.push_back(along(leaf.at));
  if (at.empty()) return 0;
  const double wanted = share * static_cast<double>(at.size()),
               half = 0.5 * field.tooth().octree.leaf_mm();
  const auto rank =
      std::min(at.size() - 1, static_cast<std::size_t>(static_cast<double>(at.size()) - wanted));
  std::nth_element(at.begin(), at.begin() + static_cast<std::ptrdiff_t>(rank), at.end());
  const double value = at[rank];
  const auto beyond = [&](double v) {
    return static_cast<double>(
        std::count_if(at.begin(), at.end(), [v](double a) { return a > v; }));
  };
  return beyond(value - half) < wanted + 1 ? value - half : value + half;
}

}  // namespace cavum::grading
