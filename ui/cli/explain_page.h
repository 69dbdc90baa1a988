// The explanation as a page for a person, in the reader's language: self-contained HTML with
// charts.
#pragma once

#include <string>

#include "engine/lab/explain/inference/stiffness_table.h"

namespace cavum::ui {

/// A whole page of `content`. `title`: the recording's name.
[[nodiscard]] std::string page_html(const std::string& title, const std::string& content);
[[nodiscard]] std::string explanation_html(const explain::Explanation& explanation,
                                           const std::string& title);
/// The same for a table of force over stiffness.
[[nodiscard]] std::string table_html(const explain::TableExplanation& explanation,
                                     const std::string& title);
/// How to record so that the mechanisms can be told apart, for the person at the rig.
[[nodiscard]] std::string protocol_html();

}  // namespace cavum::ui
