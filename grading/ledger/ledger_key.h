// The school's key: it signs tickets and every state of the ledger, and makes pseudonyms. It lies apart from the ledger, in the
// school's own folder, so that neither a copy of the ledger nor one of the sessions can make up or undo either.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "engine/base/bytes.h"
#include "engine/session/station_key.h"

namespace cavum {

/// $CAVUM_HOME/school.key, or ~/.config/cavum/school.key.
[[nodiscard]] std::string school_key_path();
/// $CAVUM_HOME/school.pub: the public key (64 hexadecimal digits) of the school whose tickets this station takes.
[[nodiscard]] std::string school_public_key_path();
/// Throws Error as load_signing_key does, and when there is no key and `make` does not ask for one: a lost key is restored, not replaced.
[[nodiscard]] SigningKey load_school_key(const std::string& path, bool make = false);

/// `bytes` fresh random bytes as hexadecimal digits (libsodium).
[[nodiscard]] std::string random_hex(std::size_t bytes);
/// Bytes of lower-case hexadecimal digits; throws Error(`where`, ...) for anything else, or when they are not `bytes` many.
[[nodiscard]] Bytes from_hex(const std::string& hex, std::size_t bytes, const std::string& where);
template <std::size_t N>
[[nodiscard]] std::array<std::uint8_t, N> fixed_from_hex(const std::string& hex, const std::string& where) {
  const Bytes b = from_hex(hex, N, where);
  std::array<std::uint8_t, N> out{};
  std::copy(b.begin(), b.end(), out.begin());
  return out;
}

/// "C-7K3M-Q9WD-XT20": HMAC-SHA-256 of `salt` and `identity` under the school's key, 60 bits in Crockford's base 32. Without key and
/// salt nobody can go from one to the other.
[[nodiscard]] std::string pseudonym_of(const SigningKey& school, std::span<const std::uint8_t> salt, const std::string& identity);

}  // namespace cavum
