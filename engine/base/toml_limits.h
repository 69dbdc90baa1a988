// How much one TOML text may be, counted in the text before the TOML library sees it. The library
// frees its tables by calling itself, so a header [a.a.a…] of 62 kB would end the program, and it
// looks up each dotted name among all earlier ones, which takes minutes when there are many.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "engine/base/message.h"

namespace cavum {

inline constexpr std::size_t k_toml_bytes =
    1U << 20;  ///< of text; our largest file has 4 kB, a zone drawn with 4,000 points 60 kB
inline constexpr std::size_t k_toml_parts =
    16;  ///< of one name: a.b.c has three; ours have at most two
inline constexpr std::size_t k_toml_depth =
    16;  ///< of lists and inline tables inside one another; ours have at most three
inline constexpr std::size_t k_toml_values = 60'000;  ///< names and items of lists, together
inline constexpr std::size_t k_toml_named =
    4'000;  ///< parts of headers and of dotted names, all together

/// What of a text is beyond a limit.
struct TomlExcess {
  std::size_t line = 1;  ///< from 1
  Message what, what_to_do;
};

/// The first place where `text` is beyond a limit. Nothing for a text within all of them; whether
/// it is TOML at all is for the parser to say.
[[nodiscard]] std::optional<TomlExcess> beyond_toml_limits(std::string_view text);

}  // namespace cavum
