// The one way in which bad input is reported: where, what, and what to do. Thrown while loading; the
// command line prints it as `cavum: where: what; what to do` and exits with 2.
#pragma once

#include <fmt/core.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace cavum {

/// Unusable input or environment. `what()` reads `where: what; what to do`.
class Error : public std::runtime_error {
 public:
  Error(const std::string& where, const std::string& what_happened, const std::string& what_to_do)
      : std::runtime_error(fmt::format("{}: {}; {}", where, what_happened, what_to_do)) {}
};

/// The text of an Error, or of a finding made of one, without its `; what to do`: for one that is told inside another, which says that itself.
[[nodiscard]] inline std::string without_advice(const std::string& text) { return text.substr(0, text.rfind("; ")); }

}  // namespace cavum
