// JSON that somebody else wrote, read within limits. The JSON library frees and prints nested
// values by calling itself, so a text of 131 kB that is nothing but brackets would end the program:
// size, depth and number of values are counted while the text is read, before anything is kept.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "engine/base/where.h"

namespace cavum {

/// How much one JSON text may be.
struct JsonLimits {
  std::size_t bytes = 64U << 20;   ///< of text; a class of 200 with all its results is some 2 MB
  std::size_t values = 1'000'000;  ///< objects, lists, names and plain values together; one takes
                                   ///< up to 120 bytes of memory
  std::size_t depth = 64;          ///< of objects and lists inside one another; ours have 8
};
/// For a text whose value is put inside another of ours, which then stays within the usual depth.
inline constexpr JsonLimits k_json_part{64U << 20, 1'000'000, 48};

/// The value of the whole text. Throws Error at `where` when it is no JSON, with the line and
/// column, or when it is beyond a limit, which it names.
[[nodiscard]] nlohmann::json parse_json(std::string_view text, const Where& where,
                                        const JsonLimits& limits = {});
/// The same, but null for what parse_json refuses.
[[nodiscard]] nlohmann::json parse_json_or_null(std::string_view text,
                                                const JsonLimits& limits = {});
/// True when parse_json would take it.
[[nodiscard]] bool is_json(std::string_view text, const JsonLimits& limits = {});

}  // namespace cavum
