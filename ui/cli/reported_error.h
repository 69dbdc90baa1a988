// How the program ends when it cannot do what it was asked for.
#pragma once

#include <vector>

#include "engine/base/error.h"

namespace cavum::ui {

/// Each on a line of standard error, and with `as_json` on standard output {"error": the first,
/// "errors": all where there are several}, each
/// {"code", "where" {"file", "line", "column"} or {"name"}, "what", "values", "advice"}. At least
/// one.
void report_errors(const std::vector<Error>& errors, bool as_json);

}  // namespace cavum::ui
