// What a tooth file holds, as `cavum tooth` says it.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

#include "engine/tooth/tooth.h"

namespace cavum::ui {

/// To whole multiples of `unit`, so that JSON shows no digits that mean nothing.
[[nodiscard]] double rounded(double v, double unit);
/// The names of docs/contracts.md (JSON) for `tooth info --json`.
[[nodiscard]] nlohmann::ordered_json describe(const Tooth& tooth, std::uintmax_t file_bytes);
/// The same in words, on standard output; `described` is what describe() says of the tooth.
void print_tooth(const Tooth& tooth, const nlohmann::ordered_json& described);

}  // namespace cavum::ui
