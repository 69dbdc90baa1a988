// What was understood of a recording, as words and as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "engine/base/lines.h"
#include "engine/lab/explain/recording/overview.h"

namespace cavum::explain {

/// The names of docs/contracts.md (dry run).
[[nodiscard]] nlohmann::json to_json(const Overview& overview);
[[nodiscard]] Lines to_text(const Overview& overview);

}  // namespace cavum::explain
