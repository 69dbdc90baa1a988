// A value for each leaf of a box.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "engine/session/session_reader.h"

namespace cavum::grading {

struct LeafBox {
  IVec3 low, size;
};

/// Around all of the leaves, `margin` leaves wider on each side; empty where there are none.
[[nodiscard]] inline LeafBox box_around(std::span<const RemovedAt> leaves, int margin) {
  if (leaves.empty()) return {};
  LeafBounds box;
  for (const auto& r : leaves) {
    const IVec3 l = r.leaf.leaf();
    box.add(l);
  }
  const IVec3 wide{margin, margin, margin};
  return {box.low - wide, box.high - box.low + wide + wide + IVec3{1, 1, 1}};
}

template <class T>
class Lattice {
 public:
  Lattice() = default;
  Lattice(const LeafBox& box, T value) : Lattice(box, std::vector<T>(leaves_of(box), value)) {}
  /// `values`: x fastest, one for each leaf.
  Lattice(const LeafBox& box, std::vector<T> values) : box_(box), at_(std::move(values)) {}
  [[nodiscard]] bool holds(IVec3 leaf) const noexcept {
    return lies_in(leaf - box_.low, box_.size);
  }
  /// Of a leaf that it holds.
  [[nodiscard]] T& operator[](IVec3 leaf) noexcept { return at_[index(leaf)]; }
  [[nodiscard]] const T& operator[](IVec3 leaf) const noexcept { return at_[index(leaf)]; }
  [[nodiscard]] const std::vector<T>& all() const noexcept { return at_; }

 private:
  [[nodiscard]] static std::size_t leaves_of(const LeafBox& box) { return cells_of(box.size); }
  [[nodiscard]] std::size_t index(IVec3 leaf) const noexcept {
    return cell_index(leaf - box_.low, box_.size);
  }

  LeafBox box_;
  std::vector<T> at_;
};

}  // namespace cavum::grading
