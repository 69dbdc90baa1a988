// The measures that a criterion of a rubric may use: what is known of them here, of the rows of
// measures_table.inc. Parser, checks, advice, marking, `grade --why`, the JSON of a result and
// docs/measures.md are made of the same rows. What a row says to a room above is found there by the
// measure's key: value, bound and reason in grading/result/measure_marking.h, moments in
// grading/feedback/loss_finder.h.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/base/message.h"
#include "engine/base/text.h"
#include "scenarios/file/extent.h"
#include "scenarios/file/wall.h"

namespace cavum::scenarios {

/// Which of two values is better.
enum class Better { less, more, by_task };
/// Work: an untouched tooth does badly in it of itself. Care: it does best in it, so care counts
/// only for as much as was done.
enum class Judges { care, work };
/// What an exam must have for a measure to say anything.
enum class Needs {
  nothing,
  protection,
  leeway_sides,
  leeway_bottom,
  container_sides,
  container_bottom,
  container,
  aim,
  fault,
  force_limit,
  pulp,
  neighbour,
  gum
};

/// What a measure counts, as bits: two criteria with one in common charge the same tissue, or the
/// same ticks, twice.
enum Counts : unsigned {
  k_counts_nothing = 0,
  k_counts_target = 1,       ///< what is left of the target
  k_counts_sides = 2,        ///< damage beside the target
  k_counts_bottom = 4,       ///< damage below it
  k_counts_outside = 8,      ///< removed in no zone
  k_counts_protected = 16,   ///< removed of what is protected
  k_counts_faults = 32,      ///< removed of what must not be opened
  k_counts_leeway = 64,      ///< removed in the leeway
  k_counts_time = 128,       ///< ticks of the exam
  k_counts_force = 256,      ///< ticks in which is pressed
  k_counts_neighbour = 512,  ///< removed of the teeth beside it
  k_counts_gum = 1024,       ///< removed of the gum
};
/// "what is left of the target, damage beside it": how docs/measures.md says it; empty for nothing.
[[nodiscard]] List counts_text(unsigned counts);

/// What is said of a wall.
enum class WallFigure { mean, p95, max_over, max_under };
inline constexpr WallFigure k_wall_figures[] = {WallFigure::mean, WallFigure::p95,
                                                WallFigure::max_over, WallFigure::max_under};
/// "mean_mm": how it ends a measure's name, and its name in the JSON.
[[nodiscard]] const char* wall_figure_name(WallFigure figure) noexcept;

/// Keys of the two families: a figure of a wall or of several, and what was removed of a tissue.
inline constexpr char k_wall_family[] = "WALL_FIGURE";
inline constexpr char k_tissue_family[] = "touched_TISSUE_mm3";

/// What is left out does not apply.
/// How people read a value: with digits, as a number of things, or as yes (1) and no (0).
enum class Reads : std::uint8_t { figure, count, yes_no };

struct Measure {
  std::string name;
  std::string words;
  const char* unit =
      nullptr;  ///< left out: what its name ends with; of measures() and find_measure never null
  Better better = Better::less;
  Judges judges = Judges::care;
  const Most* most = nullptr;  ///< where its values end, from 0 on; null: nothing is known of that
  Needs needs = Needs::nothing;
  unsigned counts = k_counts_nothing;  ///< bits of Counts
  bool counts_faults = false;          ///< it answers whether something was opened that must not be
  bool counts_protected = false;       ///< it counts what is removed of what is protected
  bool of_floor = false;               ///< it speaks of the cavity's floor alone
  bool of_exam = false;  ///< it speaks of how the work was done: a preparation alone, without its
                         ///< recording, says nothing of it
  Reads reads = Reads::figure;
  const char *yes = noop("yes"), *no = noop("no");  ///< how 1 and 0 of a yes_no read

  // Members of a family
  const char* family = nullptr;           ///< its key; null: a measure by itself
  std::size_t first_wall = 0, walls = 0;  ///< of WALL_FIGURE: how many walls from which on
  WallFigure figure = WallFigure::mean;
  std::string tissue{};  ///< of touched_TISSUE_mm3

  /// By which rooms above add to it.
  [[nodiscard]] std::string key() const { return family != nullptr ? family : name; }
};

/// All of them, of tissues those of `standard_tissues()`. Throws std::logic_error when two have one
/// name.
[[nodiscard]] const std::vector<Measure>& measures();
/// A measure by its name, touched_NAME_mm3 of any tissue; none when there is none of that name.
[[nodiscard]] std::optional<Measure> find_measure(const std::string& name);
/// One that must be there. Throws Error when it is not.
[[nodiscard]] Measure known_measure(const std::string& name);
/// The measure of a tissue.
[[nodiscard]] Measure tissue_measure(const std::string& tissue);

/// Where its values end in an exam, from 0 on; none when nothing is known of that.
[[nodiscard]] std::optional<double> most_of(const Measure& measure, const ExamExtent& exam);

}  // namespace cavum::scenarios
