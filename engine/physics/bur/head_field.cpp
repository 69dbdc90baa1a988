#include "engine/physics/bur/head_field.h"

#include <algorithm>

namespace cavum {

HeadField::HeadField(const Profile& head, double cutting_length_mm, double head_radius_mm) {
  columns_ = static_cast<int>((head_radius_mm + k_margin_mm) * k_per_mm) + 2;
  const int rows = static_cast<int>((cutting_length_mm + 2 * k_margin_mm) * k_per_mm) + 2;
  constexpr float k_before = 0.999f;  // so that a clamped place still has a node after it
  last_r_ = static_cast<float>(columns_ - 2) + k_before;
  last_z_ = static_cast<float>(rows - 2) + k_before;
  table_.reserve(static_cast<std::size_t>(rows * columns_));
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns_; ++i) {
      const Vec3 at{i / double{k_per_mm}, 0, j / double{k_per_mm} - double{k_margin_mm}};
      table_.push_back(
          static_cast<float>(std::max(head.distance_mm(at), at.z - cutting_length_mm)));
    }
}

}  // namespace cavum
