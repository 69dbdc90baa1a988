#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "engine/base/det_math.h"
#include "engine/base/error.h"
#include "engine/base/text.h"
#include "scenarios/zones/outline.h"
#include "scenarios/zones/shape.h"

namespace cavum::scenarios {
namespace {

/// A four-cornered profile turned about the axis.
class Frustum final : public Shape {
 public:
  Frustum(const ShapeSpec& s, double top)
      : frame_(shape_frame(s)), low_(s.radius_mm), top_(top), height_(s.height_mm) {}
  double distance_mm(Vec3 p) const noexcept override {
    const Vec3 q = frame_.local(p);
    const double r = std::sqrt(q.x * q.x + q.y * q.y), z = q.z;
    const std::array<Vec3, 4> corner{
        {{0, 0, 0}, {low_, 0, 0}, {top_, height_, 0}, {0, height_, 0}}};
    double nearest = 1e300;
    for (std::size_t i = 0; i < 3; ++i)
      nearest = std::min(nearest, segment_distance({r, z, 0}, corner[i], corner[i + 1]));
    const double side =
        (r - low_) * height_ - (top_ - low_) * z;  // sign of being outside the slanted wall
    return z > 0 && z < height_ && side < 0 ? -nearest : nearest;
  }
  std::uint64_t pieces() const noexcept override { return 3; }

 private:
  ShapeFrame frame_;
  double low_, top_, height_;
};

/// Cones that open towards occlusal; like a column they have no upper end.
class CanalCones final : public Shape {
 public:
  void add(const ShapeSpec& s, double top) { cones_.emplace_back(s, top); }
  [[nodiscard]] bool empty() const noexcept { return cones_.empty(); }
  double distance_mm(Vec3 p) const noexcept override {
    double d = 1e3;
    for (const Frustum& cone : cones_) d = std::min(d, cone.distance_mm(p));
    return d;
  }
  std::uint64_t pieces() const noexcept override {
    std::uint64_t sum = 0;
    for (const Frustum& cone : cones_) sum += cone.pieces();
    return sum;
  }

 private:
  std::vector<Frustum> cones_;
};

}  // namespace

std::unique_ptr<Shape> body_cylinder(const ShapeSpec& spec, ShapeMaker&, const Message&) {
  return std::make_unique<Frustum>(spec, spec.radius_mm);
}

std::unique_ptr<Shape> body_cone(const ShapeSpec& spec, ShapeMaker&, const Message&) {
  return std::make_unique<Frustum>(spec, spec.top_radius_mm);
}

std::unique_ptr<Shape> body_canal_cone(const ShapeSpec& spec, ShapeMaker& maker,
                                       const Message& where) {
  constexpr double k_out_of_any_tooth_mm = 60;
  const SinCos taper = det_sincos(spec.taper_deg * k_pi / 180);
  const Tooth& tooth = maker.tooth();
  const Vec3 middle = maker.relief(spec.tissue, TissuePart::chamber, where).middle_mm;
  auto all = std::make_unique<CanalCones>();
  std::string found;
  const auto mouths = canal_mouths(tooth, spec.tissue, where);
  if (mouths.empty())
    throw Error(where, msg("no canal leaves the {} of '{}'", spec.tissue, tooth.name),
                msg("choose a tooth with canals, or another shape"));
  for (const CanalMouth& mouth : mouths) {
    found += fmt::format("{}{}, {}, {}]", found.empty() ? "[" : ", [", fixed(mouth.at_mm.x, 2),
                         fixed(mouth.at_mm.y, 2), fixed(mouth.at_mm.z, 2));
    const Vec3 off = mouth.at_mm - middle;
    if (spec.canals_x * off.x < 0 || spec.canals_y * off.y < 0) continue;
    ShapeSpec cone = spec;
    cone.at_mm = mouth.at_mm - spec.axis * spec.deeper_mm;
    if (cone.radius_mm == 0) cone.radius_mm = mouth.radius_mm;
    cone.height_mm = k_out_of_any_tooth_mm;
    all->add(cone, cone.radius_mm + cone.height_mm * taper.sin / taper.cos);
  }
  if (all->empty())
    throw Error(
        where,
        msg("no canal lies on that side of the chamber's middle; the mouths are at {} mm", found),
        msg("choose another side in 'canals', or \"all\""));
  return all;
}

}  // namespace cavum::scenarios
