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
  IVec3 low = leaves.front().leaf.leaf(), high = low;
  for (const auto& r : leaves) {
    const IVec3 l = r.leaf.leaf();
    low = {std::min(low.x, l.x), std::min(low.y, l.y), std::min(low.z, l.z)};
    high = {std::max(high.x, l.x), std::max(high.y, l.y), std::max(high.z, l.z)};
  }
  const IVec3 wide{margin, margin, margin};
  return {low - wide, high - low + wide + wide + IVec3{1, 1, 1}};
}

template <class T>
class Lattice {
 public:
  Lattice() = default;
  Lattice(const LeafBox& box, T value) : Lattice(box, std::vector<T>(leaves_of(box), value)) {}
  /// `values`: x fastest, one for each leaf.
  Lattice(const LeafBox& box, std::vector<T> values) : box_(box), at_(std::move(values)) {}
  [[nodiscard]] bool holds(IVec3 leaf) const noexcept {
    const IVec3 l = leaf - box_.low;
    return l.x >= 0 && l.y >= 0 && l.z >= 0 && l.x < box_.size.x && l.y < box_.size.y && l.z < box_.size.z;
  }
  /// Of a leaf that it holds.
  [[nodiscard]] T& operator[](IVec3 leaf) noexcept { return at_[index(leaf)]; }
  [[nodiscard]] const T& operator[](IVec3 leaf) const noexcept { return at_[index(leaf)]; }
  [[nodiscard]] const std::vector<T>& all() const noexcept { return at_; }

 private:
  [[nodiscard]] static std::size_t leaves_of(const LeafBox& box) {
    return static_cast<std::size_t>(box.size.x) * static_cast<std::size_t>(box.size.y) * static_cast<std::size_t>(box.size.z);
  }
  [[nodiscard]] std::size_t index(IVec3 leaf) const noexcept {
    const IVec3 l = leaf - box_.low;
    return (static_cast<std::size_t>(l.z) * static_cast<std::size_t>(box_.size.y) + static_cast<std::size_t>(l.y)) *
               static_cast<std::size_t>(box_.size.x) +
           static_cast<std::size_t>(l.x);
  }

  LeafBox box_;
  std::vector<T> at_;
};

}  // namespace cavum::grading
