// What can be wrong, or unwise, in a scenario or rubric file, for whoever has to tell one from another.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace cavum::scenarios {

enum class Mistake : std::uint8_t {
  other,
  not_toml,  ///< or no text
  missing,   ///< or empty
  wrong_type,
  out_of_range,
  too_large,  ///< beyond a limit
  unknown_key,
  unknown_name,  ///< of a tissue, a measure, a bur, a criterion; a word that is none of those there are
  bad_name,
  duplicate,
  contradictory,        ///< two things that do not go together
  condition,            ///< cannot be read, or does not mean what it reads
  outline,              ///< crosses itself, or encloses nothing
  surface,              ///< an STL file
  trespass,             ///< target or leeway reach what must not be cut, or the air
  unreachable,          ///< a buried target, a condition that never holds, a bur that does not fit, points that nobody can win
  idle,                 ///< changes nothing: a condition that always holds, points that nobody can lose, a fault that costs nothing
  faulty_preparations,  ///< passes, or gains points where it grows
};
/// As JSON has them, by value.
inline constexpr std::array<std::string_view, 18> k_mistake_names{
    "other",     "not_toml",      "missing",   "wrong_type", "out_of_range", "too_large", "unknown_key", "unknown_name", "bad_name",
    "duplicate", "contradictory", "condition", "outline",    "surface",      "trespass",  "unreachable", "idle",         "faulty_preparations"};

}  // namespace cavum::scenarios
