#include "engine/base/hash.h"

#include <sodium.h>
#include <xxhash.h>

namespace cavum {

Sha256 sha256(std::span<const std::uint8_t> bytes) {
  Sha256 out{};
  crypto_hash_sha256(out.data(), bytes.data(), bytes.size());
  return out;
}

Sha256 sha256(const std::string& text) {
  return sha256(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

std::uint64_t fast_hash(const void* data, std::size_t size, std::uint64_t seed) noexcept {
  return XXH3_64bits_withSeed(data, size, seed);
}

}  // namespace cavum
