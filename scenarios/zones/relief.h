// The tooth seen from above: how high its surface stands, and where a tissue's roof and floor lie.
// From it come the zones that follow the tissue, so that one scenario fits any tooth.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/message.h"
#include "engine/tooth/tooth.h"
#include "scenarios/file/scenario.h"

namespace cavum::scenarios {

/// A value per column of leaves (x fastest), with bilinear reading between the columns' centres.
struct ColumnMap {
  int nx = 0, ny = 0;
  double leaf_mm = 0.05;
  Vec3 origin_mm;  ///< corner of column (0,0); z unused
  std::vector<double> value;

  [[nodiscard]] std::size_t index(int x, int y) const noexcept {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(x);
  }
  /// Clamped to the map at its border.
  [[nodiscard]] double at(double x_mm, double y_mm) const noexcept;
  /// `rounds` passes of a 3x3 mean.
  void smooth(int rounds);
};

/// Part of a tissue, column by column. Heights are those of leaf faces, mm.
struct TissueRelief {
  ColumnMap roof_mm,
      floor_mm;  ///< of the part; outside its shadow those of the nearest column, smoothed
  std::vector<std::uint8_t> shadow;  ///< 1 where the part lies below this column
  double lowest_mm = 0.0;            ///< level where the part ends (the chamber: its floor)
  double highest_mm = 0.0;
  Vec3 middle_mm;  ///< centre of gravity

  /// Of no column yet.
  explicit TissueRelief(const ColumnMap& columns)
      : roof_mm(columns), floor_mm(columns), shadow(columns.value.size(), 0) {}
  /// Roof and floor beside the shadow, of those in it; then smoothed.
  void go_on_beside_shadow();
};

/// Height of the tooth's solid surface per column; columns without tooth hold k_no_tooth_mm.
inline constexpr double k_no_tooth_mm = -1e6;
[[nodiscard]] ColumnMap surface_relief(const Tooth& tooth);
/// z of the highest solid leaf of a column of that relief; -1 without tooth.
[[nodiscard]] int top_leaf(const ColumnMap& surface, const Octree& tree, int x, int y) noexcept;

/// Throws Error when the tooth has no such tissue or no leaf of it. `where` names the asker.
[[nodiscard]] TissueRelief tissue_relief(const Tooth& tooth, const std::string& tissue,
                                         TissuePart part, const Message& where);

/// Where a canal leaves the chamber: the middle of its mouth on the chamber's floor, and the radius
/// of a circle of the mouth's area.
struct CanalMouth {
  Vec3 at_mm;
  double radius_mm = 0.0;
};
/// The mouths of all canals of a tissue's chamber: the pieces of it just below the floor that are
/// no ripple (0.02 mm2 or more, and 0.3 mm deep). None when nothing goes on below the chamber.
/// Throws Error as tissue_relief does.
[[nodiscard]] std::vector<CanalMouth> canal_mouths(const Tooth& tooth, const std::string& tissue,
                                                   const Message& where);

/// Signed distance (mm, negative inside) to the edge of a set of columns, padded by `padding`
/// columns on each side; accurate to half a leaf.
[[nodiscard]] ColumnMap distance_to_edge(const ColumnMap& like,
                                         const std::vector<std::uint8_t>& inside, int padding);

}  // namespace cavum::scenarios
