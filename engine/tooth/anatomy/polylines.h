// Rows of points out of cells: smoothed, thinned, with their heights read again.
#pragma once

#include <vector>

#include "engine/tooth/anatomy/height_map.h"
#include "engine/tooth/anatomy/landmarks.h"

namespace cavum {

/// Cells as a line: places smoothed by `passes` of 1-2-1 along it, heights from `map`. The ends of
/// an open line stay.
[[nodiscard]] inline Polyline line_of(const HeightMap& map, const std::vector<int>& cells,
                                      bool closed, int passes) {
  Polyline line;
  for (const int c : cells) line.push_back(map.place(c));
  const std::size_t n = line.size();
  for (int p = 0; p < passes && n > 2; ++p) {
    const Polyline old = line;
    for (std::size_t i = closed ? 0 : 1; i < (closed ? n : n - 1); ++i)
      line[i] = old[(i + n - 1) % n] * 0.25 + old[i] * 0.5 + old[(i + 1) % n] * 0.25;
  }
  for (auto& p : line) p.z = map.height(p.x, p.y);
  return line;
}

/// Every `step`-th point, and the last of an open line.
[[nodiscard]] inline Polyline thinned(const Polyline& line, std::size_t step, bool closed) {
  Polyline out;
  for (std::size_t i = 0; i < line.size(); i += step) out.push_back(line[i]);
  if (!closed && !line.empty() && (line.size() - 1) % step != 0) out.push_back(line.back());
  return out;
}

[[nodiscard]] inline double flat_distance(Vec3 a, Vec3 b) noexcept {
  return length({a.x - b.x, a.y - b.y, 0});
}

[[nodiscard]] inline double flat_length(const Polyline& line) noexcept {
  double sum = 0;
  for (std::size_t i = 1; i < line.size(); ++i) sum += flat_distance(line[i - 1], line[i]);
  return sum;
}

/// The point of a line that lies furthest along a way; null of an empty line.
[[nodiscard]] inline const Vec3* furthest_along(const Polyline& line, Vec3 way) noexcept {
  const Vec3* most = nullptr;
  for (const Vec3& p : line)
    if (most == nullptr || dot(p, way) > dot(*most, way)) most = &p;
  return most;
}

}  // namespace cavum
