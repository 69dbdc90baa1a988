// What stands beside a tooth in the same octree: the teeth next to it and the gum. Their tissues
// have names of their own, so that contact, force, cutting, drawing and recording treat them as
// they treat all tissue. What is said of the tooth itself (landmarks, zones, walls, perforation) is
// asked of it alone: `own_tooth` takes them away again.
#pragma once

#include <array>
#include <string_view>

#include "engine/tooth/tooth.h"

namespace cavum {

/// By its name: "neighbour_enamel", "neighbour_dentin" or whatever begins like them.
[[nodiscard]] bool is_of_neighbour(std::string_view tissue) noexcept;
[[nodiscard]] bool is_gum(std::string_view tissue) noexcept;
/// One of both.
[[nodiscard]] bool is_adjacent(std::string_view tissue) noexcept;
/// What people read in a key: "neighbour's enamel", "gum", "caries"; of one without a row of its
/// own (tissues.h) its name.
[[nodiscard]] Message tissue_words(std::string_view tissue);

/// By tissue id. False for air.
using TissueSet = std::array<bool, 256>;
[[nodiscard]] TissueSet adjacent_tissues(const Tooth& tooth);
[[nodiscard]] TissueSet tissues_of(const Tooth& tooth, TissueKind kind);
/// Whether the tooth's table lists any of them.
[[nodiscard]] bool has_adjacent(const Tooth& tooth);

/// The same tree without some tissues: their leaves are air. What is left keeps its leaves and its
/// distances; where a tissue that goes was nearer to a place outside than what stays, the distance
/// there is found anew from the leaves that stay,
///
///     d(p) = min over their solid leaves q of |p - q| + d(q),
///
/// for a ball of radius -d(q) around q lies inside. It is true where some q lies on the normal
/// through p, and too large by e²/2|p - q| where the nearest is off it by e: on smooth surfaces by
/// 0.02 leaves on average and 0.15 at most, at an edge by 0.75 of a leaf.
[[nodiscard]] Octree octree_without(const Octree& tree, const TissueSet& gone);

/// The tooth alone, on the same leaves; a copy where nothing stands beside it. Its table of tissues
/// stays whole.
[[nodiscard]] Tooth own_tooth(const Tooth& tooth);
/// The teeth beside it alone.
[[nodiscard]] Octree neighbours_alone(const Tooth& tooth);

}  // namespace cavum
