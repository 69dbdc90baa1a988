// A cavity in the buccal or lingual side of a crown, told by the neck: its outline is seen straight
// from that side, its axial wall follows the surface.
#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "engine/base/error.h"
#include "scenarios/zones/column.h"
#include "scenarios/zones/depth_field.h"
#include "scenarios/zones/outline.h"

namespace cavum::scenarios {
namespace {

constexpr double k_field_pad_mm = 0.5;  // of the field around the outline
constexpr double k_before_mm = 0.02;    // out of the cavity: soft tissue that lies before it
constexpr double k_max_lean = 0.55;     // tangent of 29 degrees
constexpr double k_march_mm = 0.02, k_slope_mm = 0.1, k_grid_mm = 0.2;
constexpr std::size_t k_fewest_of = 3;  // points of the neck on one side

/// The neck on one side: its height by x.
class NeckSide {
 public:
  NeckSide(const Polyline& neck, double middle_y, int side) {
    for (const Vec3& p : neck)
      if (side * (p.y - middle_y) > 0) points_.push_back(p);
    std::sort(points_.begin(), points_.end(), [](Vec3 a, Vec3 b) { return a.x < b.x; });
  }
  [[nodiscard]] bool found() const noexcept { return points_.size() >= k_fewest_of; }
  [[nodiscard]] std::size_t size() const noexcept { return points_.size(); }
  [[nodiscard]] double height_mm(double x) const noexcept {
    const auto next = std::upper_bound(points_.begin(), points_.end(), x,
                                       [](double at, Vec3 p) { return at < p.x; });
    if (next == points_.begin()) return points_.front().z;
    if (next == points_.end()) return points_.back().z;
    const Vec3 a = *(next - 1), b = *next;
    return a.z + (b.z - a.z) * (x - a.x) / (b.x - a.x);
  }

 private:
  std::vector<Vec3> points_;
};

/// How far an outline reaches from its own origin.
Bounds reach_of(const OutlineSpec& o) {
  Bounds r;
  const double around =
      (o.kind == OutlineSpec::Kind::circle ? o.radius_mm : 0.5 * o.width_mm) + o.offset_mm;
  std::vector<Vec3> points = o.points_mm;
  if (points.empty()) points.emplace_back();
  for (const Vec3& p : points) {
    const Vec3 q = p + o.centre_mm;
    r.add({q.x - around, q.y - around, 0}, {q.x + around, q.y + around, 0});
  }
  return r;
}

/// What a cavity stands on: the neck on its side, and the plane in which its outline is drawn.
struct Ground {
  int side = 1;
  bool level = false;
  Vec3 middle;             ///< x and z of the neck's middle on that side, y of the long axis
  double surface_y = 0.0;  ///< of the surface in the outline's middle
  double lean = 0.0;       ///< how much higher a wall stands for each millimetre further out
  NeckSide neck;
  /// Of a place, along the way to the plane of the outline.
  [[nodiscard]] Vec3 in_outline(Vec3 p) const noexcept {
    const double z = p.z - lean * side * (p.y - surface_y);
    return {p.x - middle.x, z - (level ? middle.z : neck.height_mm(p.x)), 0};
  }
};

class SideCavity final : public Shape {
 public:
  SideCavity(const ShapeSpec& spec, Ground ground, std::unique_ptr<Outline> outline,
             DepthField depth)
      : depth_of_it_mm_(spec.depth_mm),
        ground_(std::move(ground)),
        outline_(std::move(outline)),
        depth_(std::move(depth)) {}
  double distance_mm(Vec3 p) const noexcept override {
    const Vec3 q = ground_.in_outline(p);
    const double below = depth_.depth_mm(p) - depth_of_it_mm_,
                 behind = ground_.side * (ground_.middle.y - p.y);
    const double open = std::max(meet(outline_->distance_mm(q.x, q.y), below), behind);
    return open < k_before_mm && depth_.soft_outside(p) ? k_before_mm : open;
  }
  std::uint64_t pieces() const noexcept override { return 2 + outline_->pieces(); }

 private:
  double depth_of_it_mm_;
  Ground ground_;
  std::unique_ptr<Outline> outline_;
  DepthField depth_;
};

/// The surface inside the outline, seen straight from the side: its mean normal, and where it lies
/// in the outline's middle.
struct Surface {
  Vec3 normal;
  std::optional<double> middle_y;
};
Surface surface_in(const Ground& ground, const Outline& outline, const Bounds& reach,
                   const DepthField& depth, double out_y) {
  Surface found;
  const auto outwards = [&](double x, double z) -> std::optional<Vec3> {  // coming from outside
    for (double y = out_y; ground.side * (y - ground.middle.y) > 0; y -= ground.side * k_march_mm)
      if (depth.depth_mm({x, y, z}) >= 0) return Vec3{x, y, z};
    return {};
  };
  const auto slope = [&](Vec3 p, Vec3 way) {
    return depth.depth_mm(p + way * k_slope_mm) - depth.depth_mm(p - way * k_slope_mm);
  };
  double nearest = 1e9;
  const Vec3 centre = (reach.low + reach.high) * 0.5;
  for (double x = reach.low.x; x <= reach.high.x; x += k_grid_mm)
    for (double y = reach.low.y; y <= reach.high.y; y += k_grid_mm) {
      if (outline.distance_mm(x, y) >= 0) continue;
      const double at_x = ground.middle.x + x;
      const auto p =
          outwards(at_x, y + (ground.level ? ground.middle.z : ground.neck.height_mm(at_x)));
      if (!p) continue;
      found.normal += normalized(-Vec3{0, slope(*p, {0, 1, 0}), slope(*p, {0, 0, 1})},
                                 {0, double(ground.side), 0});
      if (const double off = length(Vec3{x, y, 0} - centre); off < nearest) {
        nearest = off;
        found.middle_y = p->y;
      }
    }
  return found;
}

}  // namespace

/// Points of the outline: x from the neck's middle towards mesial, y above the neck, mm, where it
/// meets the surface in its middle. Heights count from the neck below each place, so that a
/// rectangle bends with it (a kidney), or from its middle (`level`). Walls run straight in along
/// the way; the axial wall lies `depth_mm` below the surface, square to it. Open outwards; nothing
/// beyond the tooth's long axis. Throws Error when the tooth shows no neck on that side, or the
/// outline lies beside it.
std::unique_ptr<Shape> body_side_cavity(const ShapeSpec& spec, ShapeMaker& maker,
                                        const Message& where) {
  const Tooth& tooth = maker.own();
  const Landmarks& landmarks = maker.landmarks();
  Ground ground{spec.side,
                spec.level,
                landmarks.long_axis.through_mm,
                0,
                0,
                NeckSide(landmarks.neck_mm, landmarks.long_axis.through_mm.y, spec.side)};
  if (!ground.neck.found())
    throw Error(where,
                msg("no neck is found on the {} side of '{}'",
                    spec.side > 0 ? msg("buccal") : msg("lingual"), tooth.name),
                msg("look at `cavum tooth landmarks`, or place the cavity yourself"));
  ground.middle.z = ground.neck.height_mm(ground.middle.x);
  const Bounds reach = reach_of(spec.outline);
  double lowest = ground.middle.z, highest = ground.middle.z;
  for (double x = reach.low.x; !spec.level && x <= reach.high.x; x += 0.1) {
    lowest = std::min(lowest, ground.neck.height_mm(ground.middle.x + x));
    highest = std::max(highest, ground.neck.height_mm(ground.middle.x + x));
  }
  const Octree& tree = tooth.octree;
  const double pad = spec.depth_mm + k_field_pad_mm,
               out = spec.side > 0 ? tree.origin_mm().y + tree.size().y * tree.leaf_mm()
                                   : tree.origin_mm().y;
  const Vec3 low{ground.middle.x + reach.low.x - pad, std::min(ground.middle.y, out),
                 lowest + reach.low.y - pad},
      high{ground.middle.x + reach.high.x + pad, std::max(ground.middle.y, out),
           highest + reach.high.y + pad};
  DepthField depth(tooth, tree.leaf_at(low), tree.leaf_at(high) + IVec3{1, 1, 1}, maker.work());
  auto outline = make_outline(spec.outline, spec.outline.centre_mm, nullptr);
  const Surface surface = surface_in(ground, *outline, reach, depth, out);
  if (!surface.middle_y)
    throw Error(where, msg("the outline lies beside the tooth '{}'", tooth.name),
                msg("move it onto the crown, or make it larger"));
  const Vec3 normal = normalized(surface.normal, {0, double(spec.side), 0});
  ground.surface_y = *surface.middle_y;
  ground.lean =
      std::clamp(normal.z / std::max(1e-6, spec.side * normal.y), -k_max_lean, k_max_lean);
  // the mean normal of the surface inside the outline, without its part along x
  maker.set_way_in(spec, normalized(Vec3{0, double(spec.side), ground.lean}));
  return std::make_unique<SideCavity>(spec, std::move(ground), std::move(outline),
                                      std::move(depth));
}

}  // namespace cavum::scenarios
