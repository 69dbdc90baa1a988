// A result as JSON (names fixed by tests, and more detail under further names), and as text for a terminal.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "grading/result.h"

namespace cavum {

/// Every name is always present; a figure that could not be measured is null.
[[nodiscard]] nlohmann::ordered_json to_json(const Result& result);
[[nodiscard]] std::string to_text(const Result& result);

}  // namespace cavum
