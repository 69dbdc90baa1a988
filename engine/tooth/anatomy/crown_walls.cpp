#include "engine/tooth/anatomy/crown_walls.h"

#include <algorithm>
#include <array>

#include "engine/base/det_math.h"

namespace cavum {
namespace {

constexpr int k_n = CrownWalls::k_directions;
constexpr double k_other_mm = 0.3;  // of another tissue: thinner is a speck
constexpr double k_equal_mm = 0.02;
constexpr double k_jump_mm = 1.0;
constexpr int k_mean_rows = 4;  // to each side: the contour is no ripple

/// Sines and cosines of the directions.
constexpr std::array<SinCos, k_n> k_bearings = [] {
  std::array<SinCos, k_n> ways{};
  for (int i = 0; i < k_n; ++i) ways[static_cast<std::size_t>(i)] = det_sincos(2 * k_pi * i / k_n);
  return ways;
}();

double median_of(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v.empty() ? 0.0 : v[v.size() / 2];
}

}  // namespace

Vec3 CrownWalls::place(int row, int direction) const noexcept {
  const SinCos d = k_bearings[static_cast<std::size_t>(direction)];
  const double r = radius_mm[index(row, direction)];
  return {middle.x + r * d.cos, middle.y + r * d.sin, row_z(row)};
}

CrownWalls crown_walls(const Tooth& tooth, const CrownFrame& frame) {
  const Octree& tree = tooth.octree;
  CrownWalls walls;
  walls.middle = (frame.enamel_low + frame.enamel_high) * 0.5;
  walls.low_z = frame.enamel_low.z - 2.5;
  walls.rows = std::clamp(
      static_cast<int>((frame.enamel_high.z - walls.low_z) / CrownWalls::k_row_mm) + 1, 1, 400);
  walls.radius_mm.assign(static_cast<std::size_t>(walls.rows) * k_n, -1.0);
  walls.tissue.assign(walls.radius_mm.size(), k_air);
  const Vec3 half = (frame.enamel_high - frame.enamel_low) * 0.5;
  const double step = tree.leaf_mm(), far = length({half.x, half.y, 0}) + 2 * step;
  Octree::Cursor cursor;
  for (int row = 0; row < walls.rows; ++row)
    for (int d = 0; d < k_n; ++d) {
      const SinCos way = k_bearings[static_cast<std::size_t>(d)];
      const auto at = [&](double r) {
        return frame.to_tooth(
            {walls.middle.x + r * way.cos, walls.middle.y + r * way.sin, walls.row_z(row)});
      };
      for (double r = far; r > 0; r -= step) {
        const auto tissue = tree.tissue_at(at(r), cursor);
        if (!tree.is_solid(tissue)) continue;
        const double beyond = tree.sample(at(r + step), cursor).distance_mm,
                     here = tree.sample(at(r), cursor).distance_mm;
        const double share = beyond > here ? std::clamp(-here / (beyond - here), 0.0, 1.0) : 0.5;
        walls.radius_mm[walls.index(row, d)] = r + share * step;
        walls.tissue[walls.index(row, d)] = tissue;
        break;
      }
    }
  return walls;
}

std::vector<int> contour_rows(const CrownWalls& walls, const TissueIds& ids) {
  std::vector<int> rows(k_n, -1);
  for (int d = 0; d < k_n; ++d) {
    const auto is_enamel = [&](int r) {
      return r >= 0 && r < walls.rows && walls.tissue[walls.index(r, d)] == ids.enamel;
    };
    std::vector<double> wide(static_cast<std::size_t>(walls.rows), -1.0);
    double widest = -1.0;
    for (int r = 0; r < walls.rows; ++r) {
      if (!is_enamel(r)) continue;
      double sum = 0, weight = 0;
      for (int k = -k_mean_rows; k <= k_mean_rows; ++k)
        if (is_enamel(r + k)) {
          const int w = k_mean_rows + 1 - (k < 0 ? -k : k);
          sum += w * walls.radius_mm[walls.index(r + k, d)];
          weight += w;
        }
      wide[static_cast<std::size_t>(r)] = sum / weight;
      widest = std::max(widest, sum / weight);
    }
    int sum = 0, n = 0;
    for (int r = 0; r < walls.rows; ++r)
      if (wide[static_cast<std::size_t>(r)] > widest - k_equal_mm &&
          wide[static_cast<std::size_t>(r)] > 0) {
        sum += r;
        ++n;
      }
    if (n > 0) rows[static_cast<std::size_t>(d)] = (2 * sum + n) / (2 * n);
  }
  // the median of five directions: one that jumps is a ripple
  const auto found = rows;
  for (int d = 0; d < k_n; ++d) {
    std::array<int, 5> near{};
    for (int k = 0; k < 5; ++k)
      near[static_cast<std::size_t>(k)] = found[static_cast<std::size_t>((d + k - 2 + k_n) % k_n)];
    std::sort(near.begin(), near.end());
    if (near[0] < 0) continue;
    if (const int row = near[2]; walls.radius_mm[walls.index(row, d)] >= 0)
      rows[static_cast<std::size_t>(d)] = row;
  }
  return rows;
}

std::vector<Vec3> neck_line(const CrownWalls& walls, const std::vector<int>& contour,
                            const TissueIds& ids) {
  const int gap = static_cast<int>(k_other_mm / CrownWalls::k_row_mm + 0.5);
  std::vector<int> row(k_n, -1);
  for (int d = 0; d < k_n; ++d) {
    int last = -1, other = 0;
    for (int r = contour[static_cast<std::size_t>(d)]; r >= 0; --r) {
      const auto t = walls.tissue[walls.index(r, d)];
      if (t == ids.enamel) {
        last = r;
        other = 0;
      } else if (++other >= gap) {
        row[static_cast<std::size_t>(d)] = last;
        break;
      }
    }
  }
  // a place far from what lies 15 degrees to both sides is a fault of the layer, not the neck
  const auto sound = row;
  for (int d = 0; d < k_n; ++d) {
    std::vector<double> near;
    for (int k = -3; k <= 3; ++k)
      if (const int r = sound[static_cast<std::size_t>((d + k + k_n) % k_n)]; k != 0 && r >= 0)
        near.push_back(walls.row_z(r));
    auto& own = row[static_cast<std::size_t>(d)];
    if (own < 0 || near.size() < 3) {
      own = -1;
      continue;
    }
    const double off = walls.row_z(own) - median_of(near);
    if (off > k_jump_mm || off < -k_jump_mm) own = -1;
  }
  const auto missing = std::count(row.begin(), row.end(), -1);
  std::vector<Vec3> line;
  if (missing * 4 > k_n) return line;
  for (int d = 0; d < k_n; ++d) {
    if (row[static_cast<std::size_t>(d)] >= 0) {
      Vec3 p = walls.place(row[static_cast<std::size_t>(d)], d);
      p.z -= 0.5 * CrownWalls::k_row_mm;  // enamel ends between this row and the next
      line.push_back(p);
      continue;
    }
    int back = 1, on = 1;
    while (row[static_cast<std::size_t>((d - back + k_n) % k_n)] < 0) ++back;
    while (row[static_cast<std::size_t>((d + on) % k_n)] < 0) ++on;
    const int from = (d - back + k_n) % k_n, to = (d + on) % k_n;
    const Vec3 a = walls.place(row[static_cast<std::size_t>(from)], from),
               b = walls.place(row[static_cast<std::size_t>(to)], to);
    line.push_back(a + (b - a) * (static_cast<double>(back) / (back + on)));
  }
  return line;
}

}  // namespace cavum
