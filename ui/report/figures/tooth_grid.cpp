#include "ui/report/figures/tooth_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/base/error.h"
#include "engine/tooth/octree_edit.h"
#include "grading/measures/removed_map.h"

namespace cavum::report {
namespace {

constexpr double k_wanted_cell_mm = 0.1, k_around_target_mm = 1.0;
constexpr int k_margin_cells = 2;
constexpr std::size_t k_max_counts = 24'000'000;  // cells times tissues: 48 MB while counting

/// Cells from a multiple of the edge, so that the same tooth gives the same cells wherever its
/// tissue begins.
int floor_div(int a, int b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

/// What a tooth is made of, and the box of leaves around it.
struct ToothContent {
  LeafBounds box;                 // the last of them excluded
  std::vector<std::uint8_t> ids;  // of its tissues
  std::array<int, 256> column{};  // of a tissue among them, -1 = none of it
};

ToothContent content_of(const Tooth& tooth) {
  ToothContent content;
  content.column.fill(-1);
  tooth.octree.for_each_cube([&](IVec3 at, int edge, std::uint8_t t) {
    content.box.add(at, at + IVec3{edge, edge, edge});
    if (content.column[t] >= 0) return;
    content.column[t] = static_cast<int>(content.ids.size());
    content.ids.push_back(t);
  });
  if (content.ids.empty())
    throw Error(tooth.name, msg("this tooth holds no tissue"), msg("use another one"));
  return content;
}

/// A grid without content: cells as small as is wanted, or as there may be of them.
ToothGrid empty_grid(const Octree& tree, const ToothContent& content, std::size_t most_cells) {
  const auto& [low, high] = content.box;
  ToothGrid g;
  IVec3 from;
  for (g.edge_leaves = std::max(1, static_cast<int>(k_wanted_cell_mm / tree.leaf_mm() + 0.5));;
       ++g.edge_leaves) {
    const int e = g.edge_leaves;
    from = {floor_div(low.x, e) - k_margin_cells, floor_div(low.y, e) - k_margin_cells,
            floor_div(low.z, e) - k_margin_cells};
    const IVec3 to{floor_div(high.x - 1, e) + 1 + k_margin_cells,
                   floor_div(high.y - 1, e) + 1 + k_margin_cells,
                   floor_div(high.z - 1, e) + 1 + k_margin_cells};
    g.size = to - from;
    if (cells_of(g.size) <= most_cells) break;
  }
  const int e = g.edge_leaves;
  g.cell_mm = e * tree.leaf_mm();
  g.low_leaf = {from.x * e, from.y * e, from.z * e};
  g.origin_mm =
      tree.origin_mm() +
      Vec3{g.low_leaf.x + 0.5 * e, g.low_leaf.y + 0.5 * e, g.low_leaf.z + 0.5 * e} * tree.leaf_mm();
  return g;
}

/// Leaves of each tissue in each cell: for a cell one number after the other, in the order of
/// `content.ids`.
std::vector<std::uint16_t> count_tissues(const Octree& tree, const ToothGrid& g,
                                         const ToothContent& content) {
  const int e = g.edge_leaves;
  const std::size_t kinds = content.ids.size();
  std::vector<std::uint16_t> count(cells_of(g.size) * kinds, 0);
  tree.for_each_cube([&](IVec3 at, int edge, std::uint8_t t) {
    const auto kind = static_cast<std::size_t>(content.column[t]);
    const IVec3 a = at - g.low_leaf, b = a + IVec3{edge, edge, edge};
    const auto shared = [e](int cell, int from_leaf, int to_leaf) {
      return std::min(to_leaf, (cell + 1) * e) - std::max(from_leaf, cell * e);
    };
    for (int z = a.z / e; z * e < b.z; ++z)
      for (int y = a.y / e; y * e < b.y; ++y) {
        const int area = shared(z, a.z, b.z) * shared(y, a.y, b.y);
        for (int x = a.x / e; x * e < b.x; ++x) {
          auto& n = count[g.index({x, y, z}) * kinds + kind];
          n = static_cast<std::uint16_t>(n + area * shared(x, a.x, b.x));
        }
      }
  });
  return count;
}

/// Solid leaves of each cell, and the tissue that fills most of it.
void fill_cells(ToothGrid& g, const Octree& tree, const std::vector<std::uint8_t>& ids,
                const std::vector<std::uint16_t>& count) {
  const std::size_t kinds = ids.size();
  g.solid.resize(cells_of(g.size));
  g.tissue.resize(cells_of(g.size));
  for (std::size_t i = 0; i < g.solid.size(); ++i) {
    unsigned solid = 0, most_solid = 0, others = 0, most_other = 0;
    std::uint8_t of_solid = k_air, of_other = k_air;
    for (std::size_t k = 0; k < kinds; ++k) {
      const unsigned n = count[i * kinds + k];
      if (tree.is_solid(ids[k])) {
        solid += n;
        if (n > most_solid) most_solid = n, of_solid = ids[k];
      } else {
        others += n;
        if (n > most_other) most_other = n, of_other = ids[k];
      }
    }
    const unsigned air = static_cast<unsigned>(g.cell_leaves()) - solid - others;
    g.solid[i] = static_cast<std::uint16_t>(solid);
    g.tissue[i] = solid > 0          ? of_solid
                  : most_other > air ? of_other
                                     : static_cast<std::uint8_t>(k_air);
  }
}

}  // namespace

ToothGrid make_tooth_grid(const Tooth& tooth, std::size_t most_cells) {
  const ToothContent content = content_of(tooth);
  ToothGrid g =
      empty_grid(tooth.octree, content, std::min(most_cells, k_max_counts / content.ids.size()));
  fill_cells(g, tooth.octree, content.ids, count_tissues(tooth.octree, g, content));
  return g;
}

ChangedCells make_changed_cells(const ToothGrid& g, const grading::GradeInput& input) {
  const Octree& tree = input.seen_before().octree;
  const auto cell_at = [&](Vec3 p) {
    const Vec3 c = (p - g.origin_mm) / g.cell_mm;
    return IVec3{static_cast<int>(std::lround(c.x)), static_cast<int>(std::lround(c.y)),
                 static_cast<int>(std::lround(c.z))};
  };
  const Vec3 around{k_around_target_mm, k_around_target_mm, k_around_target_mm};
  IVec3 low = cell_at(input.zones.target_low_mm() - around),
        high = cell_at(input.zones.target_high_mm() + around) + IVec3{1, 1, 1};
  for (const auto& r : input.all_removed()) {
    const IVec3 c = g.cell_of(r.leaf.leaf());
    low = min(low, c);
    high = max(high, c + IVec3{1, 1, 1});
  }
  ChangedCells box;
  box.low = max(low, {0, 0, 0});
  box.size = min(high, g.size) - box.low;

  constexpr std::uint16_t k_never = 65535;
  box.solid.resize(cells_of(box.size));
  box.distance.resize(cells_of(box.size));
  box.first.assign(cells_of(box.size), k_never);
  box.last.assign(cells_of(box.size), k_never);
  std::size_t i = 0;
  for (int z = 0; z < box.size.z; ++z)
    for (int y = 0; y < box.size.y; ++y)
      for (int x = 0; x < box.size.x; ++x, ++i) {
        const IVec3 cell = box.low + IVec3{x, y, z};
        box.solid[i] = g.solid[g.index(cell)];
        const double steps = input.zones.distance_mm(g.centre_mm(cell)) / k_distance_step_mm;
        box.distance[i] = static_cast<std::int8_t>(std::lround(std::clamp(steps, -127.0, 127.0)));
      }
  const auto ticks = static_cast<double>(std::max<std::size_t>(1, input.records.size()));
  const grading::RemovedMap map(input.all_removed(), std::numeric_limits<std::int64_t>::max());
  grading::RemovedMap::Marks seen = map.marks();
  for (const auto& r : input.all_removed()) {
    const IVec3 leaf = r.leaf.leaf();
    if (!tree.is_solid(r.leaf.tissue) || tree.tissue(leaf) == k_air || !seen.first_time(leaf))
      continue;  // listed twice: the first time counts
    const IVec3 c = g.cell_of(leaf) - box.low;
    const std::size_t at = cell_index(c, box.size);
    const double share = static_cast<double>(r.tick) / ticks * 65535.0;
    const auto when = static_cast<std::uint16_t>(std::lround(std::clamp(share, 0.0, 65534.0)));
    if (box.solid[at] > 0) --box.solid[at];
    box.first[at] = box.first[at] == k_never ? when : std::min(box.first[at], when);
    box.last[at] = box.last[at] == k_never ? when : std::max(box.last[at], when);
  }
  return box;
}

std::vector<std::uint8_t> shares_of(const std::vector<std::uint16_t>& solid, int cell_leaves) {
  std::vector<std::uint8_t> shares(solid.size());
  for (std::size_t i = 0; i < solid.size(); ++i)
    shares[i] = static_cast<std::uint8_t>((solid[i] * 510 + cell_leaves) / (2 * cell_leaves));
  return shares;
}

}  // namespace cavum::report
