// Signing keys, Ed25519, made on first use and kept in a file that only its user may read. A
// station's key says which exam station closed a session, not who sat at it; a school's key signs
// tickets and the ledger.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "engine/base/where.h"

namespace cavum {

/// Ed25519 key pair (libsodium).
struct SigningKey {
  std::array<std::uint8_t, 32> public_key{};
  std::array<std::uint8_t, 64> secret_key{};

  [[nodiscard]] std::array<std::uint8_t, 64> sign(std::span<const std::uint8_t> message) const;
};

/// $CAVUM_HOME/station.key, or ~/.config/cavum/station.key. Throws Error when neither variable is
/// set.
[[nodiscard]] std::string station_key_path();

/// Reads the key at `path`, or makes one there (mode 0600) when there is none; `owner` ("station",
/// "school") is written into it, and a key of another owner is refused. Throws Error when the file
/// cannot be read or made, is damaged, or may be read by others.
[[nodiscard]] SigningKey load_signing_key(const std::string& path, const std::string& owner);
/// The same of a station. Throws Error also when a key was enrolled here (remember_enrolled) and is
/// no longer there, or is another: a lost key is not silently made again, for nobody knows the new
/// one.
[[nodiscard]] SigningKey load_station_key(const std::string& path);
/// Remembers beside the key at `path` that it was enrolled by a school. Throws Error when nothing
/// can be written.
void remember_enrolled(const std::string& path, const SigningKey& key);

/// A station's public key as people write it: 64 hexadecimal digits, returned in lower case. Throws
/// Error(`where`, ...) for anything else.
[[nodiscard]] std::string parse_public_key(const std::string& text, const Where& where);

/// True when `signature` over `message` was made by the owner of `public_key`.
[[nodiscard]] bool is_signed_by(const std::array<std::uint8_t, 32>& public_key,
                                std::span<const std::uint8_t> message,
                                const std::array<std::uint8_t, 64>& signature);
/// The same of a key and a signature in hexadecimal digits; false when they are none.
[[nodiscard]] bool is_signed_by(const std::string& public_key,
                                std::span<const std::uint8_t> message,
                                const std::string& signature);

}  // namespace cavum
