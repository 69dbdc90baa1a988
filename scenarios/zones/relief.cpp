#include "scenarios/zones/relief.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "engine/base/det_math.h"
#include "engine/base/error.h"
#include "engine/tooth/distance_transform.h"
#include "engine/tooth/octree_edit.h"

namespace cavum::scenarios {
namespace {

// The floor of a chamber, from slices one leaf high, going down from the widest.
constexpr double k_narrow = 0.35;  // of the widest slice's area: from here on it is a canal
constexpr double k_branch = 0.04;  // of the widest slice's area: what counts as a canal of its own
constexpr double k_persist_mm = 0.3;  // a split must last this deep, or it is a ripple
constexpr double k_mouth_mm2 =
    0.02;  // the mouth of a canal 0.16 mm wide: less is a ripple of the floor

struct Slices {
  IVec3 low, size;                 // of the tissue's box, leaves
  std::vector<std::uint8_t> leaf;  // x fastest
  [[nodiscard]] std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size.y) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(size.x) +
           static_cast<std::size_t>(x);
  }
};

Slices slices_of(const Tooth& tooth, std::uint8_t tissue) {
  Slices s;
  const LeafBounds box = tooth.octree.bounds([&](std::uint8_t t) { return t == tissue; });
  s.low = box.low;
  s.size = box.empty() ? IVec3{0, 0, 0} : box.high - box.low;
  s.leaf.assign(cells_of(s.size), 0);
  tooth.octree.for_each_cube([&](IVec3 at, int edge, std::uint8_t t) {
    if (t != tissue) return;
    for (int z = 0; z < edge; ++z)
      for (int y = 0; y < edge; ++y)
        for (int x = 0; x < edge; ++x)
          s.leaf[s.index(at.x - box.low.x + x, at.y - box.low.y + y, at.z - box.low.z + z)] = 1;
  });
  return s;
}

/// Leaves of a slice that hang together.
using Piece = std::vector<IVec3>;

std::vector<Piece> pieces_of(const Slices& s, int z) {
  std::vector<Piece> pieces;
  std::vector<std::uint8_t> seen(
      static_cast<std::size_t>(s.size.x) * static_cast<std::size_t>(s.size.y), 0);
  std::vector<IVec3> stack;
  for (int y = 0; y < s.size.y; ++y)
    for (int x = 0; x < s.size.x; ++x) {
      const auto flat = [&](int a, int b) {
        return static_cast<std::size_t>(b) * static_cast<std::size_t>(s.size.x) +
               static_cast<std::size_t>(a);
      };
      if (s.leaf[s.index(x, y, z)] == 0 || seen[flat(x, y)] != 0) continue;
      Piece& piece = pieces.emplace_back();
      stack.assign(1, {x, y, 0});
      seen[flat(x, y)] = 1;
      while (!stack.empty()) {
        const IVec3 at = stack.back();
        stack.pop_back();
        piece.push_back({at.x, at.y, z});
        for (const IVec3 step :
             {IVec3{1, 0, 0}, IVec3{-1, 0, 0}, IVec3{0, 1, 0}, IVec3{0, -1, 0}}) {
          const IVec3 n = at + step;
          if (n.x < 0 || n.y < 0 || n.x >= s.size.x || n.y >= s.size.y) continue;
          if (s.leaf[s.index(n.x, n.y, z)] == 0 || seen[flat(n.x, n.y)] != 0) continue;
          seen[flat(n.x, n.y)] = 1;
          stack.push_back(n);
        }
      }
    }
  return pieces;
}

int area_of(const std::vector<Piece>& pieces) {
  std::size_t area = 0;
  for (const auto& p : pieces) area += p.size();
  return static_cast<int>(area);
}

/// Lowest slice of the chamber.
int chamber_floor(const Slices& s, double leaf_mm) {
  std::vector<int> area;
  for (int z = 0; z < s.size.z; ++z) area.push_back(area_of(pieces_of(s, z)));
  const int widest = static_cast<int>(std::max_element(area.begin(), area.end()) - area.begin());
  const int largest = area[static_cast<std::size_t>(widest)];
  const int least = std::max(1, static_cast<int>(k_branch * largest));
  const int persist = std::max(1, static_cast<int>(k_persist_mm / leaf_mm));
  int split_since = -1;
  for (int z = widest; z >= 0; --z) {
    const std::vector<Piece> pieces = pieces_of(s, z);
    if (area_of(pieces) < k_narrow * largest) return split_since >= 0 ? split_since + 1 : z + 1;
    const auto branches = std::count_if(pieces.begin(), pieces.end(), [&](const Piece& p) {
      return static_cast<int>(p.size()) >= least;
    });
    if (branches < 2)
      split_since = -1;
    else if (split_since < 0)
      split_since = z;
    if (split_since >= 0 && split_since - z >= persist) return split_since + 1;
  }
  return 0;
}

/// Slices of a tissue that must be there.
Slices required_slices(const Tooth& tooth, const std::string& tissue, const Message& where) {
  std::uint8_t id = k_air;
  for (const auto& t : tooth.tissues)
    if (t.name == tissue) id = t.id;
  Slices s = slices_of(tooth, id);
  if (id == k_air || s.leaf.empty())
    throw Error(where, msg("the tooth '{}' has no {}", tooth.name, tissue),
                msg("choose a tooth with it, or a zone that does not need it"));
  return s;
}

/// Of the whole tree.
ColumnMap columns_of(const Octree& tree, double value) {
  const IVec3 n = tree.size();
  return {
      n.x, n.y, tree.leaf_mm(), tree.origin_mm(),
      std::vector<double>(static_cast<std::size_t>(n.x) * static_cast<std::size_t>(n.y), value)};
}

}  // namespace

double ColumnMap::at(double x_mm, double y_mm) const noexcept {
  const double px = std::clamp((x_mm - origin_mm.x) / leaf_mm - 0.5, 0.0, nx - 1.0),
               py = std::clamp((y_mm - origin_mm.y) / leaf_mm - 0.5, 0.0, ny - 1.0);
  const int x = std::min(static_cast<int>(px), std::max(0, nx - 2)),
            y = std::min(static_cast<int>(py), std::max(0, ny - 2));
  const int x1 = std::min(x + 1, nx - 1), y1 = std::min(y + 1, ny - 1);
  const double fx = px - x, fy = py - y;
  const double low = value[index(x, y)] * (1 - fx) + value[index(x1, y)] * fx;
  const double high = value[index(x, y1)] * (1 - fx) + value[index(x1, y1)] * fx;
  return low * (1 - fy) + high * fy;
}

void ColumnMap::smooth(int rounds) {
  std::vector<double> next(value.size());
  for (int r = 0; r < rounds; ++r) {
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x) {
        double sum = 0;
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx)
            sum += value[index(std::clamp(x + dx, 0, nx - 1), std::clamp(y + dy, 0, ny - 1))];
        next[index(x, y)] = sum / 9;
      }
    value.swap(next);
  }
}

void TissueRelief::go_on_beside_shadow() {
  const auto nearest = nearest_seed({roof_mm.nx, roof_mm.ny, 1}, shadow);
  for (ColumnMap* map : {&floor_mm, &roof_mm}) {
    for (std::size_t i = 0; i < nearest.size(); ++i)
      if (nearest[i] >= 0) map->value[i] = map->value[static_cast<std::size_t>(nearest[i])];
    map->smooth(2);
  }
}

ColumnMap surface_relief(const Tooth& tooth) {
  const Octree& tree = tooth.octree;
  ColumnMap map = columns_of(tree, k_no_tooth_mm);
  std::vector<int> top(map.value.size(), -1);
  tree.for_each_cube([&](IVec3 at, int edge, std::uint8_t t) {
    if (!tree.is_solid(t)) return;
    for (int y = at.y; y < std::min(at.y + edge, map.ny); ++y)
      for (int x = at.x; x < std::min(at.x + edge, map.nx); ++x)
        top[map.index(x, y)] = std::max(top[map.index(x, y)], at.z + edge - 1);
  });
  for (int y = 0; y < map.ny; ++y)
    for (int x = 0; x < map.nx; ++x) {
      const int z = top[map.index(x, y)];
      if (z < 0) continue;
      // the distance at the topmost leaf says how far above its centre the surface lies
      const double above = std::clamp(-decode_distance(tree.distance_code({x, y, z})), 0.02, 0.98);
      map.value[map.index(x, y)] = tree.centre_mm({x, y, z}).z + above * tree.leaf_mm();
    }
  return map;
}

int top_leaf(const ColumnMap& surface, const Octree& tree, int x, int y) noexcept {
  if (x < 0 || y < 0 || x >= surface.nx || y >= surface.ny) return -1;
  const double z = surface.value[surface.index(x, y)];
  return z == k_no_tooth_mm
             ? -1
             : static_cast<int>(std::floor((z - tree.origin_mm().z) / tree.leaf_mm() - 0.5));
}

TissueRelief tissue_relief(const Tooth& tooth, const std::string& tissue, TissuePart part,
                           const Message& where) {
  const Slices s = required_slices(tooth, tissue, where);
  const Octree& tree = tooth.octree;
  const int first = part == TissuePart::chamber ? chamber_floor(s, tree.leaf_mm()) : 0;

  TissueRelief relief(columns_of(tree, 0.0));
  const auto face = [&](int z) { return tree.origin_mm().z + (s.low.z + z) * tree.leaf_mm(); };
  double count = 0;
  Vec3 sum;
  for (int y = 0; y < s.size.y; ++y)
    for (int x = 0; x < s.size.x; ++x) {
      int lowest = -1, highest = -1;
      for (int z = first; z < s.size.z; ++z)
        if (s.leaf[s.index(x, y, z)] != 0) {
          if (lowest < 0) lowest = z;
          highest = z;
          count += 1;
          sum += tree.centre_mm(s.low + IVec3{x, y, z});
        }
      if (lowest < 0) continue;
      const auto i = relief.roof_mm.index(s.low.x + x, s.low.y + y);
      relief.shadow[i] = 1;
      relief.floor_mm.value[i] = face(lowest);
      relief.roof_mm.value[i] = face(highest + 1);
    }
  relief.middle_mm = sum / count;
  relief.lowest_mm = face(first);
  relief.highest_mm = face(s.size.z);
  relief.go_on_beside_shadow();
  return relief;
}

std::vector<CanalMouth> canal_mouths(const Tooth& tooth, const std::string& tissue,
                                     const Message& where) {
  const Slices s = required_slices(tooth, tissue, where);
  const Octree& tree = tooth.octree;
  const double leaf = tree.leaf_mm();
  const int floor = chamber_floor(s, leaf);
  std::vector<CanalMouth> mouths;
  if (floor == 0) return mouths;
  const int below = std::max(0, floor - 1 - static_cast<int>(k_persist_mm / leaf));
  for (const auto& piece : pieces_of(s, floor - 1)) {
    const auto area = static_cast<double>(piece.size());
    const bool goes_on = std::any_of(
        piece.begin(), piece.end(), [&](IVec3 l) { return s.leaf[s.index(l.x, l.y, below)] != 0; });
    if (!goes_on || area * leaf * leaf < k_mouth_mm2) continue;
    Vec3 sum;
    for (const IVec3 l : piece) sum += Vec3{double(l.x), double(l.y), 0};
    const Vec3 in_leaves{s.low.x + sum.x / area + 0.5, s.low.y + sum.y / area + 0.5,
                         double(s.low.z + floor)};
    mouths.push_back({tree.origin_mm() + in_leaves * leaf, std::sqrt(area / k_pi) * leaf});
  }
  return mouths;
}

ColumnMap distance_to_edge(const ColumnMap& like, const std::vector<std::uint8_t>& inside,
                           int padding) {
  ColumnMap map = like;
  map.nx += 2 * padding;
  map.ny += 2 * padding;
  map.origin_mm = like.origin_mm - Vec3{1, 1, 0} * (padding * like.leaf_mm);
  std::vector<std::uint8_t> in(static_cast<std::size_t>(map.nx) * static_cast<std::size_t>(map.ny),
                               0),
      out;
  for (int y = 0; y < like.ny; ++y)
    for (int x = 0; x < like.nx; ++x)
      in[map.index(x + padding, y + padding)] = inside[like.index(x, y)];
  for (const auto i : in) out.push_back(i == 0 ? 1 : 0);
  const auto to_in = nearest_seed({map.nx, map.ny, 1}, in),
             to_out = nearest_seed({map.nx, map.ny, 1}, out);
  map.value.assign(in.size(), 0.0);
  for (int y = 0; y < map.ny; ++y)
    for (int x = 0; x < map.nx; ++x) {
      const auto i = map.index(x, y);
      const auto other = in[i] != 0 ? to_out[i] : to_in[i];
      if (other < 0) {
        map.value[i] = in[i] != 0 ? -1e3 : 1e3;
        continue;
      }
      const double dx = other % map.nx - x, dy = other / map.nx - y;
      const double d = (std::sqrt(dx * dx + dy * dy) - 0.5) *
                       map.leaf_mm;  // the edge runs half a leaf before the other's centre
      map.value[i] = in[i] != 0 ? -d : d;
    }
  return map;
}

}  // namespace cavum::scenarios
