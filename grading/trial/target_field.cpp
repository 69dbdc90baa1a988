#include "grading/trial/target_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cavum::grading {
namespace {

constexpr double k_beside_mm = 1.3,
                 k_below_mm =
                     0.6;  // of the lattice around the target; beyond, distances go on straight
constexpr double k_below_reach_mm = 8.0;

/// z along the way in, x as near to mesial as that allows; its origin a leaf's centre, so that
/// upright frames fall on the leaves.
scenarios::ShapeFrame frame_of(const scenarios::ZoneMap& zones) {
  const Vec3 z = normalized(zones.approach());
  const Vec3 x = normalized(Vec3{1, 0, 0} - z * z.x, {0, 1, 0});
  return {zones.centre_mm(zones.low()), x, cross(z, x), z};
}

double mix(double a, double b, double share) { return a + (b - a) * share; }

}  // namespace

TargetField::TargetField(const Tooth& tooth, const scenarios::ZoneMap& zones)
    : tooth_(tooth), zones_(zones), frame_(frame_of(zones)), leaf_mm_(zones.leaf_mm()) {
  read_leaves();
  lay_open();
  lay_floor();
}

void TargetField::read_leaves() {
  zones_.for_each_target_leaf([&](IVec3 leaf) {
    const Vec3 q = local(zones_.centre_mm(leaf));
    leaves_.push_back({q, tooth_.octree.tissue(leaf)});
    box_mm_.add(q);
  });
}

void TargetField::lay_open() {
  const auto down = [&](double mm) { return std::floor(mm / leaf_mm_ + 0.5) * leaf_mm_; };
  origin_ = {down(box_mm_.low.x - k_beside_mm), down(box_mm_.low.y - k_beside_mm),
             down(box_mm_.low.z - k_below_mm)};
  const auto cells = [&](double from, double to) {
    return static_cast<int>((to - from) / leaf_mm_) + 2;
  };
  nx_ = cells(origin_.x, box_mm_.high.x + k_beside_mm);
  ny_ = cells(origin_.y, box_mm_.high.y + k_beside_mm);
  nz_ = cells(origin_.z, box_mm_.high.z);
  const std::size_t layer = column(0, ny_);
  open_.resize(layer * static_cast<std::size_t>(nz_));
  std::size_t i = 0;
  for (int z = 0; z < nz_; ++z)
    for (int y = 0; y < ny_; ++y)
      for (int x = 0; x < nx_; ++x, ++i) {
        const auto here = static_cast<float>(target_mm(in_tooth(cell_mm(x, y, z))));
        open_[i] = z > 0 ? std::min(here, open_[i - layer]) : here;
      }
}

void TargetField::lay_floor() {
  floor_.assign(column(0, ny_), std::numeric_limits<float>::max());
  in_.assign(floor_.size(), 0);
  std::vector<float> top(floor_.size(), std::numeric_limits<float>::lowest());
  const auto cell = [&](double mm, double from, int n) {
    return std::clamp(static_cast<int>((mm - from) / leaf_mm_ + 0.5), 0, n - 1);
  };
  for (const auto& leaf : leaves_) {
    const std::size_t c = column(cell(leaf.at.x, origin_.x, nx_), cell(leaf.at.y, origin_.y, ny_));
    in_[c] = 1;
    floor_[c] = std::min(floor_[c], static_cast<float>(leaf.at.z - 0.5 * leaf_mm_));
    top[c] = std::max(top[c], static_cast<float>(leaf.at.z + 0.5 * leaf_mm_));
  }
  double sum = 0;
  std::size_t columns = 0;
  for (std::size_t c = 0; c < in_.size(); ++c)
    if (in_[c] != 0) {
      sum += static_cast<double>(top[c]);
      ++columns;
    }
  opening_mm_ = columns > 0 ? sum / static_cast<double>(columns) : box_mm_.high.z;
  mean_depth_mm_ =
      columns > 0 ? leaf_mm_ * static_cast<double>(leaves_.size()) / static_cast<double>(columns)
                  : 0.0;
  // outwards ring by ring: a column without a floor takes the mean of those beside it that have one
  std::vector<std::uint8_t> known = in_;
  for (bool more = columns > 0; more;) {
    more = false;
    std::vector<std::uint8_t> next = known;
    for (int y = 0; y < ny_; ++y)
      for (int x = 0; x < nx_; ++x) {
        if (known[column(x, y)] != 0) continue;
        double level = 0;
        int beside = 0;
        for (const auto& [dx, dy] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
          if (x + dx < 0 || y + dy < 0 || x + dx >= nx_ || y + dy >= ny_ ||
              known[column(x + dx, y + dy)] == 0)
            continue;
          level += static_cast<double>(floor_[column(x + dx, y + dy)]);
          ++beside;
        }
        if (beside == 0) continue;
        floor_[column(x, y)] = static_cast<float>(level / beside);
        next[column(x, y)] = 1;
        more = true;
      }
    known = std::move(next);
  }
}

double TargetField::open_mm(Vec3 q) const noexcept {
  const Vec3 c = (q - origin_) / leaf_mm_;
  const Vec3 in{std::clamp(c.x, 0.0, nx_ - 1.0), std::clamp(c.y, 0.0, ny_ - 1.0),
                std::clamp(c.z, 0.0, nz_ - 1.0)};
  const int x = std::min(static_cast<int>(in.x), nx_ - 2),
            y = std::min(static_cast<int>(in.y), ny_ - 2),
            z = std::min(static_cast<int>(in.z), nz_ - 2);
  const std::size_t row = static_cast<std::size_t>(nx_), layer = column(0, ny_),
                    at = static_cast<std::size_t>(z) * layer + column(x, y);
  const double fx = in.x - x, fy = in.y - y, fz = in.z - z;
  const auto along_x = [&](std::size_t i) {
    return mix(static_cast<double>(open_[i]), static_cast<double>(open_[i + 1]), fx);
  };
  const double d = mix(mix(along_x(at), along_x(at + row), fy),
                       mix(along_x(at + layer), along_x(at + layer + row), fy), fz);
  const Vec3 beyond{c.x - in.x, c.y - in.y, std::min(0.0, c.z - in.z)};  // above, it stays open
  return d + length(beyond) * leaf_mm_;
}

double TargetField::floor_mm(Vec3 q) const noexcept {
  const auto cell = [&](double mm, double from, int n) {
    return static_cast<int>(
        std::clamp((mm - from) / leaf_mm_ + 0.5, 0.0, static_cast<double>(n - 1)));
  };
  return static_cast<double>(floor_[column(cell(q.x, origin_.x, nx_), cell(q.y, origin_.y, ny_))]);
}

std::optional<TargetField::Below> TargetField::below(const std::string& tissue) const {
  std::uint8_t id = k_air;
  for (const auto& t : tooth_.tissues)
    if (t.name == tissue) id = t.id;
  std::optional<Below> best;
  if (id == k_air) return best;
  double nearest = k_below_reach_mm;
  for (int y = 0; y < ny_; y += 2)
    for (int x = 0; x < nx_; x += 2) {
      if (in_[column(x, y)] == 0) continue;
      const Vec3 floor{origin_.x + x * leaf_mm_, origin_.y + y * leaf_mm_,
                       static_cast<double>(floor_[column(x, y)])};
      for (double down = 0.5 * leaf_mm_; down < nearest; down += leaf_mm_) {
        const Vec3 at = floor - Vec3{0, 0, down};
        if (tooth_.octree.tissue_at(in_tooth(at)) != id) continue;
        nearest = down;
        best = Below{floor, at};
        break;
      }
    }
  return best;
}

}  // namespace cavum::grading
