#include "engine/tooth/anatomy/groove.h"

#include <algorithm>
#include <cmath>

#include "engine/tooth/anatomy/occlusal_table.h"

namespace cavum {
namespace {

constexpr double k_end_mm = 0.3;       // of the crown's length at each end: there a way begins
constexpr double k_side_slope = 0.15;  // a steeper climb is the side, not the crest
constexpr double k_rounded_mm =
    0.8;  // the highest place of a ridge lies at most so far inside of that
constexpr double k_slope_over_mm = 0.4;   // slopes are measured over this
constexpr double k_min_share = 0.4;       // of half the crown's length: a ridge lies beyond
constexpr double k_between_share = 0.25;  // nearer to the middle the groove has both sides above it
constexpr double k_side_reach_mm = 3.5;   // how far across the groove its sides are looked at
constexpr double k_side_mm = 0.1,
                 k_min_side_mm = 0.03;     // so much both sides stand above it, mostly and at least
constexpr std::size_t k_smooth_cells = 2;  // to both sides, along the way

struct Reach {
  double low = 1e9, high = -1e9;
  void add(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
  [[nodiscard]] double middle() const { return 0.5 * (low + high); }
  [[nodiscard]] double half() const { return 0.5 * (high - low); }
};

/// Heights and lengths along a way, mm.
struct GrooveProfile {
  std::vector<double> z, s;
};
GrooveProfile profile_of(const HeightMap& map, const std::vector<int>& way) {
  GrooveProfile p;
  for (std::size_t i = 0; i < way.size(); ++i) {
    double sum = 0;
    const std::size_t from = i >= k_smooth_cells ? i - k_smooth_cells : 0,
                      to = std::min(i + k_smooth_cells, way.size() - 1);
    for (std::size_t k = from; k <= to; ++k) sum += map.at(way[k]);
    p.z.push_back(sum / static_cast<double>(to - from + 1));
    const Vec3 step = i == 0 ? Vec3{} : map.place(way[i]) - map.place(way[i - 1]);
    p.s.push_back(i == 0 ? 0.0 : p.s.back() + length({step.x, step.y, 0}));
  }
  return p;
}

/// From the way's first place inwards: where it no longer climbs the side, and from there the
/// highest place of a ridge.
std::optional<GrooveEnd> end_of(const GrooveProfile& p) {
  std::size_t behind = 0, ahead = 0;
  for (std::size_t i = 0; i < p.z.size(); ++i) {
    while (p.s[i] - p.s[behind] > 0.5 * k_slope_over_mm) ++behind;
    while (ahead + 1 < p.s.size() && p.s[ahead] - p.s[i] < 0.5 * k_slope_over_mm) ++ahead;
    if (p.s[i] < 0.5 * k_slope_over_mm ||
        p.z[ahead] - p.z[behind] > k_side_slope * (p.s[ahead] - p.s[behind]))
      continue;
    std::size_t top = i, last = i;
    for (std::size_t m = i; m < p.s.size() && p.s[m] - p.s[i] <= k_rounded_mm; ++m) {
      last = m;
      if (p.z[m] > p.z[top]) top = m;
    }
    return top < last ? GrooveEnd{top, true} : GrooveEnd{i, false};
  }
  return std::nullopt;
}

/// How much the lower of a place's two sides stands above it, mm: the highest within reach towards
/// +y and -y.
double side_height(const HeightMap& map, int cell) {
  const int x = cell % map.nx, y = cell / map.nx,
            reach = static_cast<int>(k_side_reach_mm / HeightMap::k_cell_mm);
  double up = map.at(cell), down = up;
  for (int k = 1; k <= reach; ++k) {
    if (map.is_on(x, y + k)) up = std::max(up, map.at(map.index(x, y + k)));
    if (map.is_on(x, y - k)) down = std::max(down, map.at(map.index(x, y - k)));
  }
  return std::min(up, down) - map.at(cell);
}

double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v.empty() ? 0.0 : v[v.size() / 2];
}

}  // namespace

std::vector<double> surface_curvature(const HeightMap& map) {
  auto bend = curvatures(map).larger;
  for (int y = 1; y + 1 < map.ny; ++y)
    for (int x = 1; x + 1 < map.nx; ++x) {
      const int c = map.index(x, y);
      const double gx = (map.at(c + 1) - map.at(c - 1)) / (2 * HeightMap::k_cell_mm),
                   gy = (map.at(c + map.nx) - map.at(c - map.nx)) / (2 * HeightMap::k_cell_mm);
      const double steep = 1 + gx * gx + gy * gy;
      bend[static_cast<std::size_t>(c)] /= steep * std::sqrt(steep);
    }
  return bend;
}

std::optional<Groove> find_groove(const HeightMap& map, double least_z, double least_per_mm) {
  std::vector<std::uint8_t> allowed(map.z.size(), 0);
  Reach x;
  for (int c = 0; c < map.count(); ++c) {
    const auto i = static_cast<std::size_t>(c);
    allowed[i] = map.on[i] != 0 && map.at(c) > least_z;
    if (allowed[i] != 0) x.add(map.place(c).x);
  }
  std::vector<int> mesial, distal;
  for (int c = 0; c < map.count(); ++c) {
    const auto i = static_cast<std::size_t>(c);
    if (allowed[i] == 0) continue;
    const double at = map.place(c).x;
    if (at > x.high - k_end_mm) mesial.push_back(c);
    if (at < x.low + k_end_mm) distal.push_back(c);
    if (std::fabs(at - x.middle()) < k_between_share * x.half())
      allowed[i] = side_height(map, c) >= k_min_side_mm;
  }
  const auto bend = surface_curvature(map);
  Groove groove;
  groove.way = valley_path(map, allowed, bend, mesial, distal);
  const GrooveProfile there = profile_of(map, groove.way);
  GrooveProfile back = there;
  std::reverse(back.z.begin(), back.z.end());
  for (std::size_t i = 0; i < back.s.size(); ++i)
    back.s[i] = there.s.back() - there.s[there.s.size() - 1 - i];
  const auto mesial_end = end_of(there), distal_end = end_of(back);
  if (!mesial_end || !distal_end || mesial_end->place + distal_end->place + 8 > groove.way.size())
    return std::nullopt;
  groove.mesial = *mesial_end;
  groove.distal = {groove.way.size() - 1 - distal_end->place, distal_end->ridge};
  const double out_mesial = map.place(groove.way[groove.mesial.place]).x - x.middle(),
               out_distal = x.middle() - map.place(groove.way[groove.distal.place]).x;
  if (std::min(out_mesial, out_distal) < k_min_share * x.half()) return std::nullopt;
  std::vector<double> bends, sides;
  for (std::size_t i = groove.mesial.place; i <= groove.distal.place; ++i) {
    bends.push_back(bend[static_cast<std::size_t>(groove.way[i])]);
    sides.push_back(side_height(map, groove.way[i]));
  }
  if (median(bends) < least_per_mm || median(sides) < k_side_mm) return std::nullopt;
  return groove;
}

}  // namespace cavum
