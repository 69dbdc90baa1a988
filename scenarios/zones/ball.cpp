#include "scenarios/zones/shape.h"

namespace cavum::scenarios {
namespace {

class Ball final : public Shape {
 public:
  explicit Ball(const ShapeSpec& s) : centre_(s.at_mm), radius_(s.radius_mm) {}
  double distance_mm(Vec3 p) const noexcept override { return length(p - centre_) - radius_; }

 private:
  Vec3 centre_;
  double radius_;
};

}  // namespace

std::unique_ptr<Shape> body_ball(const ShapeSpec& spec, ShapeMaker&, const Message&) {
  return std::make_unique<Ball>(spec);
}

}  // namespace cavum::scenarios
