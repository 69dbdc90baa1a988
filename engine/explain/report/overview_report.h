// What was understood of a recording, as words and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "engine/explain/recording/overview.h"

namespace cavum::explain {

/// The names of docs/contracts.md (dry run).
[[nodiscard]] nlohmann::json to_json(const Overview& overview);
[[nodiscard]] std::string to_text(const Overview& overview);

}  // namespace cavum::explain
