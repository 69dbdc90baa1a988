// Numbers as a report carries them: zstd over little-endian bytes, as base64, with the type beside
// it. The page of the report unpacks them with a few lines of script, and so can anybody else.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>

namespace cavum::report {

/// {"type":"u8|i8|u16|i16","n":count,"delta":bool,"zstd":base64}. With `delta` each value is kept
/// as its difference from the one before it, modulo 2^bits, which packs what moves smoothly better.
[[nodiscard]] nlohmann::json packed_array(std::span<const std::uint8_t> values, bool delta = false);
[[nodiscard]] nlohmann::json packed_array(std::span<const std::int8_t> values, bool delta = false);
[[nodiscard]] nlohmann::json packed_array(std::span<const std::uint16_t> values,
                                          bool delta = false);
[[nodiscard]] nlohmann::json packed_array(std::span<const std::int16_t> values, bool delta = false);

}  // namespace cavum::report
