// What a full crown takes the place of: everything outside a tapered stump, above a finish line
// that follows the neck.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "engine/base/det_math.h"
#include "engine/base/error.h"
#include "scenarios/zones/depth_field.h"
#include "scenarios/zones/shape.h"

namespace cavum::scenarios {
namespace {

constexpr int k_bearings =
    288;  // directions about the long axis; by a turn that is cheap and exact, not by the angle
constexpr int k_smooth_directions = 14;  // to each side: the finish line is no ripple
constexpr double k_relief_mm = 0.5;      // over which the occlusal surface is smoothed
constexpr double k_steepest = 1.3;       // of a slope's 1 / cosine: steeper is an axial surface
constexpr double k_ramp_mm = 1.0;        // above the chamfer, until the wall keeps its whole depth
constexpr double k_ramp_share = 0.8;     // of it at the chamfer
constexpr double k_beside_mm = 0.02;     // out of the shell: soft tissue that lies beside it
constexpr double k_field_below_mm = 1.0, k_out_mm = 1e3;

/// A turn about the axis from 0 to 4, growing with the angle: y / (|x| + |y|) in its quarter.
double turn_of(double x, double y) noexcept {
  const double sum = std::fabs(x) + std::fabs(y);
  if (!(sum > 0)) return 0;
  if (y >= 0) return x >= 0 ? y / sum : 1 - x / sum;
  return x < 0 ? 2 - y / sum : 3 + x / sum;
}

Vec3 way_of(double turn) noexcept {
  const int quarter = static_cast<int>(turn) % 4;
  const double part = turn - std::floor(turn);
  const std::array<Vec3, 4> ways{
      {{1 - part, part, 0}, {-part, 1 - part, 0}, {part - 1, -part, 0}, {part, part - 1, 0}}};
  return normalized(ways[static_cast<std::size_t>(quarter)], {1, 0, 0});
}

/// The finish line: height and distance from the axis in each direction.
struct FinishLine {
  std::array<double, k_bearings> z_mm{}, radius_mm{};
  struct Place {
    double z_mm, radius_mm;
  };
  [[nodiscard]] Place at(double x, double y) const noexcept {
    const double t = turn_of(x, y) * (0.25 * k_bearings);
    const int i = static_cast<int>(t) % k_bearings, j = (i + 1) % k_bearings;
    const double f = t - std::floor(t);
    const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
    return {z_mm[a] + (z_mm[b] - z_mm[a]) * f, radius_mm[a] + (radius_mm[b] - radius_mm[a]) * f};
  }
};

/// Height of a closed line about `middle` in a direction; nothing where it does not go round.
bool line_height(const Polyline& line, Vec3 middle, Vec3 way, double& z) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Vec3 a = line[i] - middle, b = line[(i + 1) % line.size()] - middle;
    const double ca = way.x * a.y - way.y * a.x, cb = way.x * b.y - way.y * b.x;
    if ((ca > 0) == (cb > 0)) continue;
    const double f = ca / (ca - cb);
    const Vec3 at = a + (b - a) * f;
    if (at.x * way.x + at.y * way.y <= 0) continue;
    z = at.z + middle.z;
    return true;
  }
  return false;
}

class CrownShell final : public Shape {
 public:
  CrownShell(const ShapeSpec& spec, Vec3 middle, FinishLine line, ColumnMap top, DepthField depth)
      : middle_(middle),
        chamfer_(spec.depth_mm),
        line_(line),
        top_(std::move(top)),
        depth_(std::move(depth)) {
    const SinCos a = det_sincos(spec.taper_deg * k_pi / 180);
    tan_ = a.sin / a.cos;
    cos_ = a.cos;
  }
  double distance_mm(Vec3 p) const noexcept override {
    const double x = p.x - middle_.x, y = p.y - middle_.y, r = std::sqrt(x * x + y * y);
    const auto [z, radius] = line_.at(x, y);
    const double up = p.z - z, in = radius - r;
    const double shell = up < chamfer_ ? -over_chamfer(in, up) : over_wall(p, in, up);
    return shell < k_beside_mm && depth_.soft_outside(p) ? k_beside_mm : shell;
  }
  std::uint64_t pieces() const noexcept override { return 4; }

 private:
  /// Of a place above the chamfer, `in` mm inside the finish line and `up` mm above it: negative
  /// outside the stump.
  [[nodiscard]] double over_wall(Vec3 p, double in, double up) const noexcept {
    const double wall = (tan_ * (up - chamfer_) + chamfer_ - in) * cos_;
    const double share =
        std::min(1.0, k_ramp_share + (1 - k_ramp_share) * (up - chamfer_) / k_ramp_mm);
    return -std::max({wall, share * chamfer_ - depth_.depth_mm(p), p.z - top_.at(p.x, p.y)});
  }
  /// Of a place below the chamfer's upper end, `in` mm inside the finish line and `up` mm above it:
  /// how far out of the stump it lies.
  [[nodiscard]] double over_chamfer(double in, double up) const noexcept {
    if (in <= 0) return up;
    if (in >= chamfer_) return chamfer_ - in;
    const double down = chamfer_ - up;
    return chamfer_ - std::sqrt(in * in + down * down);
  }
  Vec3 middle_;
  double chamfer_, tan_ = 0, cos_ = 1;
  FinishLine line_;
  ColumnMap top_;  // of the stump
  DepthField depth_;
};

/// The stump's top: the smoothed relief, lower by `reduction_mm` square to its slope.
ColumnMap stump_top(ColumnMap relief, double reduction_mm) {
  const ColumnMap before = relief;
  const int around = std::max(1, static_cast<int>(k_relief_mm / relief.leaf_mm + 0.5));
  const auto known = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < relief.nx && y < relief.ny &&
           before.value[before.index(x, y)] != k_no_tooth_mm;
  };
  const auto blurred = [&](const std::vector<double>& from, bool along_x) {
    std::vector<double> to = from;
    for (int y = 0; y < relief.ny; ++y)
      for (int x = 0; x < relief.nx; ++x) {
        if (!known(x, y)) continue;
        double sum = 0, n = 0;
        for (int k = -around; k <= around; ++k)
          if (const int i = along_x ? x + k : x, j = along_x ? y : y + k; known(i, j)) {
            sum += from[relief.index(i, j)];
            n += 1;
          }
        to[relief.index(x, y)] = sum / n;
      }
    return to;
  };
  relief.value = blurred(blurred(relief.value, true), false);
  ColumnMap top = relief;
  for (int y = 0; y < relief.ny; ++y)
    for (int x = 0; x < relief.nx; ++x) {
      if (!known(x, y)) continue;
      const auto slope = [&](int dx, int dy) {
        const bool on = known(x + dx, y + dy), back = known(x - dx, y - dy);
        if (!on && !back) return 0.0;
        const double high = relief.value[on ? relief.index(x + dx, y + dy) : relief.index(x, y)],
                     low = relief.value[back ? relief.index(x - dx, y - dy) : relief.index(x, y)];
        return (high - low) / ((on && back ? 2 : 1) * relief.leaf_mm);
      };
      const double sx = slope(1, 0), sy = slope(0, 1);
      top.value[top.index(x, y)] =
          std::min(relief.value[relief.index(x, y)], before.value[before.index(x, y)]) -
          reduction_mm * std::min(k_steepest, std::sqrt(1 + sx * sx + sy * sy));
    }
  return top;
}

FinishLine finish_line(const Tooth& tooth, const ShapeSpec& spec, const Landmarks& landmarks,
                       Vec3 middle, const DepthField& depth, const Message& where) {
  std::array<double, k_bearings> neck{};
  for (int i = 0; i < k_bearings; ++i)
    if (!line_height(landmarks.neck_mm, middle, way_of(4.0 * i / k_bearings),
                     neck[static_cast<std::size_t>(i)]))
      throw Error(where, msg("the neck of '{}' does not go round its long axis", tooth.name),
                  msg("look at `cavum tooth landmarks`"));
  FinishLine line;
  const Octree& tree = tooth.octree;
  const double step = 0.5 * tree.leaf_mm(), far = (tree.size().x + tree.size().y) * tree.leaf_mm();
  for (int i = 0; i < k_bearings; ++i) {
    double sum = 0;
    for (int k = -k_smooth_directions; k <= k_smooth_directions; ++k)
      sum += neck[static_cast<std::size_t>((i + k + k_bearings) % k_bearings)];
    const double z = sum / (2 * k_smooth_directions + 1) + spec.above_neck_mm;
    const Vec3 way = way_of(4.0 * i / k_bearings);
    const auto depth_at = [&](double r) {
      return depth.depth_mm({middle.x + way.x * r, middle.y + way.y * r, z});
    };
    double r = far;
    while (r > 0 && depth_at(r) < 0) r -= step;
    if (!(r > 0))
      throw Error(where, msg("the tooth '{}' ends below the finish line", tooth.name),
                  msg("make 'above_neck_mm' smaller"));
    const double inside = depth_at(r), outside = depth_at(r + step);
    line.z_mm[static_cast<std::size_t>(i)] = z;
    line.radius_mm[static_cast<std::size_t>(i)] =
        r + step * (inside > outside ? std::clamp(inside / (inside - outside), 0.0, 1.0) : 0.5);
  }
  return line;
}

}  // namespace

/// The stump stands along +z about the middle of the neck. Its finish line runs `above_neck_mm`
/// above the neck (its waves smoothed over 35 degrees) on the outer surface; from there a quarter
/// circle of radius `depth_mm` leads in (chamfer), then the wall leans inwards by `taper_deg`.
/// Everywhere it stays `depth_mm` below the outer surface, and under the occlusal surface (smoothed
/// over 0.5 mm) by `occlusal_mm` square to its slope. Throws Error when the tooth shows no neck, or
/// none of its surface at the finish line.
std::unique_ptr<Shape> body_crown(const ShapeSpec& spec, ShapeMaker& maker, const Message& where) {
  const Tooth& tooth = maker.own();
  const Landmarks& landmarks = maker.landmarks();
  if (landmarks.neck_mm.empty())
    throw Error(where, msg("no neck is found on '{}'", tooth.name),
                msg("look at `cavum tooth landmarks`, or draw the crown's surface as STL"));
  const Octree& tree = tooth.octree;
  Vec3 middle;
  for (const Vec3& p : landmarks.neck_mm)
    middle += p / static_cast<double>(landmarks.neck_mm.size());
  double lowest = landmarks.neck_mm.front().z;
  for (const Vec3& p : landmarks.neck_mm) lowest = std::min(lowest, p.z);
  const IVec3 from = tree.leaf_at({middle.x, middle.y, lowest - k_field_below_mm});
  DepthField depth(tooth, {0, 0, from.z}, tree.size(), maker.work());
  const FinishLine line = finish_line(tooth, spec, landmarks, middle, depth, where);
  ColumnMap top = stump_top(maker.surface(), spec.occlusal_mm);
  for (double& z : top.value)
    if (z == k_no_tooth_mm) z = k_out_mm;  // beside the crown the wall decides
  return std::make_unique<CrownShell>(spec, middle, line, std::move(top), std::move(depth));
}

}  // namespace cavum::scenarios
