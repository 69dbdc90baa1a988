// The one way a verb prints JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace cavum::ui {

/// One object on standard output. A file name that is no UTF-8 is shown with replacement
/// characters, for JSON has no other text; what would command a terminal is escaped.
void print_json(const nlohmann::json& json);
void print_json(const nlohmann::ordered_json& json);

}  // namespace cavum::ui
