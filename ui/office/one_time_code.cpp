#include "ui/office/one_time_code.h"

#include <liboath/oath.h>
#include <sodium.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <new>
#include <nlohmann/json.hpp>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/write_file.h"

namespace cavum::office {
namespace {

constexpr std::size_t k_secret_bytes = 20;

using Made = std::unique_ptr<char, void (*)(void*)>;

const char* letters(const Bytes& bytes) { return reinterpret_cast<const char*>(bytes.data()); }

}  // namespace

std::string one_time_code(const Bytes& secret, std::uint64_t counter, int digits) {
  std::array<char, 9> code{};
  if (oath_hotp_generate(letters(secret), secret.size(), counter, static_cast<unsigned>(digits),
                         false, OATH_HOTP_DYNAMIC_TRUNCATION, code.data()) != OATH_OK)
    throw Error("liboath", msg("does not start"), msg("check the installation of liboath"));
  return code.data();
}

std::optional<std::uint64_t> counter_of_code(const Bytes& secret, const std::string& code,
                                             std::int64_t unix_s) {
  const auto now = static_cast<std::uint64_t>(unix_s / k_code_step_s);
  std::optional<std::uint64_t> found;
  for (std::uint64_t counter = now - 1; counter <= now + 1; ++counter) {
    const std::string right = one_time_code(secret, counter);
    if (code.size() == right.size() && sodium_memcmp(code.data(), right.data(), right.size()) == 0)
      found = counter;
  }
  return found;
}

UsedCodes::UsedCodes(std::string path) : path_(std::move(path)) {
  if (!std::filesystem::exists(path_)) return;
  const nlohmann::json kept = parse_json(read_text_file(path_), path_);
  for (const auto& [account, counter] : kept.items())
    last_[account] = require_whole<std::uint64_t>(kept, account.c_str(), path_);
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
  char* text = nullptr;
  if (oath_base32_encode(letters(bytes), bytes.size(), &text, nullptr) != OATH_OK)
    throw std::bad_alloc();
  const Made made(text, std::free);
  const std::string padded = text;
  return padded.substr(0, padded.find('='));
}

std::optional<Bytes> from_base32(const std::string& text) {
  char* bytes = nullptr;
  std::size_t size = 0;
  if (oath_base32_decode(text.data(), text.size(), &bytes, &size) != OATH_OK) return std::nullopt;
  const Made made(bytes, std::free);
  return Bytes(bytes, bytes + size);
}

}  // namespace cavum::office
