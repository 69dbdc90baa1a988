// What of a tooth one picture shows: the window of leaves that it cuts out, and which leaf stands
// at each of its columns and rows.
#pragma once

#include <vector>

#include "scenarios/review/picture.h"

namespace cavum::scenarios {

class Section {
 public:
  /// Cut at `at_mm` along the axis looked at; the view from above needs none. `after` may be null:
  /// nothing was removed yet. Keeps references.
  Section(const Octree& before, const Octree* after, const ZoneMap& zones, View view, double at_mm);

  const Octree& before;
  const Octree* const after;
  const ZoneMap& zones;

  [[nodiscard]] bool from_above() const noexcept { return view_ == View::occlusal; }
  /// Occlusal is up.
  [[nodiscard]] bool upright() const noexcept {
    return view_ == View::mesio_distal || view_ == View::bucco_lingual;
  }
  /// Leaves.
  [[nodiscard]] int width() const noexcept {
    return view_ == View::bucco_lingual ? high_.y - low_.y : high_.x - low_.x;
  }
  [[nodiscard]] int height() const noexcept {
    return upright() ? high_.z - low_.z : high_.y - low_.y;
  }
  /// The leaf that is seen there, rows upwards. From above it is the column's highest one, of the
  /// lowest layer where the column is empty.
  [[nodiscard]] IVec3 leaf(int column, int row) const noexcept;
  /// From above: highest leaf of a column with tissue that is not periodontium, before and after;
  /// -1 without.
  [[nodiscard]] int top(int column, int row) const noexcept { return top_[index(column, row)]; }
  [[nodiscard]] int top_after(int column, int row) const noexcept {
    return top_after_[index(column, row)];
  }
  /// Nothing of the tooth, or nothing but what holds it.
  [[nodiscard]] bool adjacent_tooth(int column, int row) const noexcept;
  [[nodiscard]] bool air(int column, int row) const noexcept;

 private:
  void frame_target();
  void follow_deeper_cut();
  void find_tops();
  [[nodiscard]] bool cut_in_row(int row) const noexcept;
  [[nodiscard]] std::size_t index(int column, int row) const noexcept {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width()) +
           static_cast<std::size_t>(column);
  }

  View view_;
  IVec3 low_, high_;  // of the tooth
  int depth_ = 0;     // leaf along the axis looked at
  std::vector<int> top_, top_after_;
};

}  // namespace cavum::scenarios
