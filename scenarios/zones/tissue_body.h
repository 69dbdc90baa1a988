// Leaves of a tissue or of several, grown, as a body: a dense distance around them.
#pragma once

#include <memory>

#include "engine/tooth/adjacent.h"
#include "scenarios/zones/shape.h"

namespace cavum::scenarios {

/// From `low` on, `high` exclusive.
struct LeafRange {
  IVec3 low, high;
};
inline constexpr LeafRange k_all_leaves{{-100, -100, -100}, {1 << 20, 1 << 20, 1 << 20}};

/// Of the leaves above `lowest_mm` (tooth frame). Within `asked` alone, where one need not know
/// more.
[[nodiscard]] std::unique_ptr<Shape> tissue_body(const Tooth& tooth, const TissueSet& tissues,
                                                 double lowest_mm, double offset_mm, ZoneWork& work,
                                                 const LeafRange& asked = k_all_leaves);

[[nodiscard]] bool any_within(const Octree& tree, const TissueSet& tissues, const LeafRange& asked);

}  // namespace cavum::scenarios
