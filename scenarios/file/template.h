// Commented scenarios to start from, for the teeth and tasks that Cavum knows how to combine.
#pragma once

#include <string>
#include <vector>

namespace cavum::scenarios {

/// A tooth and a task that there is a template for.
struct TemplateChoice {
  std::string tooth, task;
};
[[nodiscard]] std::vector<TemplateChoice> template_choices();

/// A whole scenario with comments, without mistakes on its tooth. Throws Error listing the choices for any other combination.
[[nodiscard]] std::string scenario_template(const std::string& tooth, const std::string& task);

}  // namespace cavum::scenarios
