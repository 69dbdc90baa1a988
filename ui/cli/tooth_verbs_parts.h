// What the verbs of `cavum tooth` share.
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/base/vec.h"
#include "engine/tooth/tooth.h"

namespace cavum::ui {

/// Numbers with commas between. Throws Error naming `option` and the part that is none.
[[nodiscard]] std::vector<double> parse_numbers(const std::string& text, const std::string& option);
/// Three of them.
[[nodiscard]] Vec3 parse_vec(const std::string& text, const std::string& option);
/// Saves the tooth and says what it is; `more` adds fields to the JSON.
void save_and_tell(const Tooth& tooth, const std::string& path, bool json, const nlohmann::ordered_json& more = nlohmann::ordered_json::object());
/// `cavum tooth import`.
void add_import(CLI::App& tooth);
/// `cavum tooth landmarks`.
void add_landmarks(CLI::App& tooth);
/// `cavum tooth lesion`.
void add_lesion(CLI::App& tooth);
void add_neighbour(CLI::App& tooth);

}  // namespace cavum::ui
