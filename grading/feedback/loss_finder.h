// Finds the moments and facts behind the points that one criterion lost. Which of them a measure has is said in
// grading/feedback/moments_of_measure.h.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "grading/feedback/why.h"
#include "grading/measures/volumes.h"
#include "grading/result/measure_marking.h"

namespace cavum::grading {

class LossFinder {
 public:
  /// All of them must outlive it; `why` is what it writes to.
  LossFinder(const GradeInput& input, const Result& result, const scenarios::CriterionSpec& spec, Why& why);
  /// The moments of the criterion's measure, and what points they leave unsaid.
  void find();

  // What a measure's moments may be
  void missed_target();     ///< what of the target stayed, wall by wall, and when the candidate last cut of the target there
  void removed_in_zones();  ///< in the zones that the measure counts
  void dice();              ///< loses by what was missed and by what was removed beyond, each in proportion to its volume
  void at_walls();          ///< of the measure's walls: figures, furthest places, what was cut beyond
  void length();
  void width();
  void depth();
  void taper();
  void taper_error();
  void overhang();
  void canals();
  void floor_cut();
  void dentin_over_pulp();
  void tissue();
  void nick();
  void clearance();
  void gum();
  void perforation();  ///< by tissue and by force
  void time();
  void handpiece_time();
  void idle();
  void force();             ///< stretches above what gives full marks
  void force_over_limit();  ///< stretches above the scenario's limit
  void steps();             ///< the exam as a row of events, each with what it took since the one before

 private:
  void fact(const Message& what, std::optional<double> amount = {}, const std::string& unit = "", const Trace& t = {}, double bound = 0);
  /// Points that a value of the metric is worth.
  [[nodiscard]] double points_at(double value) const;
  void removed_moments(std::vector<WhyItem> items);
  /// By parts of leaves, as the zones' volumes are counted.
  [[nodiscard]] std::vector<WhyItem> in_zones(const std::vector<scenarios::Zone>& zones) const;
  [[nodiscard]] std::vector<WhyItem> whole_leaves(const std::function<bool(const RemovedAt&)>& counts) const;
  /// `points`: what is lost by it altogether.
  void missed(double points);
  void walls(std::size_t first, std::size_t end, std::optional<scenarios::WallFigure> figure);
  enum class Extent : std::uint8_t { length, width, depth };
  void shape(Extent extent, std::optional<double> found, double wanted, std::optional<double> error);
  void pressed_above(double force);
  void leave_out(const WhyItem& item);
  void list_largest(std::vector<WhyItem> items);
  void value_and_work();
  [[nodiscard]] const TickRecord& record(std::int64_t tick) const { return in_.records[static_cast<std::size_t>(tick)]; }

  const GradeInput& in_;
  const Result& r_;
  const scenarios::CriterionSpec& spec_;
  Why& why_;
  Asked asked_;
  std::int64_t end_ = 0;
};

}  // namespace cavum::grading
