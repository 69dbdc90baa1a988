// Two hashes with two jobs: XXH3 tells quickly whether a replay still agrees, SHA-256 is evidence.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "engine/base/encoding.h"

namespace cavum {

using Sha256 = std::array<std::uint8_t, 32>;

/// SHA-256 of `bytes` (libsodium).
[[nodiscard]] Sha256 sha256(std::span<const std::uint8_t> bytes);
[[nodiscard]] Sha256 sha256(const std::string& text);

/// XXH3, 64 bits, of `size` bytes at `data`; not for evidence.
[[nodiscard]] std::uint64_t fast_hash(const void* data, std::size_t size,
                                      std::uint64_t seed) noexcept;

}  // namespace cavum
