#include <algorithm>
#include <cmath>

#include "scenarios/zones/placed.h"
#include "scenarios/zones/shape.h"

namespace cavum::scenarios {
namespace {

class Box final : public Shape {
 public:
  explicit Box(const ShapeSpec& s) : frame_(shape_frame(s)), half_(s.size_mm * 0.5) {}
  double distance_mm(Vec3 p) const noexcept override {
    const Vec3 q = frame_.local(p);
    const Vec3 d{std::fabs(q.x) - half_.x, std::fabs(q.y) - half_.y, std::fabs(q.z) - half_.z};
    const double inside = std::max({d.x, d.y, d.z});
    if (inside <= 0) return inside;
    return length({std::max(d.x, 0.0), std::max(d.y, 0.0), std::max(d.z, 0.0)});
  }

 private:
  ShapeFrame frame_;
  Vec3 half_;
};

}  // namespace

std::unique_ptr<Shape> body_box(const ShapeSpec& spec, ShapeMaker&, const Message&) {
  return std::make_unique<Box>(spec);
}

std::unique_ptr<Shape> body_proximal_box(const ShapeSpec& spec, ShapeMaker& maker,
                                         const Message& where) {
  return std::make_unique<Box>(place_proximal_box(spec, maker.own(), maker.landmarks(), where));
}

}  // namespace cavum::scenarios
