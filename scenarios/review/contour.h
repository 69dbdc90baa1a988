// Where a field crosses zero, as the lines of an SVG path: marching squares.
#pragma once

#include <fmt/core.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/svg.h"

namespace cavum::scenarios {

/// `field(x, y)` on a window's leaf centres, y upwards. The path is in leaf units, y downwards;
/// empty where nothing crosses.
template <class Field>
[[nodiscard]] std::string contour(int width, int height, const Field& field) {
  std::string path;
  const auto segment = [&](double ax, double ay, double bx, double by) {
    path += fmt::format("M{} {}L{} {}", svg_number(ax + 0.5), svg_number(height - ay - 0.5),
                        svg_number(bx + 0.5), svg_number(height - by - 0.5));
  };
  std::vector<double> now(static_cast<std::size_t>(width)), next(static_cast<std::size_t>(width));
  for (int x = 0; x < width; ++x) next[static_cast<std::size_t>(x)] = field(x, 0);
  for (int y = 0; y + 1 < height; ++y) {
    now.swap(next);
    for (int x = 0; x < width; ++x) next[static_cast<std::size_t>(x)] = field(x, y + 1);
    for (int x = 0; x + 1 < width; ++x) {
      const auto i = static_cast<std::size_t>(x);
      const double a = now[i], b = now[i + 1], c = next[i + 1], d = next[i];
      std::array<std::pair<double, double>, 4> at;
      int n = 0;
      const auto cross = [&](double p, double q, double px, double py, double qx, double qy) {
        if ((p < 0) == (q < 0)) return;
        const double t = p / (p - q);
        at[static_cast<std::size_t>(n++)] = {px + t * (qx - px), py + t * (qy - py)};
      };
      cross(a, b, x, y, x + 1, y);
      cross(b, c, x + 1, y, x + 1, y + 1);
      cross(c, d, x + 1, y + 1, x, y + 1);
      cross(d, a, x, y + 1, x, y);
      for (int k = 0; k + 1 < n; k += 2)
        segment(at[static_cast<std::size_t>(k)].first, at[static_cast<std::size_t>(k)].second,
                at[static_cast<std::size_t>(k + 1)].first,
                at[static_cast<std::size_t>(k + 1)].second);
    }
  }
  return path;
}

}  // namespace cavum::scenarios
