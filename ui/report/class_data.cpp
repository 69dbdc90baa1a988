#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "ui/report/class_report.h"
#include "ui/report/figures/packed_array.h"
#include "ui/report/figures/tooth_grid.h"
#include "ui/report/report_data.h"

namespace cavum::report {

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

  struct Sum {
    double over = 0, under = 0;
    int outside = 0, inside = 0;
  };
  std::vector<Sum> sums(box.solid.size());
  const int e = grid.edge_leaves;
  const auto each = [&](const auto& visit) {
    std::size_t i = 0;
    for (int z = 0; z < box.size.z; ++z)
      for (int y = 0; y < box.size.y; ++y)
        for (int x = 0; x < box.size.x; ++x) visit(i++, box.low + IVec3{x, y, z});
  };
  std::vector<std::int8_t> heat(box.solid.size(), 0);
  each([&](std::size_t i, IVec3 cell) {
    Sum& s = sums[i];
    const IVec3 first = grid.low_leaf + IVec3{cell.x * e, cell.y * e, cell.z * e};
    for (int z = 0; z < e; ++z)
      for (int y = 0; y < e; ++y)
        for (int x = 0; x < e; ++x) {
          const IVec3 leaf = first + IVec3{x, y, z};
          if (leaf.x < 0 || leaf.y < 0 || leaf.z < 0 || tree.tissue(leaf) == k_air) continue;
          const double percent = t.map->percent(leaf);
          if (t.zones.zone(leaf) == scenarios::Zone::target) {
            s.under += percent;
            ++s.inside;
          } else {
            s.over += percent;
            ++s.outside;
          }
        }
    // a cell on the border tells of the side that more of it lies on
    const double mean = s.inside > s.outside ? s.under / s.inside : s.outside > 0 ? s.over / s.outside : 0;
    heat[i] = static_cast<std::int8_t>(std::lround(mean));
  });

  nlohmann::json cells = cells_json(grid, box);
  cells["heat"] = packed_array(heat);
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
