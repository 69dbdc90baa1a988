#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "ui/report/class_report.h"
#include "ui/report/figures/packed_array.h"
#include "ui/report/figures/tooth_grid.h"
#include "ui/report/report_data.h"

namespace cavum::report {
namespace {

/// Of each cell of a box the share of the class, percent, that cut there beyond the target, or left
/// the target standing. A cell on the border tells of the side that more of it lies on.
std::vector<std::int8_t> heat_of(const cohort::ClassTooth& t, const ToothGrid& grid,
                                 const ChangedCells& box) {
  const Octree& tree = t.tooth.octree;
  const int e = grid.edge_leaves;
  std::vector<std::int8_t> heat;
  const auto cell_heat = [&](IVec3 first) {
    double over = 0, under = 0;
    int outside = 0, inside = 0;
    for (int z = 0; z < e; ++z)
      for (int y = 0; y < e; ++y)
        for (int x = 0; x < e; ++x) {
          const IVec3 leaf = first + IVec3{x, y, z};
          if (leaf.x < 0 || leaf.y < 0 || leaf.z < 0 || tree.tissue(leaf) == k_air) continue;
          const bool target = t.zones.zone(leaf) == scenarios::Zone::target;
          (target ? under : over) += t.map->percent(leaf);
          ++(target ? inside : outside);
        }
    return inside > outside ? under / inside : outside > 0 ? over / outside : 0.0;
  };
  for (int z = 0; z < box.size.z; ++z)
    for (int y = 0; y < box.size.y; ++y)
      for (int x = 0; x < box.size.x; ++x) {
        const IVec3 cell = box.low + IVec3{x, y, z};
        heat.push_back(static_cast<std::int8_t>(
            std::lround(cell_heat(grid.low_leaf + IVec3{cell.x * e, cell.y * e, cell.z * e}))));
      }
  return heat;
}

}  // namespace

nlohmann::json class_data(const cohort::ClassFigures& figures, const cohort::ClassTooth& t) {
  // an exam in which exactly the target went
  const Octree& tree = t.tooth.octree;
  std::vector<RemovedAt> target;
  t.zones.for_each_target_leaf([&](IVec3 leaf) {
    const auto at = [](int v) { return static_cast<std::int16_t>(v); };
    target.push_back({0, {at(leaf.x), at(leaf.y), at(leaf.z), tree.tissue(leaf), 0}});
  });
  const grading::GradeInput planned{t.scenario, t.tooth, t.zones, tree, {}, {}, target, {}};
  const ToothGrid grid = make_tooth_grid(t.tooth);
  const ChangedCells box = make_changed_cells(grid, planned);

  nlohmann::json cells = cells_json(grid, box);
  cells["heat"] = packed_array(heat_of(t, grid, box));
  nlohmann::json data = {{"schema", 1},
                         {"kind", "class"},
                         {"title", t.scenario.title},
                         {"n", figures.n},
                         {"duration_s", 0.0},
                         {"high_contrast", false},
                         {"tissues", tissues_json(t.tooth, false)},
                         {"grid", std::move(cells)},
                         {"scale_mm", k_colours_end_mm}};
  add_words(data);
  return data;
}

}  // namespace cavum::report
