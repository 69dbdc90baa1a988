// The pseudo-language: English sentences altered so that a reader still understands them, and
// whatever reads prose does not.
#pragma once

#include <string>
#include <string_view>

namespace cavum {

/// "⟦Ĉáñ {} ...⟧": gaps stay as they are.
[[nodiscard]] std::string pseudo(std::string_view english);
/// A sentence as the source has it; with CAVUM_ALTER_SENTENCES set (by tests) in the
/// pseudo-language.
[[nodiscard]] std::string source_sentence(const char* english);

}  // namespace cavum
