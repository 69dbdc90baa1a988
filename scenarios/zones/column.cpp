#include "scenarios/zones/column.h"

#include "engine/base/det_math.h"

namespace cavum::scenarios {

Column::Column(std::unique_ptr<Outline> outline, ColumnMap bottom, double taper_deg, double outline_z)
    : outline_(std::move(outline)), bottom_(std::move(bottom)), outline_z_(outline_z) {
  at_centre_.reserve(bottom_.value.size());
  for (int y = 0; y < bottom_.ny; ++y)
    for (int x = 0; x < bottom_.nx; ++x) at_centre_.push_back(outline_->distance_mm(centre(bottom_.origin_mm.x, x), centre(bottom_.origin_mm.y, y)));
  const SinCos a = det_sincos(taper_deg * k_pi / 180);
  tan_ = a.sin / a.cos;
  cos_ = a.cos;
}

double Column::outline_mm(double x_mm, double y_mm) const noexcept {
  const double qx = (x_mm - bottom_.origin_mm.x) / bottom_.leaf_mm, qy = (y_mm - bottom_.origin_mm.y) / bottom_.leaf_mm;
  if (qx >= 0 && qy >= 0 && qx < bottom_.nx && qy < bottom_.ny) {
    const int x = static_cast<int>(qx), y = static_cast<int>(qy);
    if (centre(bottom_.origin_mm.x, x) == x_mm && centre(bottom_.origin_mm.y, y) == y_mm) return at_centre_[bottom_.index(x, y)];
  }
  return outline_->distance_mm(x_mm, y_mm);
}

}  // namespace cavum::scenarios
