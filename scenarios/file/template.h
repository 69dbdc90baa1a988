// Commented scenarios to start from, for the teeth and tasks that Cavum knows how to combine.
#pragma once

#include <string>
#include <vector>

namespace cavum::scenarios {

/// What one scenario says of its own: steps, pauses, margins, rubric and comments are the same for all of its kind.
struct TaskText {
  std::string id, title, what;    ///< `what` is for the candidate
  std::string tooth_file, about;  ///< `about` the tooth, a comment
  std::string points;             ///< the tray, as a TOML list
  double time_limit_s = 600.0;
  bool access = false;           ///< opens a pulp chamber: its steps ask for that
  std::string aims, faults;      ///< TOML lists of tissues
  double walls_limit_mm3 = 0.0;  ///< of wall cut beyond the leeway the exam is failed; 0: no such limit
  std::string zones, guard;      ///< [[zones.target]] and [[zones.protected]] with comments
  std::string criteria{};        ///< further [[rubric.criteria]]
};
/// A whole scenario with comments.
[[nodiscard]] std::string scenario_text(const TaskText& task);

/// A tooth and a task that there is a template for.
struct TemplateChoice {
  std::string tooth, task;
};
[[nodiscard]] std::vector<TemplateChoice> template_choices();

/// A whole scenario with comments, without mistakes on its tooth. Throws Error listing the choices for any other combination.
[[nodiscard]] std::string scenario_template(const std::string& tooth, const std::string& task);

}  // namespace cavum::scenarios
