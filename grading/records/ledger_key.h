// The school's key: it signs tickets and every state of the ledger; from it come the secrets for
// other purposes. It lies apart from the ledger, in the school's own folder, so that neither a copy
// of the ledger nor one of the sessions can make up or undo either.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "engine/base/bytes.h"
#include "engine/base/where.h"
#include "engine/session/station_key.h"

namespace cavum::records {

/// $CAVUM_HOME/school.key, or ~/.config/cavum/school.key.
[[nodiscard]] std::string school_key_path();
/// $CAVUM_HOME/school.pub: the public key (64 hexadecimal digits) of the school whose tickets this
/// station takes.
[[nodiscard]] std::string school_public_key_path();
/// Throws Error as load_signing_key does, and when there is no key and `make` does not ask for one:
/// a lost key is restored, not replaced.
[[nodiscard]] SigningKey load_school_key(const std::string& path, bool make = false);

/// `bytes` fresh random bytes as hexadecimal digits (libsodium).
[[nodiscard]] std::string random_hex(std::size_t bytes);
/// Bytes of lower-case hexadecimal digits; throws Error(`where`, ...) for anything else, or when
/// they are not `bytes` many.
[[nodiscard]] Bytes from_hex(const std::string& hex, std::size_t bytes, const Where& where);
template <std::size_t N>
[[nodiscard]] std::array<std::uint8_t, N> fixed_from_hex(const std::string& hex,
                                                         const Where& where) {
  const Bytes b = from_hex(hex, N, where);
  std::array<std::uint8_t, N> out{};
  std::copy(b.begin(), b.end(), out.begin());
  return out;
}

/// A secret of its own for one purpose: HKDF-SHA-256 (RFC 5869) of the key's seed, without salt,
/// `purpose` as info; 32 bytes. What signs never serves anything else.
[[nodiscard]] std::array<std::uint8_t, 32> derived_secret(const SigningKey& key,
                                                          const std::string& purpose);
/// HKDF-SHA-256 without salt, its first 32 bytes.
[[nodiscard]] std::array<std::uint8_t, 32> hkdf_sha256(std::span<const std::uint8_t> key_material,
                                                       const std::string& info);

/// "C-7K3M-Q9WD-XT20": 60 random bits in Crockford's base 32. It is drawn, so nothing leads from it
/// to anybody.
[[nodiscard]] std::string new_pseudonym();
/// What binds a row of identities: HMAC-SHA-256 over `message` under derived_secret(school, "cavum
/// identities").
[[nodiscard]] Bytes identity_seal(const SigningKey& school, const std::string& message);

}  // namespace cavum::records
