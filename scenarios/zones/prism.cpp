#include <cmath>

#include "scenarios/zones/column.h"

namespace cavum::scenarios {
namespace {

class Prism final : public Shape {
 public:
  explicit Prism(const ShapeSpec& s)
      : frame_(shape_frame(s)),
        height_(s.height_mm),
        outline_(make_outline(s.outline, s.outline.centre_mm, nullptr)) {}
  double distance_mm(Vec3 p) const noexcept override {
    const Vec3 q = frame_.local(p);
    return meet(outline_->distance_mm(q.x, q.y), std::fabs(q.z - 0.5 * height_) - 0.5 * height_);
  }
  std::uint64_t pieces() const noexcept override { return 1 + outline_->pieces(); }

 private:
  ShapeFrame frame_;
  double height_;
  std::unique_ptr<Outline> outline_;
};

}  // namespace

std::unique_ptr<Shape> body_prism(const ShapeSpec& spec, ShapeMaker&, const Message&) {
  return std::make_unique<Prism>(spec);
}

}  // namespace cavum::scenarios
