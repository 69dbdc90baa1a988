#include "engine/tooth/anatomy/height_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace cavum {
namespace {

constexpr std::array<std::array<int, 2>, 8> k_around{
    {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}}};

/// Prominences by joining cells from the highest down: where two hills meet, the lower one ends.
class Hills {
 public:
  explicit Hills(std::size_t cells) : parent_(cells, -1), saddle_(cells, -1) {}
  [[nodiscard]] bool known(int c) const { return parent_[static_cast<std::size_t>(c)] >= 0; }
  void begin(int c) { parent_[static_cast<std::size_t>(c)] = c; }
  int top_of(int c) {
    while (parent_[static_cast<std::size_t>(c)] != c) {
      int& p = parent_[static_cast<std::size_t>(c)];
      p = parent_[static_cast<std::size_t>(p)];
      c = p;
    }
    return c;
  }
  void join(int lower, int higher, int saddle) {
    parent_[static_cast<std::size_t>(lower)] = higher;
    saddle_[static_cast<std::size_t>(lower)] = saddle;
  }
  [[nodiscard]] int saddle(int c) const { return saddle_[static_cast<std::size_t>(c)]; }

 private:
  std::vector<int> parent_, saddle_;
};

std::vector<Peak> peaks_of(const HeightMap& map, const std::vector<double>& z,
                           const std::vector<std::uint8_t>& on, double least) {
  std::vector<int> order;
  for (int c = 0; c < map.count(); ++c)
    if (on[static_cast<std::size_t>(c)] != 0) order.push_back(c);
  if (order.empty()) return {};
  const auto height = [&](int c) { return z[static_cast<std::size_t>(c)]; };
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return height(a) != height(b) ? height(a) > height(b) : a < b; });
  Hills hills(z.size());
  std::vector<int> tops;
  for (const int c : order) {
    const int x = c % map.nx, y = c / map.nx;
    int own = -1;
    for (const auto& [dx, dy] : k_around) {
      if (x + dx < 0 || y + dy < 0 || x + dx >= map.nx || y + dy >= map.ny) continue;
      const int n = map.index(x + dx, y + dy);
      if (!hills.known(n)) continue;
      const int top = hills.top_of(n);
      if (own < 0) {
        own = top;
        continue;
      }
      if (top == own) continue;
      const bool own_is_higher = height(own) != height(top) ? height(own) > height(top) : own < top;
      hills.join(own_is_higher ? top : own, own_is_higher ? own : top, c);
      if (!own_is_higher) own = top;
    }
    if (own < 0) {
      tops.push_back(c);
      hills.begin(c);
    } else {
      hills.begin(c);
      hills.join(c, own, -1);
    }
  }
  std::vector<Peak> peaks;
  for (const int t : tops) {
    const int saddle = hills.saddle(t);
    const double prominence = height(t) - (saddle >= 0 ? height(saddle) : height(order.back()));
    if (prominence >= least) peaks.push_back({t, prominence, saddle});
  }
  return peaks;
}

}  // namespace

double HeightMap::height(double x_mm, double y_mm) const noexcept {
  const double px = std::clamp((x_mm - low_x) / k_cell_mm, 0.0, nx - 1.0),
               py = std::clamp((y_mm - low_y) / k_cell_mm, 0.0, ny - 1.0);
  const int x = std::min(static_cast<int>(px), std::max(0, nx - 2)),
            y = std::min(static_cast<int>(py), std::max(0, ny - 2));
  const int x1 = std::min(x + 1, nx - 1), y1 = std::min(y + 1, ny - 1);
  const double fx = px - x, fy = py - y;
  const double low = at(index(x, y)) * (1 - fx) + at(index(x1, y)) * fx,
               high = at(index(x, y1)) * (1 - fx) + at(index(x1, y1)) * fx;
  return low * (1 - fy) + high * fy;
}

int HeightMap::cell_at(double x_mm, double y_mm) const noexcept {
  const auto near = [](double v, int n) { return std::clamp(static_cast<int>(v + 0.5), 0, n - 1); };
  return index(near(std::max(0.0, (x_mm - low_x) / k_cell_mm), nx),
               near(std::max(0.0, (y_mm - low_y) / k_cell_mm), ny));
}

HeightMap HeightMap::smoothed(double sigma_mm) const {
  // one pass of 1-2-1 along both axes has a variance of half a cell squared
  const int passes = static_cast<int>(2 * sigma_mm * sigma_mm / (k_cell_mm * k_cell_mm) + 0.5);
  HeightMap out = *this;
  std::vector<double> weight(z.size()), value(z.size()), w2(z.size()), v2(z.size());
  for (std::size_t i = 0; i < z.size(); ++i) {
    weight[i] = on[i];
    value[i] = on[i] != 0 ? z[i] : 0.0;
  }
  const auto pass = [&](const std::vector<double>& from, std::vector<double>& to, int step,
                        int along, int length) {
    for (int i = 0; i < count(); ++i) {
      const int p = i / along % length;
      const double before = p > 0 ? from[static_cast<std::size_t>(i - step)] : 0.0,
                   after = p + 1 < length ? from[static_cast<std::size_t>(i + step)] : 0.0;
      to[static_cast<std::size_t>(i)] =
          0.25 * before + 0.5 * from[static_cast<std::size_t>(i)] + 0.25 * after;
    }
  };
  for (int p = 0; p < passes; ++p) {
    pass(weight, w2, 1, 1, nx);
    pass(value, v2, 1, 1, nx);
    pass(w2, weight, nx, nx, ny);
    pass(v2, value, nx, nx, ny);
  }
  for (std::size_t i = 0; i < z.size(); ++i)
    if (on[i] != 0) out.z[i] = value[i] / weight[i];
  return out;
}

HeightMap crown_heights(const Tooth& tooth, const CrownFrame& frame) {
  constexpr double k_cell = HeightMap::k_cell_mm;
  const Octree& tree = tooth.octree;
  HeightMap map;
  const auto cells = [](double low, double high) {
    return std::clamp(static_cast<int>((high - low) / k_cell) + 3, 1, 400);
  };
  map.nx = cells(frame.enamel_low.x, frame.enamel_high.x);
  map.ny = cells(frame.enamel_low.y, frame.enamel_high.y);
  map.low_x = 0.5 * (frame.enamel_low.x + frame.enamel_high.x) - 0.5 * k_cell * (map.nx - 1);
  map.low_y = 0.5 * (frame.enamel_low.y + frame.enamel_high.y) - 0.5 * k_cell * (map.ny - 1);
  map.z.assign(static_cast<std::size_t>(map.count()), frame.enamel_low.z);
  map.on.assign(map.z.size(), 0);
  const double step = tree.leaf_mm(), top = frame.solid_high.z + step;
  Octree::Cursor cursor;
  for (int y = 0; y < map.ny; ++y)
    for (int x = 0; x < map.nx; ++x) {
      const double px = map.low_x + x * k_cell, py = map.low_y + y * k_cell;
      for (double h = top; h > frame.enamel_low.z; h -= step) {
        if (!tree.is_solid(tree.tissue_at(frame.to_tooth({px, py, h}), cursor))) continue;
        // between the place above, outside, and this one, inside, where the distance is zero
        const double above = tree.sample(frame.to_tooth({px, py, h + step}), cursor).distance_mm;
        const double here = tree.sample(frame.to_tooth({px, py, h}), cursor).distance_mm;
        const double share = above > here ? std::clamp(-here / (above - here), 0.0, 1.0) : 0.5;
        const auto i = static_cast<std::size_t>(map.index(x, y));
        map.z[i] = h + share * step;
        map.on[i] = 1;
        break;
      }
    }
  return map;
}

std::vector<Peak> find_peaks(const HeightMap& map, double least_prominence_mm) {
  return peaks_of(map, map.z, map.on, least_prominence_mm);
}

std::vector<Peak> find_hollows(const HeightMap& map, double least_depth_mm) {
  // off the crown is the deepest hollow of all: what drains there is none
  std::vector<double> z(map.z.size());
  const std::vector<std::uint8_t> all(z.size(), 1);
  for (std::size_t i = 0; i < z.size(); ++i) z[i] = map.on[i] != 0 ? -map.z[i] : 1e3;
  auto hollows = peaks_of(map, z, all, least_depth_mm);
  std::erase_if(hollows,
                [&](const Peak& p) { return map.on[static_cast<std::size_t>(p.cell)] == 0; });
  return hollows;
}

Vec3 refined_peak(const HeightMap& map, int cell) {
  const int x = cell % map.nx, y = cell / map.nx;
  Vec3 p = map.place(cell);
  const auto shift = [](double before, double here, double after) {
    const double bend = before - 2 * here + after;
    return bend != 0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0.0;
  };
  if (map.is_on(x - 1, y) && map.is_on(x + 1, y))
    p.x += HeightMap::k_cell_mm * shift(map.at(cell - 1), map.at(cell), map.at(cell + 1));
  if (map.is_on(x, y - 1) && map.is_on(x, y + 1))
    p.y += HeightMap::k_cell_mm * shift(map.at(cell - map.nx), map.at(cell), map.at(cell + map.nx));
  return p;
}

Curvatures curvatures(const HeightMap& map) {
  Curvatures out{std::vector<double>(map.z.size(), 0.0), std::vector<double>(map.z.size(), 0.0)};
  constexpr double k_per = 1.0 / (HeightMap::k_cell_mm * HeightMap::k_cell_mm);
  for (int y = 1; y + 1 < map.ny; ++y)
    for (int x = 1; x + 1 < map.nx; ++x) {
      bool inside = true;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) inside = inside && map.is_on(x + dx, y + dy);
      if (!inside) continue;
      const int c = map.index(x, y), n = map.nx;
      const double xx = (map.at(c + 1) - 2 * map.at(c) + map.at(c - 1)) * k_per,
                   yy = (map.at(c + n) - 2 * map.at(c) + map.at(c - n)) * k_per;
      const double xy =
          0.25 * (map.at(c + n + 1) - map.at(c + n - 1) - map.at(c - n + 1) + map.at(c - n - 1)) *
          k_per;
      const double half = 0.5 * (xx - yy), apart = std::sqrt(half * half + xy * xy);
      out.larger[static_cast<std::size_t>(c)] = 0.5 * (xx + yy) + apart;
      out.smaller[static_cast<std::size_t>(c)] = 0.5 * (xx + yy) - apart;
    }
  return out;
}

}  // namespace cavum
