// The explanation as a page for a person: self-contained HTML with charts.
#pragma once

#include <string>

#include "engine/explain/explain.h"

namespace cavum {

/// `title`: the recording's name.
[[nodiscard]] std::string explanation_html(const explain::Explanation& explanation, const std::string& title);

}  // namespace cavum
