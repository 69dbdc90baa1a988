#include "ui/station/thinned_patch.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "engine/base/error.h"

namespace cavum::station {
namespace {

constexpr std::int64_t k_in_leaf =
    4096;  // steps of a leaf: whole numbers add up alike in any order
constexpr std::uint16_t k_new_cell = 0xffff;

/// What became one vertex.
struct Joined {
  std::array<std::int64_t, 3> at{}, normal{};
  std::int64_t count = 0;
  std::uint8_t tissue = 0, beside = 0;
  bool whole = false;  // one vertex, as it was
  PatchVertex kept;
};

/// A vertex as seen from its patch.
struct Seen {
  std::array<std::int64_t, 3> at{};  // of the tooth, in steps
  int cell_leaves = 0;               // the smallest of the patches that share it
  std::array<int, 3> cell{};
};

constexpr int k_along = SurfacePatches::k_edge / 2 +
                        2;  // the most cells of vertices that are joined, and the two borders

Seen seen(const PatchVertex& v, const PatchPosition& place) {
  // a vertex beside the border is a hundredth of a leaf away from it at least
  constexpr std::int64_t k_on_border = k_in_leaf / 512;
  constexpr std::int64_t k_patch = SurfacePatches::k_edge * k_in_leaf;
  const std::array<double, 3> origin{place.origin_mm.x, place.origin_mm.y, place.origin_mm.z};
  const std::array<int, 3> number{place.number.x, place.number.y, place.number.z};
  Seen s;
  std::array<std::int64_t, 3> in_patch{};
  std::array<int, 3> side{};  // -1, 1 on the patch's border
  for (std::size_t i = 0; i < 3; ++i) {
    s.at[i] = std::llround((static_cast<double>(v.position_mm[i]) - origin[i]) / place.leaf_mm *
                           static_cast<double>(k_in_leaf));
    in_patch[i] =
        s.at[i] - (number[i] * k_patch - k_in_leaf / 2);  // its first point is the middle of a leaf
    side[i] = in_patch[i] < k_on_border ? -1 : in_patch[i] > k_patch - k_on_border ? 1 : 0;
  }
  s.cell_leaves = SurfacePatches::k_edge;
  for (int z = 0; z <= std::abs(side[2]); ++z)
    for (int y = 0; y <= std::abs(side[1]); ++y)
      for (int x = 0; x <= std::abs(side[0]); ++x)
        if (const int c = place.cells[PatchPosition::beside(x * side[0], y * side[1], z * side[2])];
            c > 0)
          s.cell_leaves = std::min(s.cell_leaves, c);
  const int cells = SurfacePatches::k_edge / s.cell_leaves;
  for (std::size_t i = 0; i < 3; ++i)
    s.cell[i] = side[i] == 0 ? static_cast<int>(std::clamp<std::int64_t>(
                                   in_patch[i] / (s.cell_leaves * k_in_leaf), 0, cells - 1))
                             : k_along - (side[i] < 0 ? 2 : 1);
  return s;
}

/// Which way it faces, 0..5: the two walls of a fissure stay apart.
int facing(const PatchVertex& v) {
  int axis = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(v.normal[static_cast<std::size_t>(i)]) >
        std::abs(v.normal[static_cast<std::size_t>(axis)]))
      axis = i;
  return 2 * axis + (v.normal[static_cast<std::size_t>(axis)] < 0 ? 1 : 0);
}

PatchVertex vertex_of(const Joined& j, const PatchPosition& place) {
  if (j.whole) return j.kept;
  const std::array<double, 3> origin{place.origin_mm.x, place.origin_mm.y, place.origin_mm.z};
  PatchVertex v;
  v.tissue = j.tissue;
  v.beside = j.beside;
  double squared = 0;
  for (const std::int64_t n : j.normal) squared += static_cast<double>(n) * static_cast<double>(n);
  const double size = std::max(1.0, std::sqrt(squared));
  for (std::size_t i = 0; i < 3; ++i) {
    v.position_mm[i] = static_cast<float>(origin[i] + static_cast<double>(j.at[i]) /
                                                          static_cast<double>(j.count * k_in_leaf) *
                                                          place.leaf_mm);
    v.normal[i] =
        static_cast<std::int16_t>(std::lround(32767.0 * static_cast<double>(j.normal[i]) / size));
  }
  return v;
}

}  // namespace

SurfacePatch thinned(const SurfacePatch& patch, const PatchPosition& place) {
  for (std::size_t i = 0; i < place.cells.size(); ++i)
    if (const int c = place.cells[i]; c < 0 || (c == 0 && i == PatchPosition::beside(0, 0, 0)) ||
                                      (c > 0 && SurfacePatches::k_edge % c != 0))
      throw Error(msg("thinned patch"), msg("cells of {} leaves do not fit a patch", c),
                  msg("take 1, 2, 4, 8 or 16"));
  std::vector<std::uint16_t> of_cell(static_cast<std::size_t>(6 * k_along * k_along * k_along),
                                     k_new_cell),
      of_vertex;
  std::vector<Joined> joined;
  of_vertex.reserve(patch.vertices.size());
  for (const PatchVertex& v : patch.vertices) {
    const Seen s = seen(v, place);
    if (s.cell_leaves == 1) {
      of_vertex.push_back(static_cast<std::uint16_t>(joined.size()));
      joined.emplace_back();
      joined.back().whole = true;
      joined.back().kept = v;
      continue;
    }
    auto& number = of_cell[static_cast<std::size_t>(
        facing(v) + 6 * (s.cell[0] + k_along * (s.cell[1] + k_along * s.cell[2])))];
    if (number == k_new_cell) {
      number = static_cast<std::uint16_t>(joined.size());
      joined.emplace_back();
      joined.back().tissue = v.tissue;
      joined.back().beside = v.beside;
    }
    of_vertex.push_back(number);
    Joined& j = joined[number];
    ++j.count;
    for (std::size_t i = 0; i < 3; ++i) {
      j.at[i] += s.at[i];
      j.normal[i] += v.normal[i];
    }
  }
  SurfacePatch made;
  for (const Joined& j : joined) made.vertices.push_back(vertex_of(j, place));
  for (const auto& t : patch.triangles) {
    const std::array<std::uint16_t, 3> n{of_vertex[t[0]], of_vertex[t[1]], of_vertex[t[2]]};
    if (n[0] != n[1] && n[1] != n[2] && n[2] != n[0]) made.triangles.push_back(n);
  }
  return made;
}

}  // namespace cavum::station
