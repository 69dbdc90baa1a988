// What the verbs of `cavum tooth` share.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "engine/base/vec.h"
#include "engine/tooth/tooth.h"
#include "ui/parts/option_checks.h"

namespace cavum::ui {

/// Numbers with commas between. Throws Error naming `option` and the part that is none.
[[nodiscard]] std::vector<double> parse_numbers(const std::string& text, const std::string& option);
/// Three of them.
[[nodiscard]] Vec3 parse_vec(const std::string& text, const std::string& option);
/// Saves the tooth and says what it is; `more` adds fields to the JSON.
void save_and_tell(const Tooth& tooth, const std::string& path, bool json,
                   const nlohmann::ordered_json& more);
/// `cavum tooth import`.
void add_import(CLI::App& tooth);
/// `cavum tooth landmarks`.
void add_landmarks(CLI::App& tooth);
/// `cavum tooth lesion`.
void add_lesion(CLI::App& tooth);
void add_neighbour(CLI::App& tooth);

}  // namespace cavum::ui
