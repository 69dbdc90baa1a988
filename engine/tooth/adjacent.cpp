#include "engine/tooth/adjacent.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/tooth/octree_edit.h"

namespace cavum {
namespace {

constexpr int k_near_leaves = 3;  // further than any code tells

template <class Belongs>
TissueSet tissues_that(const Tooth& tooth, const Belongs& belongs) {
  TissueSet set{};
  for (const Tissue& t : tooth.tissues) set[t.id] = t.id != k_air && belongs(t.name);
  return set;
}

/// Leaves around those of some tissues, in whole bricks; size 0 without any.
struct BrickBox {
  IVec3 low, size;
};
BrickBox bricks_around(const Octree& tree, const TissueSet& tissues) {
  constexpr int k_edge = Octree::k_brick_edge;
  const LeafBounds box = tree.bounds([&](std::uint8_t t) { return tissues[t]; });
  if (box.empty()) return {{0, 0, 0}, {0, 0, 0}};
  const auto down = [](int v) { return std::max(0, v - k_near_leaves) / k_edge * k_edge; };
  const auto up = [](int v, int n) {
    return (std::min(n, v + k_near_leaves) + k_edge - 1) / k_edge * k_edge;
  };
  const IVec3 n = tree.size(), first{down(box.low.x), down(box.low.y), down(box.low.z)};
  return {first, IVec3{up(box.high.x, n.x), up(box.high.y, n.y), up(box.high.z, n.z)} - first};
}

/// The leaves of a box, dense.
TissueGrid leaves_of(const Octree& tree, const BrickBox& box) {
  TissueGrid part;
  part.allocate(box.size, tree.leaf_mm(), tree.origin_mm());
  for (int z = 0; z < box.size.z; z += 4)
    for (int y = 0; y < box.size.y; y += 4)
      for (int x = 0; x < box.size.x; x += 4) {
        const IVec3 low = box.low + IVec3{x, y, z};
        const Octree::FullBrick brick = tree.brick({low.x >> 2, low.y >> 2, low.z >> 2});
        for (int i = 0; i < Octree::k_brick_leaves; ++i) {
          const std::size_t at = part.index({x + (i & 3), y + (i >> 2 & 3), z + (i >> 4)});
          part.tissue[at] = brick.tissue[static_cast<std::size_t>(i)];
          part.distance[at] = brick.distance[static_cast<std::size_t>(i)];
        }
      }
  return part;
}

/// Marks what lies within k_near_leaves of a marked leaf along every axis.
void widen(std::vector<std::uint8_t>& mark, IVec3 size) {
  const std::size_t x = static_cast<std::size_t>(size.x), y = static_cast<std::size_t>(size.y),
                    z = static_cast<std::size_t>(size.z);
  std::vector<int> last;  // of each line: the place of its last mark
  // along x line by line, along y and z all lines that lie together at once
  const auto along = [&](std::size_t lines, std::size_t n, std::size_t blocks) {
    std::vector<std::uint8_t> was(lines * n);
    for (std::size_t block = 0; block < blocks; ++block) {
      std::uint8_t* first = mark.data() + block * lines * n;
      std::copy_n(first, lines * n, was.begin());
      last.assign(lines, -2 * k_near_leaves);
      for (int i = 0; i < static_cast<int>(n) + k_near_leaves; ++i) {
        const int at = i - k_near_leaves;  // sees marks from k_near_leaves before it up to `i`
        for (std::size_t line = 0; line < lines; ++line) {
          if (i < static_cast<int>(n) && was[static_cast<std::size_t>(i) * lines + line] != 0)
            last[line] = i;
          if (at >= 0 && last[line] >= at - k_near_leaves)
            first[static_cast<std::size_t>(at) * lines + line] = 1;
        }
      }
    }
  };
  along(1, x, y * z);
  along(x, y, z);
  along(x * y, z, 1);
}

/// Places around a leaf in order of their distance, so that one that is too far ends the search.
struct Step {
  IVec3 by;
  double leaves;
};
const std::vector<Step>& steps_around() {
  static const std::vector<Step> k_steps = [] {
    std::vector<Step> all;
    for (int z = -k_near_leaves; z <= k_near_leaves; ++z)
      for (int y = -k_near_leaves; y <= k_near_leaves; ++y)
        for (int x = -k_near_leaves; x <= k_near_leaves; ++x)
          if (x != 0 || y != 0 || z != 0)
            all.push_back({{x, y, z}, std::sqrt(static_cast<double>(x * x + y * y + z * z))});
    std::stable_sort(all.begin(), all.end(),
                     [](const Step& a, const Step& b) { return a.leaves < b.leaves; });
    return all;
  }();
  return k_steps;
}

/// d(p) of the header, leaves; the band where nothing is near.
double leaves_from(const TissueGrid& part, const std::vector<std::uint8_t>& stays, IVec3 at) {
  double least = k_distance_band_leaves;
  for (const Step& step : steps_around()) {
    if (step.leaves - k_distance_band_leaves >= least) break;
    const IVec3 q = at + step.by;
    if (!part.inside(q)) continue;
    const std::size_t i = part.index(q);
    if (stays[i] != 0) least = std::min(least, step.leaves + decode_distance(part.distance[i]));
  }
  return least;
}

/// The leaves of a box without some tissues. `alone`: nothing but what stays counts, also where the
/// other lies outside the box.
TissueGrid part_without(const Octree& tree, const BrickBox& box, const TissueSet& gone,
                        bool alone) {
  constexpr double k_same_leaves = 0.08;  // what the codes and the formula leave open
  const TissueGrid before = leaves_of(tree, box);
  TissueGrid part = before;
  std::vector<std::uint8_t> stays(part.count()), near_gone(part.count());
  for (std::size_t i = 0; i < stays.size(); ++i) {
    const std::uint8_t t = part.tissue[i];
    stays[i] = tree.is_solid(t) && !gone[t] ? 1 : 0;
    near_gone[i] = tree.is_solid(t) && gone[t] ? 1 : 0;
  }
  const std::vector<std::uint8_t> goes = near_gone;
  std::vector<std::uint8_t> near_stays = stays;
  widen(near_gone, box.size);
  widen(near_stays, box.size);
  std::size_t i = 0;
  for (int z = 0; z < box.size.z; ++z)
    for (int y = 0; y < box.size.y; ++y)
      for (int x = 0; x < box.size.x; ++x, ++i) {
        if (gone[before.tissue[i]]) part.tissue[i] = k_air;
        if (stays[i] != 0 || (near_gone[i] == 0 && !alone)) continue;
        const double anew =
            near_stays[i] != 0 ? leaves_from(before, stays, {x, y, z}) : k_distance_band_leaves;
        // of a place that was outside all along the old distance stands unless something nearer
        // went
        if (goes[i] != 0 || anew - decode_distance(before.distance[i]) > k_same_leaves)
          part.distance[i] = std::max(encode_distance(anew), std::int8_t{1});
      }
  return part;
}

}  // namespace

bool is_of_neighbour(std::string_view tissue) noexcept {
  return known_tissue(tissue).kind == TissueKind::neighbour;
}
bool is_gum(std::string_view tissue) noexcept {
  return known_tissue(tissue).kind == TissueKind::gum;
}
bool is_adjacent(std::string_view tissue) noexcept {
  return is_gum(tissue) || is_of_neighbour(tissue);
}

Message tissue_words(std::string_view tissue) {
  const KnownTissue known = known_tissue(tissue);
  std::string words(known.name == tissue ? known.words : tissue);
  std::replace(words.begin(), words.end(), '_', ' ');
  return msg("{}", Term{words});
}

TissueSet adjacent_tissues(const Tooth& tooth) { return tissues_that(tooth, is_adjacent); }
TissueSet tissues_of(const Tooth& tooth, TissueKind kind) {
  return tissues_that(tooth,
                      [kind](std::string_view name) { return known_tissue(name).kind == kind; });
}

bool has_adjacent(const Tooth& tooth) {
  return std::any_of(tooth.tissues.begin(), tooth.tissues.end(),
                     [](const Tissue& t) { return is_adjacent(t.name); });
}

Octree octree_without(const Octree& tree, const TissueSet& gone) {
  const BrickBox box = bricks_around(tree, gone);
  return box.size.x == 0 ? tree : tree.with_leaves(box.low, part_without(tree, box, gone, false));
}

Tooth own_tooth(const Tooth& tooth) {
  if (!has_adjacent(tooth)) return tooth;
  return {tooth, octree_without(tooth.octree, adjacent_tissues(tooth)), tooth.tissues};
}

Octree neighbours_alone(const Tooth& tooth) {
  const TissueSet neighbours = tissues_of(tooth, TissueKind::neighbour);
  TissueSet others;
  for (std::size_t i = 0; i < others.size(); ++i) others[i] = i != k_air && !neighbours[i];
  const BrickBox box = bricks_around(tooth.octree, neighbours);
  const Octree empty = tooth.octree.emptied();
  return box.size.x == 0
             ? empty
             : empty.with_leaves(box.low, part_without(tooth.octree, box, others, true));
}

}  // namespace cavum
