#include "engine/tooth/cube_cases.h"

namespace cavum {
namespace {

/// Corners of the six faces, counter-clockwise seen from outside the cube.
constexpr std::array<std::array<int, 4>, 6> k_faces = [] {
  std::array<std::array<int, 4>, 6> faces{};
  for (int axis = 0; axis < 3; ++axis) {
    const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3, high = 1 << axis;
    faces[static_cast<std::size_t>(2 * axis)] = {0, v, u | v, u};
    faces[static_cast<std::size_t>(2 * axis + 1)] = {high, high | u, high | u | v, high | v};
  }
  return faces;
}();

int edge_between(int a, int b) {
  for (std::size_t e = 0; e < k_cube_edges.size(); ++e)
    if (k_cube_edges[e].low_corner == (a < b ? a : b) &&
        k_cube_edges[e].high_corner() == (a < b ? b : a))
      return static_cast<int>(e);
  return -1;
}

bool in_one_face(int edge_a, int edge_b) {
  for (const auto& face : k_faces) {
    bool a = false, b = false;
    for (std::size_t i = 0; i < 4; ++i) {
      const int e = edge_between(face[i], face[(i + 1) % 4]);
      a = a || e == edge_a;
      b = b || e == edge_b;
    }
    if (a && b) return true;
  }
  return false;
}

/// The edges around one piece of the surface, in order.
struct Outline {
  int count = 0;
  std::array<int, 12> edge{};
};

/// Is a fan from corner `first` of the outline free of sides that lie in a face?
bool fan_is_sound(const Outline& outline, int first) {
  for (int i = 2; i + 1 < outline.count; ++i)
    if (in_one_face(outline.edge[static_cast<std::size_t>(first)],
                    outline.edge[static_cast<std::size_t>((first + i) % outline.count)]))
      return false;
  return true;
}

CubeCase work_out(unsigned inside) {
  // On each face the surface runs from where a run of inside corners begins to where it ends.
  std::array<int, 12> next{};
  next.fill(-1);
  for (const auto& face : k_faces)
    for (std::size_t i = 0; i < 4; ++i) {
      const auto is_in = [&](std::size_t k) { return (inside >> face[k % 4] & 1u) != 0; };
      if (!is_in(i) || is_in(i + 1)) continue;
      std::size_t began = i + 4;
      while (is_in(began - 1)) --began;
      next[static_cast<std::size_t>(edge_between(face[(began - 1) % 4], face[began % 4]))] =
          edge_between(face[i], face[(i + 1) % 4]);
    }
  CubeCase made;
  for (std::size_t start = 0; start < 12; ++start) {
    Outline outline;
    for (int e = static_cast<int>(start); next[static_cast<std::size_t>(e)] >= 0;) {
      outline.edge[static_cast<std::size_t>(outline.count++)] = e;
      const int following = next[static_cast<std::size_t>(e)];
      next[static_cast<std::size_t>(e)] = -1;
      e = following;
    }
    if (outline.count == 0) continue;
    int first = 0;
    while (!fan_is_sound(outline, first)) ++first;  // there always is one
    for (int i = 1; i + 1 < outline.count; ++i) {
      const int corners[3]{first, (first + i) % outline.count, (first + i + 1) % outline.count};
      for (int c = 0; c < 3; ++c)
        made.edge[static_cast<std::size_t>(3 * made.triangles + c)] =
            static_cast<std::uint8_t>(outline.edge.at(static_cast<std::size_t>(corners[c])));
      ++made.triangles;
    }
  }
  return made;
}

}  // namespace

const std::array<CubeCase, 256>& cube_cases() {
  static const std::array<CubeCase, 256> cases = [] {
    std::array<CubeCase, 256> all;
    for (unsigned inside = 0; inside < all.size(); ++inside) all[inside] = work_out(inside);
    return all;
  }();
  return cases;
}

}  // namespace cavum
