// The tooth as the report's page draws it: cells of some leaves each, with how much of a cell is
// solid tissue, and, where the exam changed something or the target is near, what was left, when it
// went and how far the cell lies from the target. Counted leaf by leaf: the shares add up to the
// octree's own count.
#pragma once

#include <cstdint>
#include <vector>

#include "grading/marking/grade.h"

namespace cavum::report {

struct ToothGrid {
  int edge_leaves = 2;   ///< a cell is so many leaves wide
  double cell_mm = 0.1;  ///< edge of a cell
  IVec3 low_leaf;        ///< lowest leaf of cell (0,0,0); may lie outside the octree
  Vec3 origin_mm;        ///< centre of cell (0,0,0), tooth frame
  IVec3 size;            ///< cells along x, y, z; at least two without any tissue on every side
  std::vector<std::uint16_t> solid;  ///< solid leaves of each cell, x fastest
  std::vector<std::uint8_t>
      tissue;  ///< id of the solid tissue that fills most of the cell, else of what is there
  [[nodiscard]] int cell_leaves() const noexcept { return edge_leaves * edge_leaves * edge_leaves; }
  [[nodiscard]] std::size_t index(IVec3 cell) const noexcept { return cell_index(cell, size); }
  /// The cell of a leaf that holds tissue.
  [[nodiscard]] IVec3 cell_of(IVec3 leaf) const noexcept {
    const IVec3 l = leaf - low_leaf;
    return {l.x / edge_leaves, l.y / edge_leaves, l.z / edge_leaves};
  }
  [[nodiscard]] Vec3 centre_mm(IVec3 cell) const noexcept {
    return origin_mm + to_vec3(cell) * cell_mm;
  }
};

/// Cells of about 0.1 mm, larger where there would be more than `most_cells`. Throws Error for a
/// tooth without tissue.
[[nodiscard]] ToothGrid make_tooth_grid(const Tooth& tooth, std::size_t most_cells = 3'000'000);

/// What the exam did, in a box of the grid: all cells from which a leaf was removed, and those
/// within 1 mm of the target.
struct ChangedCells {
  IVec3 low, size;                         ///< of the box, in cells
  std::vector<std::uint16_t> solid;        ///< solid leaves left, x fastest
  std::vector<std::uint16_t> first, last;  ///< when the first and the last of them went, in 1/65535
                                           ///< of the recording; 65535 in both: none went
  std::vector<std::int8_t>
      distance;  ///< of the cell's centre from the target, 0.02 mm, + = outside, clamped
};
inline constexpr double k_distance_step_mm = 0.02;
[[nodiscard]] ChangedCells make_changed_cells(const ToothGrid& grid,
                                              const grading::GradeInput& input);

/// A share of a cell's leaves in 1/255, to the nearest: it gives the number of leaves back for
/// cells of up to 128.
[[nodiscard]] std::vector<std::uint8_t> shares_of(const std::vector<std::uint16_t>& solid,
                                                  int cell_leaves);

}  // namespace cavum::report
