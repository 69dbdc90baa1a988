// The JSON Schema of a scenario's file, for editors: data/schemas/scenario.schema.json, and in it
// each kind of body with its fields.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace cavum::scenarios {

/// Throws Error where the file is not there.
[[nodiscard]] nlohmann::ordered_json scenario_schema();

}  // namespace cavum::scenarios
