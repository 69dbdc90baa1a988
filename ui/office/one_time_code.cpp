#include "ui/office/one_time_code.h"

#include <fmt/core.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <sodium.h>

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/write_file.h"

namespace cavum::office {
namespace {

constexpr char k_letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZ234567";
constexpr std::size_t k_secret_bytes = 20;

}  // namespace

std::string one_time_code(const Bytes& secret, std::uint64_t counter, int digits) {
  std::array<std::uint8_t, 8> message{};
  for (std::size_t i = 0; i < message.size(); ++i) message[i] = static_cast<std::uint8_t>(counter >> (8 * (7 - i)));
  std::array<std::uint8_t, EVP_MAX_MD_SIZE> mac{};
  unsigned size = 0;
  if (HMAC(EVP_sha1(), secret.data(), static_cast<int>(secret.size()), message.data(), message.size(), mac.data(), &size) == nullptr)
    throw Error(msg("OpenSSL"), msg("makes no HMAC-SHA-1"), msg("allow SHA-1 for HMAC in this computer's settings of OpenSSL"));
  const std::size_t at = mac[size - 1] & 0x0fU;
  const std::uint32_t cut = ((mac[at] & 0x7fU) << 24U) | (std::uint32_t{mac[at + 1]} << 16U) | (std::uint32_t{mac[at + 2]} << 8U) | mac[at + 3];
  std::uint32_t modulus = 1;
  for (int i = 0; i < digits; ++i) modulus *= 10;
  return fmt::format("{:0{}}", cut % modulus, digits);
}

std::optional<std::uint64_t> counter_of_code(const Bytes& secret, const std::string& code, std::int64_t unix_s) {
  const auto now = static_cast<std::uint64_t>(unix_s / k_code_step_s);
  std::optional<std::uint64_t> found;
  for (std::uint64_t counter = now - 1; counter <= now + 1; ++counter) {
    const std::string right = one_time_code(secret, counter);
    if (code.size() == right.size() && sodium_memcmp(code.data(), right.data(), right.size()) == 0) found = counter;
  }
  return found;
}

UsedCodes::UsedCodes(std::string path) : path_(std::move(path)) {
  if (!std::filesystem::exists(path_)) return;
  const nlohmann::json kept = parse_json(read_text_file(path_), path_);
  for (const auto& [account, counter] : kept.items()) last_[account] = require_whole<std::uint64_t>(kept, account.c_str(), path_);
}

bool UsedCodes::use(const std::string& account, std::uint64_t counter) {
  const std::lock_guard guard(lock_);
  const auto last = last_.find(account);
  if (last != last_.end() && counter <= last->second) return false;
  std::map<std::string, std::uint64_t> now = last_;
  now[account] = counter;
  write_private_text_file(path_, nlohmann::json(now).dump() + "\n");
  last_ = std::move(now);
  return true;
}

Bytes new_code_secret() {
  Bytes secret(k_secret_bytes);
  randombytes_buf(secret.data(), secret.size());
  return secret;
}

std::string base32(const Bytes& bytes) {
  std::string out;
  std::uint32_t held = 0;
  int bits = 0;
  for (const auto b : bytes) {
    held = (held << 8U) | b;
    for (bits += 8; bits >= 5; bits -= 5) out += k_letters[(held >> (bits - 5)) & 31U];
  }
  if (bits > 0) out += k_letters[(held << (5 - bits)) & 31U];
  return out;
}

std::optional<Bytes> from_base32(const std::string& text) {
  Bytes out;
  std::uint32_t held = 0;
  int bits = 0;
  const std::string letters = k_letters;
  for (const char c : text) {
    const auto value = letters.find(c);
    if (value == std::string::npos) return std::nullopt;
    held = (held << 5U) | static_cast<std::uint32_t>(value);
    bits += 5;
    if (bits >= 8) out.push_back(static_cast<std::uint8_t>(held >> (bits -= 8)));
  }
  return out;
}

}  // namespace cavum::office
