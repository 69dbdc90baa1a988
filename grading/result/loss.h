// Why a criterion lost points, in one line: what, how much, at which wall, when it began and where.
#pragma once

#include <string_view>

#include "grading/result/result.h"
#include "scenarios/file/measures.h"

namespace cavum::grading {

struct Asked;

struct Loss {
  Findings what;  ///< none: the figure says all there is
  Trace first;    ///< where the loss began
};

/// What the rows of grading/result/measure_marking.h choose from. Each says it of the measure that
/// was asked for.
namespace reason {
[[nodiscard]] Loss figure_alone(const Result& measured,
                                const Asked& asked);  ///< nothing: the figure says all there is
[[nodiscard]] Loss missed_target(
    const Result& measured,
    const Asked& asked);  ///< what of the target was left, and where the largest part of it
[[nodiscard]] Loss removed_in_zones(
    const Result& measured, const Asked& asked);  ///< of the row's zones the worst, and its wall
[[nodiscard]] Loss missed_and_beyond(const Result& measured, const Asked& asked);
[[nodiscard]] Loss at_walls(
    const Result& measured,
    const Asked& asked);  ///< the wall of them that has the largest of the figure
[[nodiscard]] Loss length_error(const Result& measured, const Asked& asked);
[[nodiscard]] Loss width_error(const Result& measured, const Asked& asked);
[[nodiscard]] Loss depth_error(const Result& measured, const Asked& asked);
[[nodiscard]] Loss taper_error(const Result& measured, const Asked& asked);
[[nodiscard]] Loss overhang(const Result& measured, const Asked& asked);
[[nodiscard]] Loss canals_covered(const Result& measured, const Asked& asked);
[[nodiscard]] Loss floor_cut(const Result& measured, const Asked& asked);
[[nodiscard]] Loss dentin_over_pulp(
    const Result& measured, const Asked& asked);  ///< where it is thinnest, and when that was cut
[[nodiscard]] Loss nick(const Result& measured,
                        const Asked& asked);  ///< where a neighbour was cut deepest, and when
[[nodiscard]] Loss clearance(const Result& measured,
                             const Asked& asked);  ///< between which places it is least
[[nodiscard]] Loss gum(const Result& measured, const Asked& asked);  ///< where it was cut first
[[nodiscard]] Loss time_over(const Result& measured,
                             const Asked& asked);  ///< when the time with full marks was over
[[nodiscard]] Loss force_peak(const Result& measured, const Asked& asked);
[[nodiscard]] Loss force_over_limit(const Result& measured, const Asked& asked);
[[nodiscard]] Loss fault_opened(const Result& measured, const Asked& asked);  ///< by the tissue
[[nodiscard]] Loss swept_outside(const Result& measured, const Asked& asked);
[[nodiscard]] Loss fault_felt(const Result& measured,
                              const Asked& asked);  ///< by the force, and confirmed
[[nodiscard]] Loss tissue_touched(const Result& measured, const Asked& asked);
[[nodiscard]] Loss first_violation(const Result& measured, const Asked& asked);
}  // namespace reason

/// A measure's value, as people read it: "opened", "3", "0.25 ± 0.05 mm".
[[nodiscard]] Value value_text(const scenarios::Measure& measure, double value, double bound,
                               int digits);
/// In words: how much, how quick, from when, and how clear.
[[nodiscard]] Message drop_text(const ForceDrop& drop);

}  // namespace cavum::grading
