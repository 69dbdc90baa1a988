// An exam without physics: what is cut is taken out of the octree layer by layer from outside, and
// the exam's own Runner makes its events. So a rubric can be tried on any piece of work in a
// fraction of a second. Forces, ways and times are made up: an even force, and next to no time.
#pragma once

#include <array>
#include <functional>

#include "grading/marking/grade.h"

namespace cavum::grading {

/// What is cut: signed distance at a place of the tooth frame, mm, negative inside. Near its
/// surface a distance; elsewhere its sign is enough.
using Cut = std::function<double(Vec3)>;

/// Where a cut may reach, tooth frame, mm.
struct CutBox {
  Vec3 low_mm, high_mm;
};

/// What is sat: all three must outlive whoever holds it.
struct Task {
  const scenarios::Scenario& scenario;
  const Tooth& tooth;
  const scenarios::ZoneMap& zones;
  std::array<bool, 256> around = {};             ///< tissues_around of aims and faults
  std::shared_ptr<const ToothApart> apart = {};  ///< null: nothing stands beside the tooth
};
/// With what is the same for all work on it.
[[nodiscard]] Task make_task(const scenarios::Scenario& scenario, const Tooth& tooth,
                             const scenarios::ZoneMap& zones);

/// Force of all cutting here, N.
inline constexpr double k_sitting_force_n = 0.5;

/// Marks a piece of work by the scenario's own rubric. `wait_ticks`: before handing in, waits with
/// the pedal off until all steps are done, at most for so long; the time limit ends the exam all
/// the same. An empty `cut` removes nothing. Throws Error when a condition cannot be compiled.
/// `look`, where it is given, sees what was marked, and its result, before that goes away.
[[nodiscard]] Result sit(const Task& task, const Cut& cut, const CutBox& box,
                         std::int64_t wait_ticks,
                         const std::function<void(const GradeInput&, const Result&)>& look = {});

}  // namespace cavum::grading
