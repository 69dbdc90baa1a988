#include "grading/ledger/ledger_key.h"

#include <sodium.h>

#include <filesystem>

#include "engine/base/file.h"
#include "engine/base/hash.h"

namespace cavum {

std::string school_key_path() { return station_path("school.key"); }

std::string school_public_key_path() { return station_path("school.pub"); }

SigningKey load_school_key(const std::string& path, bool make) {
  if (!make && !std::filesystem::exists(path))
    throw Error(path, "the school's key is not there", "restore it from its backup, or name its place with --key or CAVUM_HOME");
  return load_signing_key(path, "school");
}

std::string random_hex(std::size_t bytes) {
  if (sodium_init() < 0) throw Error("libsodium", "does not start", "check the installation of libsodium");
  Bytes b(bytes);
  randombytes_buf(b.data(), b.size());
  return to_hex(b);
}

Bytes from_hex(const std::string& hex, std::size_t bytes, const std::string& where) {
  Bytes out(bytes);
  std::size_t read = 0;
  const bool whole = hex.size() == 2 * bytes && hex.find_first_not_of("0123456789abcdef") == std::string::npos &&
                     sodium_hex2bin(out.data(), out.size(), hex.data(), hex.size(), nullptr, &read, nullptr) == 0 && read == bytes;
  if (!whole) throw Error(where, "is not " + std::to_string(2 * bytes) + " hexadecimal digits in lower case", "use an intact copy");
  return out;
}

std::string pseudonym_of(const SigningKey& school, std::span<const std::uint8_t> salt, const std::string& identity) {
  static constexpr char k_digits[] = "0123456789ABCDEFGHJKMNPQRSTVWXYZ";
  static constexpr char k_purpose[] = "CVPSEUD1";
  Bytes message(k_purpose, k_purpose + 8);
  message.insert(message.end(), salt.begin(), salt.end());
  message.insert(message.end(), identity.begin(), identity.end());
  // the seed is the secret half of the key; crypto_auth_hmacsha256 takes 32 bytes
  std::array<std::uint8_t, crypto_auth_hmacsha256_BYTES> tag{};
  crypto_auth_hmacsha256(tag.data(), message.data(), message.size(), school.secret_key.data());
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < 8; ++i) bits = bits << 8 | tag[i];
  std::string out = "C";
  for (int i = 0; i < 12; ++i) {
    if (i % 4 == 0) out += '-';
    out += k_digits[bits >> 59];
    bits <<= 5;
  }
  return out;
}

}  // namespace cavum
