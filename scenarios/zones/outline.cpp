#include "scenarios/zones/outline.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/tooth/distance_transform.h"

namespace cavum::scenarios {
namespace {

class Circle final : public Outline {
 public:
  Circle(Vec3 centre, double radius) : centre_(centre), radius_(radius) {}
  double distance_mm(double x, double y) const noexcept override {
    return length({x - centre_.x, y - centre_.y, 0}) - radius_;
  }

 private:
  Vec3 centre_;
  double radius_;
};

class Stroke final : public Outline {
 public:
  Stroke(std::vector<std::vector<Vec3>> paths, double half)
      : paths_(std::move(paths)), half_(half) {}
  double distance_mm(double x, double y) const noexcept override {
    double d = 1e300;
    for (const auto& path : paths_)
      for (std::size_t i = 0; i + 1 < path.size(); ++i)
        d = std::min(d, segment_distance({x, y, 0}, path[i], path[i + 1]));
    return d - half_;
  }
  std::uint64_t pieces() const noexcept override {
    std::uint64_t sum = 0;
    for (const auto& path : paths_) sum += path.size();
    return sum;
  }

 private:
  std::vector<std::vector<Vec3>> paths_;
  double half_;
};

class Polygon final : public Outline {
 public:
  Polygon(std::vector<Vec3> corners, double offset)
      : corner_(std::move(corners)), offset_(offset) {}
  double distance_mm(double x, double y) const noexcept override {
    double d = 1e300;
    bool inside = false;
    for (std::size_t i = 0, j = corner_.size() - 1; i < corner_.size(); j = i++) {
      const Vec3 a = corner_[j], b = corner_[i];
      d = std::min(d, segment_distance({x, y, 0}, a, b));
      if ((a.y > y) != (b.y > y) && x < (b.x - a.x) * (y - a.y) / (b.y - a.y) + a.x)
        inside = !inside;
    }
    return (inside ? -d : d) - offset_;
  }
  std::uint64_t pieces() const noexcept override { return corner_.size(); }

 private:
  std::vector<Vec3> corner_;
  double offset_;
};

/// The shadow of a tissue, moved outwards and rounded so that a bur of that radius reaches all of
/// it.
class Shadow final : public Outline {
 public:
  Shadow(const TissueRelief& relief, double offset, double rounding) {
    const int pad =
        static_cast<int>((std::fabs(offset) + rounding + 0.2) / relief.roof_mm.leaf_mm) + 2;
    map_ = distance_to_edge(relief.roof_mm, relief.shadow, pad);
    move(offset);
    if (rounding > 0) {
      redistance(rounding);  // grow ...
      redistance(
          -rounding);  // ... and shrink closes notches; the other way round takes off thin tips
      redistance(-rounding);
      redistance(rounding);
    }
    map_.smooth(2);
  }
  double distance_mm(double x, double y) const noexcept override {
    const double x1 = map_.origin_mm.x + map_.nx * map_.leaf_mm,
                 y1 = map_.origin_mm.y + map_.ny * map_.leaf_mm;
    const double dx = std::max({map_.origin_mm.x - x, 0.0, x - x1}),
                 dy = std::max({map_.origin_mm.y - y, 0.0, y - y1});
    return map_.at(x, y) + std::sqrt(dx * dx + dy * dy);
  }

 private:
  void move(double outwards) {
    for (double& v : map_.value) v -= outwards;
  }
  void redistance(double outwards) {
    move(outwards);
    std::vector<std::uint8_t> in;
    for (const double v : map_.value) in.push_back(v < 0 ? 1 : 0);
    // keeps the sub-leaf place of the edge: what the distance of the nearest cell across it says
    const ColumnMap before = map_;
    std::vector<std::uint8_t> out;
    for (const auto i : in) out.push_back(i == 0 ? 1 : 0);
    const auto to_in = nearest_seed({map_.nx, map_.ny, 1}, in),
               to_out = nearest_seed({map_.nx, map_.ny, 1}, out);
    for (int y = 0; y < map_.ny; ++y)
      for (int x = 0; x < map_.nx; ++x) {
        const auto i = map_.index(x, y);
        const auto other = in[i] != 0 ? to_out[i] : to_in[i];
        if (other < 0) continue;
        const double dx = other % map_.nx - x, dy = other / map_.nx - y;
        const double d =
            std::sqrt(dx * dx + dy * dy) * map_.leaf_mm -
            std::min(std::fabs(before.value[static_cast<std::size_t>(other)]), map_.leaf_mm);
        map_.value[i] = in[i] != 0 ? -std::max(d, 0.0) : std::max(d, 0.0);
        if (std::fabs(before.value[i]) < 1.5 * map_.leaf_mm) map_.value[i] = before.value[i];
      }
  }
  ColumnMap map_;
};

}  // namespace

double segment_distance(Vec3 p, Vec3 a, Vec3 b) noexcept {
  const Vec3 along = b - a;
  const double n = dot(along, along);
  const double t = n > 0 ? std::clamp(dot(p - a, along) / n, 0.0, 1.0) : 0.0;
  return length(p - a - along * t);
}

std::unique_ptr<Outline> make_outline(const OutlineSpec& spec, Vec3 centre,
                                      const TissueRelief* shadow) {
  std::vector<Vec3> points = spec.points_mm;
  for (auto& p : points) p += Vec3{centre.x, centre.y, 0};
  switch (spec.kind) {
    case OutlineSpec::Kind::circle:
      return std::make_unique<Circle>(centre, spec.radius_mm + spec.offset_mm);
    case OutlineSpec::Kind::stroke:
      return std::make_unique<Stroke>(std::vector<std::vector<Vec3>>{std::move(points)},
                                      0.5 * spec.width_mm + spec.offset_mm);
    case OutlineSpec::Kind::fissure:
      return std::make_unique<Stroke>(spec.paths_mm, 0.5 * spec.width_mm + spec.offset_mm);
    case OutlineSpec::Kind::polygon:
      return std::make_unique<Polygon>(std::move(points), spec.offset_mm);
    case OutlineSpec::Kind::projection:
      break;
  }
  return std::make_unique<Shadow>(*shadow, spec.offset_mm, spec.rounding_mm);
}

}  // namespace cavum::scenarios
