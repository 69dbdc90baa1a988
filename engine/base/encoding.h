// Bytes as text: hexadecimal, and base64 (RFC 4648, sections 4 and 5). By libsodium; one byte
// string has one text, and any other is refused.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "engine/base/bytes.h"

namespace cavum {

/// In lower case.
[[nodiscard]] std::string to_hex(std::span<const std::uint8_t> bytes);
[[nodiscard]] std::optional<Bytes> from_hex(std::string_view text);

enum class Base64 {
  padded,     ///< with '+', '/' and padding
  in_address  ///< with '-' and '_', without padding
};
[[nodiscard]] std::string to_base64(std::span<const std::uint8_t> bytes,
                                    Base64 form = Base64::padded);
[[nodiscard]] std::optional<Bytes> from_base64(std::string_view text, Base64 form = Base64::padded);

}  // namespace cavum
