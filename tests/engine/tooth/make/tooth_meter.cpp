#include "tests/engine/tooth/make/tooth_meter.h"

#include <algorithm>
#include <cmath>

#include "engine/base/det_math.h"

namespace cavum::testing_tooth {

ToothMeter::ToothMeter(const Tooth& tooth)
    : octree_(tooth.octree), grid_(tooth.octree.to_grid()), low_(grid_.size), high_{-1, -1, -1} {
  for (std::int32_t z = 0; z < grid_.size.z; ++z)
    for (std::int32_t y = 0; y < grid_.size.y; ++y)
      for (std::int32_t x = 0; x < grid_.size.x; ++x) {
        if (!hard({x, y, z})) continue;
        low_ = {std::min(low_.x, x), std::min(low_.y, y), std::min(low_.z, z)};
        high_ = {std::max(high_.x, x), std::max(high_.y, y), std::max(high_.z, z)};
      }
}

double ToothMeter::surface_z(double x, double y) const {
  Octree::Cursor cursor;
  const double step = 0.5 * grid_.leaf_mm, top = grid_.centre_mm(high_).z + 2 * grid_.leaf_mm;
  const auto column_leaf = octree_.leaf_at({x, y, top});
  if (!grid_.inside({column_leaf.x, column_leaf.y, 0})) return -1e9;
  double above = 1.0;
  for (double z = top; z > grid_.origin_mm.z; z -= step) {
    const double d = octree_.sample({x, y, z}, cursor).distance_mm;
    if (d < 0) return z + step * d / (d - above);  // between this height and the one above
    above = d;
  }
  return -1e9;
}

Vec3 ToothMeter::highest(double low_x, double high_x, double low_y, double high_y) const {
  Vec3 best{0, 0, -1e9};
  for (double y = low_y; y <= high_y; y += 0.1)
    for (double x = low_x; x <= high_x; x += 0.1) {
      const double z = surface_z(x, y);
      if (z > best.z) best = {x, y, z};
    }
  return best;
}

double ToothMeter::cervical_z(char towards, double sign) const {
  for (std::int32_t z = low_.z; z <= high_.z; ++z)
    for (std::int32_t y = low_.y; y <= high_.y; ++y)
      for (std::int32_t x = low_.x; x <= high_.x; ++x) {
        if (grid_.tissue[grid_.index({x, y, z})] != k_enamel) continue;
        const Vec3 p = grid_.centre_mm({x, y, z});
        const double out = towards == 'x' ? p.x : p.y, across = towards == 'x' ? p.y : p.x;
        if (out * sign > 0 && std::fabs(across) < 0.5) return p.z - 0.5 * grid_.leaf_mm;
      }
  return 0.0;
}

std::pair<double, double> ToothMeter::outermost(char towards, double sign, double from_z,
                                                double to_z, double at, double within) const {
  std::pair<double, double> best{-1e9, 0.0};
  double sum = 0.0;
  int many = 0;
  for (std::int32_t z = low_.z; z <= high_.z; ++z)
    for (std::int32_t y = low_.y; y <= high_.y; ++y)
      for (std::int32_t x = low_.x; x <= high_.x; ++x) {
        const Vec3 p = grid_.centre_mm({x, y, z});
        if (p.z < from_z || p.z > to_z || !hard({x, y, z})) continue;
        const double out = (towards == 'x' ? p.x : p.y) * sign + 0.5 * grid_.leaf_mm,
                     across = towards == 'x' ? p.y : p.x;
        if (std::fabs(across - at) > within || out < best.first - 1e-9) continue;
        if (out > best.first + 1e-9) sum = 0.0, many = 0;
        best.first = std::max(best.first, out);
        sum += p.z;
        ++many;
      }
  best.second = many > 0 ? sum / many : 0.0;
  return best;
}

double ToothMeter::nearest(Vec3 from, std::uint8_t tissue) const {
  const IVec3 middle = octree_.leaf_at(from);
  const int most = static_cast<int>(9.0 / grid_.leaf_mm);
  double best = 1e9;
  // Shells of leaves around the place, until none nearer can come.
  for (int r = 0; r <= most && (r - 1) * grid_.leaf_mm < best; ++r)
    for (int z = -r; z <= r; ++z)
      for (int y = -r; y <= r; ++y) {
        const bool face = std::abs(z) == r || std::abs(y) == r;
        for (int x = -r; x <= r; x += face || r == 0 ? 1 : 2 * r) {
          const IVec3 at = middle + IVec3{x, y, z};
          if (grid_.inside(at) && grid_.tissue[grid_.index(at)] == tissue)
            best = std::min(best, length(grid_.centre_mm(at) - from));
        }
      }
  return best -
         0.5 * grid_.leaf_mm;  // the tissue begins half a leaf before its first leaf's centre
}

double ToothMeter::enamel_mm(Vec3 surface) const { return nearest(surface, k_dentin); }
double ToothMeter::to_pulp_mm(Vec3 from) const { return nearest(from, k_pulp); }

double ToothMeter::wall_enamel_mm(char towards, double sign, double z, double at) const {
  const double leaf = grid_.leaf_mm;
  const double out = outermost(towards, sign, z - 0.6 * leaf, z + 0.6 * leaf, at, 0.6 * leaf).first;
  return nearest(towards == 'x' ? Vec3{sign * out, at, z} : Vec3{at, sign * out, z}, k_dentin);
}

double ToothMeter::horn_to_enamel_mm(double x, double y) const {
  for (std::int32_t z = high_.z; z >= low_.z; --z)
    for (std::int32_t j = low_.y; j <= high_.y; ++j)
      for (std::int32_t i = low_.x; i <= high_.x; ++i) {
        const Vec3 p = grid_.centre_mm({i, j, z});
        if (grid_.tissue[grid_.index({i, j, z})] == k_pulp && std::fabs(p.x - x) < 1.5 &&
            std::fabs(p.y - y) < 1.5)
          return nearest(p + Vec3{0, 0, 0.5 * grid_.leaf_mm}, k_enamel);
      }
  return -1.0;
}

std::vector<std::pair<std::uint8_t, double>> ToothMeter::column(double x, double y) const {
  std::vector<std::pair<std::uint8_t, double>> found;
  for (double z = grid_.centre_mm(high_).z + grid_.leaf_mm; z > grid_.origin_mm.z; z -= 0.02) {
    const auto t = octree_.tissue_at({x, y, z});
    if (found.empty() || found.back().first != t) found.emplace_back(t, z);
  }
  return found;
}

std::vector<CanalSlice> ToothMeter::canals(double z) const {
  const std::int32_t level = octree_.leaf_at({0, 0, z}).z;
  std::vector<std::uint8_t> seen(static_cast<std::size_t>(grid_.size.x) *
                                 static_cast<std::size_t>(grid_.size.y));
  std::vector<CanalSlice> found;
  for (std::int32_t j = low_.y; j <= high_.y; ++j)
    for (std::int32_t i = low_.x; i <= high_.x; ++i) {
      std::vector<IVec3> body;
      const auto enter = [&](IVec3 at) {
        const auto flat = static_cast<std::size_t>(at.y) * static_cast<std::size_t>(grid_.size.x) +
                          static_cast<std::size_t>(at.x);
        if (!grid_.inside(at) || seen[flat] || grid_.tissue[grid_.index(at)] != k_pulp) return;
        seen[flat] = 1;
        body.push_back(at);
      };
      enter({i, j, level});
      for (std::size_t n = 0; n < body.size(); ++n) {
        const IVec3 at = body[n];
        for (const IVec3 s : {IVec3{1, 0, 0}, IVec3{-1, 0, 0}, IVec3{0, 1, 0}, IVec3{0, -1, 0}})
          enter(at + s);
      }
      if (body.size() < 3) continue;
      Vec3 low{1e9, 1e9, 0}, high{-1e9, -1e9, 0}, sum;
      for (const IVec3 at : body) {
        const Vec3 p = grid_.centre_mm(at);
        low = {std::min(low.x, p.x), std::min(low.y, p.y), 0};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), 0};
        sum = sum + p;
      }
      const double n = static_cast<double>(body.size());
      found.push_back(
          {sum.x / n, sum.y / n, high.x - low.x + grid_.leaf_mm, high.y - low.y + grid_.leaf_mm});
    }
  std::sort(found.begin(), found.end(),
            [](const CanalSlice& a, const CanalSlice& b) { return a.x_mm < b.x_mm; });
  return found;
}

double ToothMeter::to_outside_mm(const CanalSlice& canal, double z) const {
  double x = canal.x_mm;
  while (octree_.tissue_at({x, canal.y_mm, z}) == k_pulp) x -= 0.01;
  const double border = x;
  while (octree_.tissue_at({x, canal.y_mm, z}) == k_dentin) x -= 0.01;
  return border - x;
}

double ToothMeter::apex_z(double low_x, double high_x) const {
  for (std::int32_t z = low_.z; z <= high_.z; ++z)
    for (std::int32_t y = low_.y; y <= high_.y; ++y)
      for (std::int32_t x = low_.x; x <= high_.x; ++x) {
        const Vec3 p = grid_.centre_mm({x, y, z});
        if (p.x > low_x && p.x < high_x && hard({x, y, z})) return p.z - 0.5 * grid_.leaf_mm;
      }
  return 0.0;
}

ToothMeter::Valley ToothMeter::valley(double x, double low_y, double high_y) const {
  Valley v{180.0, 0.0, 0.0, 1e9};
  for (double y = low_y; y <= high_y; y += 0.02) {
    const double z = surface_z(x, y);
    if (z < v.z_mm) v.y_mm = y, v.z_mm = z;
  }
  const double left = (surface_z(x, v.y_mm - 0.25) - v.z_mm) / 0.25,
               right = (surface_z(x, v.y_mm + 0.25) - v.z_mm) / 0.25;
  v.angle_deg = 180.0 - (std::atan(left) + std::atan(right)) * 180.0 / k_pi;
  v.depth_mm = 0.5 * (surface_z(x, v.y_mm - 0.5) + surface_z(x, v.y_mm + 0.5)) - v.z_mm;
  return v;
}

}  // namespace cavum::testing_tooth
