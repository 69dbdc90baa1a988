// Finds the moments and facts behind the points that one criterion lost. Which of them a measure
// has is said in scenarios/file/measures_table.inc.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "grading/feedback/why.h"
#include "grading/measures/volumes.h"
#include "grading/result/measure_marking.h"

namespace cavum::grading {

/// What a measure's moments may be: a function that lists them, and what that is, for the manual.
#define LOSS_LISTS(LIST)                                                     \
  LIST(missed_target, "what stayed, by wall")                                \
  LIST(removed_in_zones, "what was removed there")                           \
  LIST(dice, "what stayed, what was removed beyond")                         \
  LIST(at_walls, "the walls' figures, furthest places, what was cut beyond") \
  LIST(length, "both ends, when they were cut")                              \
  LIST(width, "both ends, when they were cut")                               \
  LIST(depth, "the deepest place, when it was cut")                          \
  LIST(taper, "the side walls")                                              \
  LIST(taper_error, "both slopes, the side walls")                           \
  LIST(overhang, "each piece of roof, last cut near it")                     \
  LIST(canals, "each mouth, last cut near it")                               \
  LIST(floor_cut, "what was removed there")                                  \
  LIST(dentin_over_pulp, "the thinnest place, when it was cut")              \
  LIST(tissue, "what was removed of it")                                     \
  LIST(nick, "the deepest place, what was removed of neighbours")            \
  LIST(clearance, "both places, last cut near the first")                    \
  LIST(gum, "what was removed of it")                                        \
  LIST(perforation, "by tissue and by force")                                \
  LIST(time, "events, idle times")                                           \
  LIST(handpiece_time, "when it turned")                                     \
  LIST(idle, "idle times")                                                   \
  LIST(force, "when more was pressed than gives full marks")                 \
  LIST(force_over_limit, "when more was pressed than the limit")             \
  LIST(steps, "events")

class LossFinder {
 public:
  /// All of them must outlive it; `why` is what it writes to.
  LossFinder(const GradeInput& input, const Result& result, const scenarios::CriterionSpec& spec,
             Why& why);
  /// The moments of the criterion's measure, and what points they leave unsaid.
  void find();

#define DECLARED(LIST, WORDS) void LIST();
  LOSS_LISTS(DECLARED)
#undef DECLARED

 private:
  void fact(Facts facts, std::optional<double> amount = {}, const std::string& unit = "",
            const Trace& t = {}, double bound = 0);
  /// Points that a value of the metric is worth.
  [[nodiscard]] double points_at(double value) const;
  void removed_moments(std::vector<WhyItem> items);
  /// By parts of leaves, as the zones' volumes are counted.
  [[nodiscard]] std::vector<WhyItem> in_zones(const std::vector<scenarios::Zone>& zones) const;
  [[nodiscard]] std::vector<WhyItem> whole_leaves(
      const std::function<bool(const RemovedAt&)>& counts) const;
  /// `points`: what is lost by it altogether.
  void missed(double points);
  void walls(std::size_t first, std::size_t end, std::optional<scenarios::WallFigure> figure);
  enum class Extent : std::uint8_t { length, width, depth };
  void shape(Extent extent, std::optional<double> found, double wanted,
             std::optional<double> error);
  void pressed_above(double force);
  void leave_out(const WhyItem& item);
  void list_largest(std::vector<WhyItem> items);
  void value_and_work();
  [[nodiscard]] const TickRecord& record(std::int64_t tick) const {
    return in_.records[static_cast<std::size_t>(tick)];
  }

  const GradeInput& in_;
  const Result& r_;
  const scenarios::CriterionSpec& spec_;
  Why& why_;
  Asked asked_;
  std::int64_t end_ = 0;
};

struct LossList {
  const char* words;
  void (LossFinder::*list)();
};
/// What `grade --why` lists for a measure.
[[nodiscard]] LossList loss_list_of(const scenarios::Measure& measure);

}  // namespace cavum::grading
