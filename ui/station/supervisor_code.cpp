#include "ui/station/supervisor_code.h"

#include <fmt/core.h>
#include <sodium.h>

#include <array>
#include <filesystem>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/text.h"

namespace cavum::station {
namespace {

constexpr char k_code_head[] = "cavum supervisor code 1 (Argon2id): ";

void require_sodium() {
  if (sodium_init() < 0)
    throw Error(Name{"libsodium"}, msg("cannot be used on this computer"), msg("install it again"));
}

}  // namespace

std::string supervisor_code_path() { return station_path("supervisor.code"); }

void set_supervisor_code(const std::string& code, const std::string& path) {
  if (code.size() < k_shortest_supervisor_code || code.size() > k_longest_supervisor_code ||
      !is_plain_text(code))
    throw Error(msg("the supervisor's code"),
                msg("has {} characters, or some that cannot be typed", code.size()),
                msg("give {} to {} letters and digits", k_shortest_supervisor_code,
                    k_longest_supervisor_code));
  require_sodium();
  std::array<char, crypto_pwhash_STRBYTES> hash{};
  if (crypto_pwhash_str(hash.data(), code.data(), code.size(), crypto_pwhash_OPSLIMIT_INTERACTIVE,
                        crypto_pwhash_MEMLIMIT_INTERACTIVE) != 0)
    throw Error(msg("the supervisor's code"), msg("cannot be hashed: there is no memory for it"),
                msg("close other programs"));
  if (const auto folder = std::filesystem::path(path).parent_path(); !folder.empty())
    make_private_folder(folder.string());
  write_private_text_file(path, k_code_head + std::string(hash.data()) + "\n");
}

std::string read_supervisor_code(const std::string& path) {
  if (!std::filesystem::exists(path))
    throw Error(Name{path}, msg("holds no supervisor's code: nobody could leave a locked station"),
                msg("set one: cavum station --set-supervisor-code"));
  std::string text = read_text_file(path);
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  const std::string hash = text.starts_with(k_code_head) ? text.substr(sizeof k_code_head - 1) : "";
  if (!hash.starts_with("$argon2") || hash.size() >= crypto_pwhash_STRBYTES)
    throw Error(Name{path}, msg("is no supervisor's code"),
                msg("set one anew: cavum station --set-supervisor-code"));
  return hash;
}

bool is_supervisor_code(const std::string& hash, const std::string& code) {
  require_sodium();
  std::array<char, crypto_pwhash_STRBYTES> kept{};
  hash.copy(kept.data(), kept.size() - 1);
  return crypto_pwhash_str_verify(kept.data(), code.data(), code.size()) == 0;
}

}  // namespace cavum::station
