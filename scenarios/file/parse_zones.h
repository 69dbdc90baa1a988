// The [zones] part of a scenario file. Used by parse.cpp only.
#pragma once

#include "scenarios/file/checked_toml.h"
#include "scenarios/file/scenario.h"

namespace cavum::scenarios {

[[nodiscard]] ZoneSpec read_zones(const toml::table& table, std::map<std::string, Place>& places,
                                  ProblemList& problems);

}  // namespace cavum::scenarios
