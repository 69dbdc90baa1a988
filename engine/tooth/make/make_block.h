// Blocks of flat tissue layers: known geometry for checks, rigs and training. Surfaces are exact to
// the last digit of the distance code, also where a size is no multiple of the leaf. Frame: origin
// at the centre of the TOP face, tooth below: z from -height to 0, x and y symmetric.
#pragma once

#include <string>
#include <vector>

#include "engine/tooth/tooth.h"

namespace cavum {

using Layer = MadeBlock::Layer;

/// A block of `size_mm` (x, y, z), its layers from top to bottom, with four leaves of air around.
/// A leaf belongs to the layer that holds its centre. Throws Error when a size or a layer is not
/// positive or less than a leaf (it could be lost), the layers do not add up to the height (within
/// 1e-6 mm), a tissue is named "air" or by what is no plain text, or the grid would pass 1024
/// leaves.
[[nodiscard]] Tooth make_block(Vec3 size_mm, const std::vector<Layer>& layers, double leaf_mm);
/// A cube of one tissue.
[[nodiscard]] Tooth make_cube(double edge_mm, const std::string& tissue, double leaf_mm);

/// Reads "enamel:1.2,dentin:2.0" (names and mm, top to bottom). Throws Error naming the part it
/// cannot read.
[[nodiscard]] std::vector<Layer> parse_layers(const std::string& text);

}  // namespace cavum
