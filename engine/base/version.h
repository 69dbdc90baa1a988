// Which Cavum this is. A file of its own, so that a new version compiles one source and not all.
#pragma once

namespace cavum {

/// As in CHANGELOG.md: "1.2.3".
[[nodiscard]] const char* version() noexcept;

}  // namespace cavum
