// The [zones] part of a scenario file. Used by parse.cpp only.
#pragma once

#include "scenarios/checked_toml.h"
#include "scenarios/scenario.h"

namespace cavum {

[[nodiscard]] ZoneSpec read_zones(const toml::table& table, ProblemList& problems);

}  // namespace cavum
