// The table of laws as a page for people, made of the records themselves.
#pragma once

#include <string>
#include <vector>

#include "engine/lab/explain/model/mechanism.h"

namespace cavum::explain {

/// Names of all parameters that a mechanism can be reported with, in whatever shape; each ends in
/// its unit.
[[nodiscard]] std::vector<std::string> parameter_names(const Mechanism& mechanism);
/// Markdown: two tables, of all laws and of the force terms' parameters with their ranges.
[[nodiscard]] std::string laws_page();

}  // namespace cavum::explain
