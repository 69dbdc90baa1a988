// Identifiers in lines that are printed in English and translated as a whole where they are shown: what must not be translated is marked. The rooms
// that write such lines know of no language; the language switches the marks on.
#pragma once

#include <atomic>
#include <string>
#include <string_view>

namespace cavum {

inline constexpr char k_keep[] = "\ue000", k_keep_end[] = "\ue001";  ///< around it, of the Unicode area for private use

/// Whether kept() marks anything: set_language() says so. Off in English.
inline std::atomic<bool> kept_is_marked{false};

/// An identifier as it stays in the line. In English the same string.
[[nodiscard]] inline std::string kept(std::string_view identifier) {
  return kept_is_marked ? k_keep + std::string(identifier) + k_keep_end : std::string(identifier);
}

}  // namespace cavum
