#include "scenarios/file/measures.h"

#include <fmt/core.h>

#include <algorithm>
#include <stdexcept>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/tooth/tissue_grid.h"

namespace cavum::scenarios {
namespace {

/// A figure of walls: of one, of the floor, of the four side walls together, of all together; null:
/// not asked of those.
struct FigureWords {
  WallFigure figure;
  const char* wall;
  const char* floor;
  const char* side_walls = nullptr;
  const char* all = nullptr;
  Better better = Better::less;
  const Most* most = nullptr;
};
constexpr FigureWords k_figures[] = {
    {.figure = WallFigure::mean,
     .wall = "mean deviation of the wall, + = overcut",
     .floor = "mean deviation of the floor, + = too deep",
     .better = Better::by_task},
    {.figure = WallFigure::p95,
     .wall = "95th percentile of the wall's deviation",
     .floor = "95th percentile of the floor's deviation",
     .side_walls = "largest 95th percentile of the four side walls",
     .better = Better::by_task},
    {.figure = WallFigure::max_over,
     .wall = "largest overcut of the wall",
     .floor = "largest excess depth",
     .side_walls = "largest overcut of the four side walls",
     .all = "largest overcut of all walls and the floor",
     .most = &most::no_end},
    {.figure = WallFigure::max_under,
     .wall = "largest thickness left standing",
     .floor = "largest thickness left standing",
     .side_walls = "largest thickness left standing at the four side walls",
     .all = "largest thickness left standing at all walls and the floor",
     .most = &most::no_end}};

/// Thickness left is of the target; all other figures of a wall, of what is cut beyond it.
unsigned wall_counts(WallFigure figure, std::size_t first, std::size_t walls) {
  if (figure == WallFigure::max_under) return k_counts_target;
  const auto floor = static_cast<std::size_t>(Wall::floor);
  return (first < floor ? unsigned{k_counts_sides} : 0u) |
         (first + walls > floor ? unsigned{k_counts_bottom} : 0u);
}

Measure wall_measure(const std::string& walls_name, const FigureWords& f, const char* words,
                     std::size_t first, std::size_t walls) {
  return {.name = fmt::format("{}_{}", walls_name, wall_figure_name(f.figure)),
          .words = words,
          .better = f.better,
          .most = f.most,
          .counts = wall_counts(f.figure, first, walls),
          .of_floor = walls == 1 && first == static_cast<std::size_t>(Wall::floor),
          .family = k_wall_family,
          .first_wall = first,
          .walls = walls,
          .figure = f.figure};
}

std::vector<Measure> wall_measures() {
  std::vector<Measure> out;
  for (std::size_t w = 0; w < k_walls; ++w)
    for (const auto& f : k_figures)
      out.push_back(wall_measure(wall_name(static_cast<Wall>(w)), f,
                                 w == static_cast<std::size_t>(Wall::floor) ? f.floor : f.wall, w,
                                 1));
  for (const auto& f : k_figures)
    if (f.side_walls != nullptr)
      out.push_back(wall_measure("side_walls", f, f.side_walls, 0, k_side_walls));
  for (const auto& f : k_figures)
    if (f.all != nullptr) out.push_back(wall_measure("walls", f, f.all, 0, k_walls));
  return out;
}

std::vector<Measure> tissue_measures() {
  std::vector<Measure> out;
  for (const Tissue& t : standard_tissues()) out.push_back(tissue_measure(t.name));
  return out;
}

constexpr unsigned k_counts_removed =
    k_counts_target | k_counts_sides | k_counts_bottom | k_counts_outside | k_counts_protected;

/// That a name ends with.
const char* unit_of(std::string_view name) {
  using namespace std::string_view_literals;
  for (const auto& [end, unit] : {std::pair{"_mm3"sv, "mm3"},
                                  {"_mm2"sv, "mm2"},
                                  {"_mm"sv, "mm"},
                                  {"_percent"sv, "%"},
                                  {"_deg"sv, "deg"},
                                  {"_s"sv, "s"},
                                  {"_n"sv, "N"}})
    if (name.ends_with(end)) return unit;
  return "";
}

std::vector<Measure> all_measures() {
  std::vector<Measure> all;
  const auto add = [&](Measure m) {
    if (std::any_of(all.begin(), all.end(),
                    [&](const Measure& other) { return other.name == m.name; }))
      throw std::logic_error("measures: two are called " + m.name);
    if (m.unit == nullptr) m.unit = unit_of(m.name);
    all.push_back(std::move(m));
  };
#define MEASURE(NAME, WORDS, WHAT, VALUE, REASON, MOMENTS, PLACE) \
  add({.name = NAME, .words = WORDS IN_ROW WHAT});
#define FAMILY(KEY, MEMBERS, VALUE, REASON, MOMENTS) std::ranges::for_each(MEMBERS, add);
#include "scenarios/file/measures_table.inc"
  return all;
}

constexpr std::string_view k_before_tissue = "touched_", k_after_tissue = "_mm3";

}  // namespace

const char* wall_figure_name(WallFigure figure) noexcept {
  constexpr const char* k_names[] = {"mean_mm", "p95_mm", "max_over_mm", "max_under_mm"};
  return k_names[static_cast<std::size_t>(figure)];
}

List counts_text(unsigned counts) {
  List kinds;
  const auto name = [&](unsigned bit, const Message& words) {
    if ((counts & bit) != 0) kinds.items.push_back(words);
  };
  name(k_counts_target, msg("what is left of the target"));
  name(k_counts_sides, msg("damage beside it"));
  name(k_counts_bottom, msg("damage below it"));
  name(k_counts_outside, msg("what is removed elsewhere"));
  name(k_counts_protected, msg("protected tissue"));
  name(k_counts_faults, msg("opened faults"));
  name(k_counts_leeway, msg("the leeway"));
  name(k_counts_time, msg("time"));
  name(k_counts_force, msg("force"));
  name(k_counts_neighbour, msg("the teeth beside it"));
  name(k_counts_gum, msg("the gum"));
  return kinds;
}

Measure tissue_measure(const std::string& tissue) {
  return {.name = std::string(k_before_tissue) + tissue + std::string(k_after_tissue),
          .words = tissue + " removed",
          .unit = "mm3",
          .better = Better::by_task,
          .counts_faults = true,
          .family = k_tissue_family,
          .tissue = tissue};
}

const std::vector<Measure>& measures() {
  static const std::vector<Measure> k_all = all_measures();
  return k_all;
}

std::optional<Measure> find_measure(const std::string& name) {
  for (const auto& m : measures())
    if (m.name == name) return m;
  const std::size_t around = k_before_tissue.size() + k_after_tissue.size();
  if (name.size() > around && name.starts_with(k_before_tissue) && name.ends_with(k_after_tissue))
    return tissue_measure(name.substr(k_before_tissue.size(), name.size() - around));
  return {};
}

Measure known_measure(const std::string& name) {
  if (auto m = find_measure(name)) return *m;
  throw Error(msg("rubric"), msg("there is no measure '{}'", name),
              msg("use one that `cavum scenario check` knows"));
}

std::optional<double> most_of(const Measure& measure, const ExamExtent& exam) {
  if (measure.most != nullptr) return exam.*measure.most->value;
  const auto tissue = exam.tissue_mm3.find(measure.tissue);
  return tissue != exam.tissue_mm3.end() ? std::optional(tissue->second) : std::nullopt;
}

}  // namespace cavum::scenarios
