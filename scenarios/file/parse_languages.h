// Reads what a scenario says in other languages: [languages.de] and the like.
#pragma once

#include "scenarios/file/checked_toml.h"
#include "scenarios/file/scenario.h"

namespace cavum::scenarios {

/// Other languages, each with the most of this.
inline constexpr std::size_t k_max_languages = 20;

/// The texts of `scenario`, whose steps and rubric are read already, in each language of
/// [languages]; mistakes go to `problems`.
[[nodiscard]] Translations read_languages(CheckedTable& file, const Scenario& scenario,
                                          ProblemList& problems);

}  // namespace cavum::scenarios
