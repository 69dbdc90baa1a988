#include "grading/records/ledger_key.h"

#include <sodium.h>

#include <filesystem>

#include "engine/base/file.h"
#include "engine/base/hash.h"

namespace cavum::records {

std::string school_key_path() { return station_path("school.key"); }

std::string school_public_key_path() { return station_path("school.pub"); }

SigningKey load_school_key(const std::string& path, bool make) {
  if (!make && !std::filesystem::exists(path))
    throw Error(path, msg("the school's key is not there"),
                msg("restore it from its backup, or name its place with --key or CAVUM_HOME"));
  return load_signing_key(path, "school");
}

std::string random_hex(std::size_t bytes) {
  if (sodium_init() < 0)
    throw Error(msg("libsodium"), msg("does not start"),
                msg("check the installation of libsodium"));
  Bytes b(bytes);
  randombytes_buf(b.data(), b.size());
  return to_hex(b);
}

Bytes from_hex(const std::string& hex, std::size_t bytes, const Where& where) {
  Bytes out(bytes);
  std::size_t read = 0;
  const bool whole =
      hex.size() == 2 * bytes && hex.find_first_not_of("0123456789abcdef") == std::string::npos &&
      sodium_hex2bin(out.data(), out.size(), hex.data(), hex.size(), nullptr, &read, nullptr) ==
          0 &&
      read == bytes;
  if (!whole)
    throw Error(where, msg("is not {} hexadecimal digits in lower case", 2 * bytes),
                msg("use an intact copy"));
  return out;
}

namespace {

using Mac = std::array<std::uint8_t, crypto_auth_hmacsha256_BYTES>;

Mac hmac(std::span<const std::uint8_t> key, std::span<const std::uint8_t> message) {
  crypto_auth_hmacsha256_state state;
  Mac mac{};
  crypto_auth_hmacsha256_init(&state, key.data(), key.size());
  crypto_auth_hmacsha256_update(&state, message.data(), message.size());
  crypto_auth_hmacsha256_final(&state, mac.data());
  return mac;
}

/// "C-" and the first 60 bits of eight bytes.
std::string pseudonym_from(std::span<const std::uint8_t> bytes) {
  static constexpr char k_digits[] = "0123456789ABCDEFGHJKMNPQRSTVWXYZ";
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < 8; ++i) bits = bits << 8 | bytes[i];
  std::string out = "C";
  for (int i = 0; i < 12; ++i) {
    if (i % 4 == 0) out += '-';
    out += k_digits[bits >> 59];
    bits <<= 5;
  }
  return out;
}

}  // namespace

std::array<std::uint8_t, 32> hkdf_sha256(std::span<const std::uint8_t> key_material,
                                         const std::string& info) {
  const std::array<std::uint8_t, 32> no_salt{};
  Bytes first_block(info.begin(), info.end());
  first_block.push_back(1);
  return hmac(hmac(no_salt, key_material), first_block);
}

std::array<std::uint8_t, 32> derived_secret(const SigningKey& key, const std::string& purpose) {
  return hkdf_sha256(std::span(key.secret_key).first(32), purpose);  // the seed is the first half
}

std::string new_pseudonym() { return pseudonym_from(from_hex(random_hex(8), 8, "pseudonym")); }

Bytes identity_seal(const SigningKey& school, const std::string& message) {
  const Mac mac = hmac(derived_secret(school, "cavum identities"),
                       {reinterpret_cast<const std::uint8_t*>(message.data()), message.size()});
  return {mac.begin(), mac.end()};
}

}  // namespace cavum::records
