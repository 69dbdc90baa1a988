// What the rows of scenarios/file/measures_table.inc say to marking: value with its bound, the
// reason why points were lost, its place in the result's JSON. Found by the measure's key.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grading/result/loss.h"
#include "grading/result/mark.h"
#include "grading/result/result.h"
#include "scenarios/file/measures.h"

namespace cavum::grading {

struct MeasureMarking;

/// A measure as a criterion asks for it.
struct Asked {
  scenarios::Measure measure;
  const MeasureMarking* marking = nullptr;
  double full = 0.0;  ///< value with full marks
};

struct MeasureMarking {
  const char* measure = nullptr;  ///< its key
  /// With its bound; no value where it cannot be measured.
  MetricValue (*value)(const Result& result, const Asked& asked) = nullptr;
  /// In one line, and where it began; an empty one where the figure says all there is. Called when
  /// there is a value.
  Loss (*reason)(const Result& result, const Asked& asked) = nullptr;
  /// It is of what was removed in these zones; where it is several, bottom and sides are among them
  /// or neither is.
  std::vector<scenarios::Zone> zones{};
  /// JSON pointers into the result; one that ends in / goes on with the measure's name. Null: it
  /// has no place of its own.
  const char* json = nullptr;
  const char* bound_json = nullptr;
  bool whole = false;  ///< a count or yes and no, written as such
};

[[nodiscard]] const MeasureMarking& marking_of(const scenarios::Measure& measure);

/// Throws Error when there is no measure of that name.
[[nodiscard]] Asked asked(const std::string& metric, double full);
/// Its pointer in the JSON, and its bound's; empty without one.
[[nodiscard]] std::string json_location(const scenarios::Measure& measure);
[[nodiscard]] std::string bound_json_location(const scenarios::Measure& measure);

/// What a measure says of a result, with its bound; no value where it cannot be measured, or where
/// nothing was handed in that shows it.
[[nodiscard]] MetricValue value_of(const Result& result, const Asked& asked);
/// A preparation was handed in without its recording, and does not show this.
[[nodiscard]] bool not_shown(const Result& result, const scenarios::Measure& measure);

/// A figure of a wall, and its bound, mm.
[[nodiscard]] double wall_figure(const WallMeasures& wall, scenarios::WallFigure figure) noexcept;
[[nodiscard]] double wall_bound_mm(const ShapeMeasures& shape, const WallMeasures& wall,
                                   scenarios::WallFigure figure) noexcept;

}  // namespace cavum::grading
