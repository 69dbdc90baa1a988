// How long the built-in expert will need, reckoned from its way without running the exam: through
// tissue at the speed of its push, through the air at the speed of a quiet hand. 0.8 to 1.5 times
// what the expert took on the templates (tests/scenarios): an exam ends when its last step is
// complete, often before the way does.
#pragma once

#include <vector>

#include "engine/physics/contact/contact_tool.h"
#include "scenarios/operators/cut_plan.h"
#include "scenarios/operators/operator.h"

namespace cavum::scenarios {

/// Seconds for `way` with `tool`, held as `held` turns it (from its frame to the tooth's), at full
/// speed of the handpiece.
[[nodiscard]] double expert_time_s(const std::vector<Waypoint>& way, const Mat3& held,
                                   const Tooth& tooth, const ContactTool& tool, const Skill& skill);

}  // namespace cavum::scenarios
