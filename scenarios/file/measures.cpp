#include "scenarios/file/measures.h"

#include <fmt/core.h>

#include <algorithm>
#include <stdexcept>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/tooth/tissue_grid.h"

namespace cavum::scenarios {
namespace {

/// A figure of walls: of one, of the floor, of the four side walls together, of all together; null: not asked of those.
struct FigureWords {
  WallFigure figure;
  const char* wall;
  const char* floor;
  const char* side_walls = nullptr;
  const char* all = nullptr;
  Better better = Better::less;
  const Most* most = nullptr;
};
constexpr FigureWords k_figures[] = {{.figure = WallFigure::mean,
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
  return (first < floor ? unsigned{k_counts_sides} : 0u) | (first + walls > floor ? unsigned{k_counts_bottom} : 0u);
}

Measure wall_measure(const std::string& walls_name, const FigureWords& f, const char* words, std::size_t first, std::size_t walls) {
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
      out.push_back(wall_measure(wall_name(static_cast<Wall>(w)), f, w == static_cast<std::size_t>(Wall::floor) ? f.floor : f.wall, w, 1));
  for (const auto& f : k_figures)
    if (f.side_walls != nullptr) out.push_back(wall_measure("side_walls", f, f.side_walls, 0, k_side_walls));
  for (const auto& f : k_figures)
    if (f.all != nullptr) out.push_back(wall_measure("walls", f, f.all, 0, k_walls));
  return out;
}

std::vector<Measure> tissue_measures() {
  std::vector<Measure> out;
  for (const Tissue& t : standard_tissues()) out.push_back(tissue_measure(t.name));
  return out;
}

constexpr unsigned k_counts_removed = k_counts_target | k_counts_sides | k_counts_bottom | k_counts_outside | k_counts_protected;

/// In the order of the result's JSON.
std::vector<Measure> volume_measures() {
  return {
      {.name = "target_removed_percent",
       .words = "of the target's volume",
       .better = Better::more,
       .judges = Judges::work,
       .most = &most::percent,
       .counts = k_counts_target},
      {.name = "missed_mm3", .words = "target left standing", .judges = Judges::work, .most = &most::target, .counts = k_counts_target},
      {.name = "removed_mm3", .words = "all tissue removed", .better = Better::by_task, .most = &most::tooth, .counts = k_counts_removed},
      {.name = "outside_mm3",
       .words = "removed outside target, leeway and container, what is protected included",
       .most = &most::tooth,
       .counts = k_counts_outside | k_counts_protected,
       .counts_protected = true},
      {.name = "protected_mm3",
       .words = "removed of what is protected, wherever it lies",
       .most = &most::guarded,
       .needs = Needs::protection,
       .counts = k_counts_protected,
       .counts_protected = true},
      {.name = "leeway_sides_mm3",
       .words = "removed in the leeway beside the target",
       .most = &most::leeway_sides,
       .needs = Needs::leeway_sides,
       .counts = k_counts_leeway},
      {.name = "leeway_bottom_mm3",
       .words = "removed in the leeway below the target",
       .most = &most::leeway_bottom,
       .needs = Needs::leeway_bottom,
       .counts = k_counts_leeway},
      {.name = "container_sides_mm3",
       .words = "damage beside the target",
       .most = &most::container_sides,
       .needs = Needs::container_sides,
       .counts = k_counts_sides},
      {.name = "container_bottom_mm3",
       .words = "damage below the target",
       .most = &most::container_bottom,
       .needs = Needs::container_bottom,
       .counts = k_counts_bottom},
      {.name = "container_mm3",
       .words = "damage beside and below the target",
       .most = &most::container,
       .needs = Needs::container,
       .counts = k_counts_sides | k_counts_bottom},
      {.name = "overcut_mm3",
       .words = "everything removed beyond target and leeway",
       .most = &most::tooth,
       .counts = k_counts_sides | k_counts_bottom | k_counts_outside | k_counts_protected,
       .counts_protected = true},
      {.name = "dice",
       .words = "agreement of removed and target, 1 = equal",
       .better = Better::more,
       .judges = Judges::work,
       .most = &most::one,
       .counts = k_counts_removed},
  };
}

std::vector<Measure> shape_measures() {
  return {
      {.name = "outline_length_mm", .words = "mesial to distal, at the surface", .better = Better::by_task, .judges = Judges::work},
      {.name = "outline_width_mm", .words = "buccal to lingual, at the surface", .better = Better::by_task, .judges = Judges::work},
      {.name = "outline_length_error_mm",
       .words = "difference from the target's",
       .judges = Judges::work,
       .most = &most::no_end,
       .counts = k_counts_target | k_counts_sides},
      {.name = "outline_width_error_mm",
       .words = "difference from the target's",
       .judges = Judges::work,
       .most = &most::no_end,
       .counts = k_counts_target | k_counts_sides},
      {.name = "depth_mm", .words = "deepest point below the occlusal opening", .better = Better::by_task, .judges = Judges::work},
      {.name = "depth_error_mm",
       .words = "difference from the target's",
       .judges = Judges::work,
       .most = &most::no_end,
       .counts = k_counts_target | k_counts_bottom},
      {.name = "taper_deg", .words = "opening of the side walls towards the occlusal side", .better = Better::by_task},
      {.name = "taper_error_deg", .words = "difference from the target's", .most = &most::no_end},
  };
}

std::vector<Measure> access_measures() {
  return {
      {.name = "overhang_mm3",
       .words = "roof of the target left above what the task opens (perforation.aims)",
       .judges = Judges::work,
       .most = &most::target,
       .needs = Needs::aim,
       .counts = k_counts_target},
      {.name = "canals_covered_percent",
       .words = "of the canals' mouths, under hard tissue left on the straight line out",
       .judges = Judges::work,
       .most = &most::percent,
       .needs = Needs::aim,
       .counts = k_counts_target},
      {.name = "floor_cut_mm3", .words = "hard tissue removed below the target", .most = &most::tooth, .counts = k_counts_bottom, .of_floor = true},
      {.name = "dentin_over_pulp_mm",
       .words = "thinnest hard tissue left between the cavity and the pulp, 0 where it was opened",
       .better = Better::more,
       .most = &most::no_end,
       .needs = Needs::pulp},
  };
}

std::vector<Measure> beside_measures() {
  return {
      {.name = "neighbour_nick_depth_mm",
       .words = "deepest place cut into a neighbouring tooth, from its surface as it was",
       .most = &most::no_end,
       .needs = Needs::neighbour,
       .counts = k_counts_neighbour},
      {.name = "neighbour_nick_area_mm2",
       .words = "surface of a neighbouring tooth that was cut away",
       .most = &most::no_end,
       .needs = Needs::neighbour,
       .counts = k_counts_neighbour},
      {.name = "neighbour_removed_mm3",
       .words = "hard tissue removed of neighbouring teeth",
       .most = &most::no_end,
       .needs = Needs::neighbour,
       .counts = k_counts_neighbour},
      {.name = "proximal_clearance_mm",
       .words = "least distance from the neighbour over the part of the contact that the target opens; the contact's own while that stands",
       .better = Better::more,
       .judges = Judges::work,
       .most = &most::no_end,
       .needs = Needs::neighbour},
      {.name = "gum_removed_mm3", .words = "gum cut away", .most = &most::no_end, .needs = Needs::gum, .counts = k_counts_gum},
      {.name = "gum_touched_s",
       .words = "tenths of a second in which gum was cut",
       .most = &most::limit,
       .needs = Needs::gum,
       .counts = k_counts_gum,
       .of_exam = true},
  };
}

std::vector<Measure> motion_measures() {
  std::vector<Measure> all{
      {.name = "time_s", .words = "until the exam ended", .most = &most::limit, .counts = k_counts_time},
      {.name = "handpiece_time_s", .words = "with the handpiece turning", .most = &most::limit, .counts = k_counts_time},
      {.name = "idle_s", .words = "neither moving nor cutting", .most = &most::limit, .counts = k_counts_time},
      {.name = "force_mean_n", .words = "while cutting", .better = Better::by_task, .most = &most::no_end, .counts = k_counts_force},
      {.name = "force_peak_n", .words = "largest on the hand", .most = &most::no_end, .counts = k_counts_force},
      {.name = "force_over_limit_s",
       .words = "above force_limit_n",
       .most = &most::over_limit,
       .needs = Needs::force_limit,
       .counts = k_counts_force},
      {.name = "path_mm", .words = "way of the tip", .most = &most::no_end},
  };
  for (Measure& m : all) m.of_exam = true;
  return all;
}

std::vector<Measure> perforation_measures() {
  return {
      {.name = "perforated",
       .words = "1 when a tissue under perforation.faults was opened from the cavity",
       .most = &most::fault,
       .needs = Needs::fault,
       .counts = k_counts_faults,
       .counts_faults = true,
       .reads = Reads::yes_no,
       .yes = said("opened"),
       .no = said("not opened")},
      {.name = "perforation_volume_mm3",
       .words = "removed from the cavity of the tissues under perforation.faults",
       .needs = Needs::fault,
       .counts = k_counts_faults,
       .counts_faults = true},
      {.name = "soft_tissue_outside_mm3", .words = "removed of the tissues under perforation.faults from outside the tooth", .needs = Needs::fault},
      {.name = "perforation_events",
       .words = "faulty breakthroughs seen in the force and confirmed by the tissue",
       .most = &most::no_end,
       .counts = k_counts_faults,
       .counts_faults = true,
       .of_exam = true,
       .reads = Reads::count},
  };
}

std::vector<Measure> progress_measures() {
  return {
      {.name = "steps_completed",
       .words = "steps done",
       .better = Better::more,
       .judges = Judges::work,
       .most = &most::steps,
       .of_exam = true,
       .reads = Reads::count},
      {.name = "steps_failed", .words = "steps failed", .most = &most::steps, .of_exam = true, .reads = Reads::count},
      {.name = "violations",
       .words = "a bur that is not allowed, or a speed above max_rpm",
       .most = &most::no_end,
       .of_exam = true,
       .reads = Reads::count},
  };
}

/// That a name ends with.
const char* unit_of(std::string_view name) {
  using namespace std::string_view_literals;
  for (const auto& [end, unit] :
       {std::pair{"_mm3"sv, "mm3"}, {"_mm2"sv, "mm2"}, {"_mm"sv, "mm"}, {"_percent"sv, "%"}, {"_deg"sv, "deg"}, {"_s"sv, "s"}, {"_n"sv, "N"}})
    if (name.ends_with(end)) return unit;
  return "";
}

std::vector<Measure> all_measures() {
  std::vector<Measure> all;
  for (auto* family : {volume_measures, wall_measures, shape_measures, access_measures, beside_measures, motion_measures, perforation_measures,
                       tissue_measures, progress_measures})
    for (auto& m : family()) {
      if (std::any_of(all.begin(), all.end(), [&](const Measure& other) { return other.name == m.name; }))
        throw std::logic_error("measures: two are called " + m.name);
      if (m.unit == nullptr) m.unit = unit_of(m.name);
      all.push_back(std::move(m));
    }
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
          .unit = "mm3",
          .words = tissue + " removed",
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
  throw Error(msg("rubric"), msg("there is no measure '{}'", name), msg("use one that `cavum scenario check` knows"));
}

std::optional<double> most_of(const Measure& measure, const ExamExtent& exam) {
  if (measure.most != nullptr) return exam.*measure.most->value;
  const auto tissue = exam.tissue_mm3.find(measure.tissue);
  return tissue != exam.tissue_mm3.end() ? std::optional(tissue->second) : std::nullopt;
}

void require_row_for_each(const std::vector<std::string>& keys, const std::string& table) {
  std::vector<std::string> wanted;
  for (const auto& m : measures())
    if (std::find(wanted.begin(), wanted.end(), m.key()) == wanted.end()) wanted.push_back(m.key());
  for (const auto& key : wanted)
    if (const auto rows = std::count(keys.begin(), keys.end(), key); rows != 1)
      throw std::logic_error(fmt::format("{}: {} for the measure {}", table, rows == 0 ? "no row" : "several rows", key));
  for (const auto& key : keys)
    if (std::find(wanted.begin(), wanted.end(), key) == wanted.end())
      throw std::logic_error(fmt::format("{}: a row for {}, which is no measure", table, key));
}

}  // namespace cavum::scenarios
