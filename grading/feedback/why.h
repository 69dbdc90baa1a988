// Behind each point lost: when, where and how much. A list of moments for one criterion, so that a
// student can go to that second of the replay; `cavum grade --why` prints it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/fact.h"
#include "engine/base/lines.h"
#include "grading/measures/grade_input.h"

namespace cavum::grading {

/// One moment, or one fact without a moment (tick -1).
struct WhyItem {
  std::int64_t tick = -1, end_tick = -1;  ///< first and last tick
  std::optional<Vec3> site_mm;
  std::optional<double> amount;
  std::optional<double> bound;  ///< the amount may be off by ± that; none where it is exact
  std::string unit;
  std::optional<double>
      points_lost;  ///< of this moment, where points follow from a sum over moments
  Facts facts;      ///< the first is what it is
  /// All of them.
  [[nodiscard]] Message what() const;
};

struct Why {
  CriterionResult criterion;
  double full = 0.0, zero = 0.0;  ///< values of the measure with full and with no marks
  std::vector<WhyItem> items;     ///< in order of time; facts without a moment come first
  std::size_t left_out = 0;       ///< smaller moments that are not listed ...
  double left_out_amount = 0.0, left_out_points = 0.0;  ///< ... all of them together
};

/// Removed leaves less than this apart in time belong to one moment.
inline constexpr std::int64_t k_moment_gap_ticks = 500;
inline constexpr std::size_t k_max_moments = 20;
inline constexpr double k_min_moment_mm3 =
    0.0005;  ///< a smaller volume is not worth a line: it would read 0.000

/// Throws Error naming all criteria when the rubric has none of that id.
[[nodiscard]] Why why(const GradeInput& input, const Result& result,
                      const scenarios::RubricSpec& rubric, const std::string& criterion_id);

[[nodiscard]] nlohmann::ordered_json to_json(const Why& why);
[[nodiscard]] Lines to_text(const Why& why);

}  // namespace cavum::grading
