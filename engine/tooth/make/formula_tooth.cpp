#include "engine/tooth/make/formula_tooth.h"

#include <algorithm>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/tooth/distance.h"
#include "engine/tooth/make/periodontium.h"

namespace cavum {

void check_choice(const char* name, double value, double low, double high) {
  if (!(value >= low && value <= high))
    throw Error(name, msg("the value is {}", as_number(value)),
                msg("choose from {} to {}", as_number(low), as_number(high)));
}

TissueGrid formula_grid(const FormulaBox& box, double leaf_mm, double periodontium_mm,
                        const std::string& name) {
  check_choice("--leaf-mm", leaf_mm, 0.03, 0.5);
  check_choice("--periodontium-mm", periodontium_mm, 0.0, 5.0);
  const double margin = 4 * leaf_mm;
  const auto down = [&](double mm) {
    return static_cast<std::int32_t>(-std::ceil((-mm + margin) / leaf_mm));
  };
  const auto up = [&](double mm) {
    return static_cast<std::int32_t>(std::ceil((mm + margin) / leaf_mm));
  };
  const IVec3 low{down(box.low_mm.x), down(box.low_mm.y), down(box.low_mm.z)},
      high{up(box.high_mm.x), up(box.high_mm.y), up(box.high_mm.z)};
  TissueGrid grid;
  check_lattice(high - low, leaf_mm, name);
  grid.allocate(high - low, leaf_mm, to_vec3(low) * leaf_mm);
  return grid;
}

void join_tissues(TissueGrid& grid, std::vector<float>& field) {
  std::vector<std::uint8_t> seen(grid.count());
  const auto nx = static_cast<std::size_t>(grid.size.x),
             nxy = nx * static_cast<std::size_t>(grid.size.y);
  // Four leaves of air lie around, so a neighbour's index is always one of the grid's.
  const auto body_from = [&](std::size_t first, std::vector<std::size_t>& body) {
    body.assign(1, first);
    seen[first] = 1;
    for (std::size_t next = 0; next < body.size(); ++next)
      for (const std::size_t beside : {body[next] - 1, body[next] + 1, body[next] - nx,
                                       body[next] + nx, body[next] - nxy, body[next] + nxy})
        if (!seen[beside] && grid.tissue[beside] == grid.tissue[first]) {
          seen[beside] = 1;
          body.push_back(beside);
        }
  };
  for (const auto& [tissue, around] : {std::pair{k_pulp, k_dentin}, std::pair{k_enamel, k_dentin},
                                       std::pair{k_dentin, k_enamel}}) {
    std::vector<std::size_t> largest, body;
    const auto give = [&, to = around](const std::vector<std::size_t>& leaves) {
      for (const std::size_t i : leaves) {
        grid.tissue[i] = to;
        field[i] = std::min(field[i], -1e-12f);
      }
    };
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (seen[i] || grid.tissue[i] != tissue) continue;
      body_from(i, body);
      if (body.size() > largest.size()) std::swap(body, largest);
      give(body);
    }
  }
}

Tooth finish_formula_tooth(TissueGrid& grid, const std::vector<float>& field,
                           const std::function<double(Vec3)>& solid, double periodontium_mm,
                           const std::string& name, const FormulaKind& what) {
  Tooth tooth;
  set_surface_from_field(grid, tooth.tissues, field, solid);
  const auto around = add_periodontium(grid, periodontium_mm);
  tooth.octree = Octree(grid, tooth.tissues);
  tooth.name = name;
  tooth.kind = kind_of(what.design);
  tooth.source = {
      MadeByFormula{what.design, what.seed, grid.leaf_mm, around > 0 ? periodontium_mm : 0.0}};
  return tooth;
}

}  // namespace cavum
