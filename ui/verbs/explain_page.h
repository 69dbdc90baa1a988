// The explanation as a page for a person: self-contained HTML with charts.
#pragma once

#include <string>

#include "engine/explain/inference/stiffness_table.h"

namespace cavum::ui {

/// `title`: the recording's name.
[[nodiscard]] std::string explanation_html(const explain::Explanation& explanation, const std::string& title);
/// The same for a table of force over stiffness.
[[nodiscard]] std::string table_html(const explain::TableExplanation& explanation, const std::string& title);

}  // namespace cavum::ui
