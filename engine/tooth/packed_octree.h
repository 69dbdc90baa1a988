// The canonical bytes of an octree (Octree::write) in about 30 % of the room that zstd at its best
// needs on a scanned molar: what is coded is how each cell, label and distance differs from what
// those around it let expect. Lossless; the same octree gives the same bytes.
#pragma once

#include <memory>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/tooth/tissue_grid.h"

namespace cavum {

/// What unpacking worked out about one octree. Another that differs from it in places, as a tooth
/// that was drilled, is then unpacked in less time, to the same bytes.
struct PackedFits;
using KnownFits = std::shared_ptr<const PackedFits>;

/// Appends the packed form (layout in packed_octree.cpp) of what `Octree::write` wrote. Throws
/// Error above 2^18 bricks.
void pack_octree(ByteReader& canonical, const std::vector<Tissue>& tissues, ByteWriter& out);
/// The canonical bytes again. Throws Error, of `in`, on damage; needs memory in proportion to the
/// bricks that `in` really codes. `like`, unless null: of an octree that is much the same. `keep`
/// receives what is worked out about this one.
[[nodiscard]] Bytes unpack_octree(ByteReader& in, const std::vector<Tissue>& tissues,
                                  const PackedFits* like = nullptr, KnownFits* keep = nullptr);

}  // namespace cavum
