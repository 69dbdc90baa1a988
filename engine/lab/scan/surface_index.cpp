#include "engine/lab/scan/surface_index.h"

#include <algorithm>

#include "engine/tooth/distance_transform.h"

namespace cavum {

SurfaceIndex::SurfaceIndex(const std::vector<SurfacePoint>& points, double cell_mm,
                           double margin_mm)
    : cell_mm_(cell_mm) {
  constexpr double k_max_cells = 4e6;
  Bounds box;
  for (const auto& p : points) box.add(p.at_mm);
  const Vec3 margin{margin_mm, margin_mm, margin_mm};
  low_mm_ = box.low - margin;
  const Vec3 extent = box.high + margin - low_mm_;
  while (extent.x * extent.y * extent.z > k_max_cells * cell_mm_ * cell_mm_ * cell_mm_)
    cell_mm_ *= 1.1;
  const auto cells = [&](double mm) { return static_cast<std::int32_t>(mm / cell_mm_) + 1; };
  size_ = {cells(extent.x), cells(extent.y), cells(extent.z)};

  const std::size_t count = cells_of(size_);
  std::vector<std::int32_t> place_of(count, -1);
  std::vector<double> nearest;  // squared distance of each place from the middle of its cell
  for (const auto& p : points) {
    const std::size_t cell = cell_of(p.at_mm);
    const Vec3 off = p.at_mm - centre_of(cell);
    if (place_of[cell] < 0) {
      place_of[cell] = static_cast<std::int32_t>(places_.size());
      places_.push_back({p.at_mm, {}});
      nearest.push_back(dot(off, off));
    }
    const auto i = static_cast<std::size_t>(place_of[cell]);
    places_[i].normal += p.normal * p.area_mm2;
    if (dot(off, off) >= nearest[i]) continue;
    nearest[i] = dot(off, off);
    places_[i].at_mm = p.at_mm;
  }
  for (Place& p : places_) p.normal = normalized(p.normal * 1e6);
  std::vector<std::uint8_t> seed(count);
  for (std::size_t i = 0; i < count; ++i) seed[i] = place_of[i] >= 0 ? 1 : 0;
  cells_ = nearest_seed(size_, seed);
  for (std::int32_t& c : cells_) c = place_of[static_cast<std::size_t>(c)];
}

}  // namespace cavum
