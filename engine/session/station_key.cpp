#include "engine/session/station_key.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sodium.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/hash.h"
#include "engine/base/system_error.h"

namespace cavum {
namespace {

std::string heading_of(const std::string& owner) {
  return fmt::format("cavum {} key 1 (Ed25519 seed; keep secret): ", owner);
}

void start_sodium() {
  if (sodium_init() < 0)
    throw Error(msg("libsodium"), msg("does not start"),
                msg("check the installation of libsodium"));
}

// link() makes the complete file appear in one step and never replaces a key that another process
// just made.
void make_key(const std::string& path, const std::string& owner) {
  const auto fail = [&](const Message& what) {
    throw Error(path, msg("{} ({})", what, system_words(errno)),
                msg("make its folder writable, or set CAVUM_HOME to a folder that is"));
  };
  make_private_folder(std::filesystem::path(path).parent_path().string());
  std::array<std::uint8_t, crypto_sign_SEEDBYTES> seed{};
  randombytes_buf(seed.data(), seed.size());
  const std::string text = fmt::format("{}{}\n", heading_of(owner), to_hex(seed));
  const std::string temporary = temporary_name_next_to(path);
  const int fd =
      ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
  if (fd < 0) fail(msg("the {}'s key cannot be made", owner));
  const bool written = ::write(fd, text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
                       ::fsync(fd) == 0;
  ::close(fd);
  const bool placed = written && (::link(temporary.c_str(), path.c_str()) == 0 || errno == EEXIST);
  const int why = errno;
  ::unlink(temporary.c_str());
  errno = why;
  if (!placed) fail(msg("the {}'s key cannot be written", owner));
  sync_folder_of(path);
}

}  // namespace

std::array<std::uint8_t, 64> SigningKey::sign(std::span<const std::uint8_t> message) const {
  std::array<std::uint8_t, 64> signature{};
  crypto_sign_detached(signature.data(), nullptr, message.data(), message.size(),
                       secret_key.data());
  return signature;
}

std::string station_key_path() { return station_path("station.key"); }

SigningKey load_signing_key(const std::string& path, const std::string& owner) {
  start_sodium();
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0 && errno == ENOENT) make_key(path, owner);
  if (::stat(path.c_str(), &info) == 0 && (info.st_mode & 077) != 0)
    throw Error(path, msg("the {}'s key may be read by others", owner),
                msg("chmod 600 it, and replace it if someone may have copied it"));
  const std::string text = read_text_file(path);
  const std::string heading = heading_of(owner);
  std::array<std::uint8_t, crypto_sign_SEEDBYTES> seed{};
  std::size_t read = 0;
  const bool whole = text.size() == heading.size() + 2 * seed.size() + 1 &&
                     text.starts_with(heading) && text.back() == '\n' &&
                     sodium_hex2bin(seed.data(), seed.size(), text.data() + heading.size(),
                                    2 * seed.size(), nullptr, &read, nullptr) == 0 &&
                     read == seed.size();
  if (!whole)
    throw Error(path, msg("the {}'s key is damaged", owner),
                msg("restore it from a backup, or remove it and let a new one be made"));
  SigningKey key;
  crypto_sign_seed_keypair(key.public_key.data(), key.secret_key.data(), seed.data());
  return key;
}

namespace {

std::string enrolled_path(const std::string& path) { return path + ".enrolled"; }

}  // namespace

SigningKey load_station_key(const std::string& path) {
  const std::string enrolled = enrolled_path(path);
  if (!std::filesystem::exists(enrolled)) return load_signing_key(path, "station");
  const Message advice = msg(
      "restore the key from its backup, or have the station enrolled anew: remove {} and ask with `cavum station --enrol CODE`",
      enrolled);
  if (!std::filesystem::exists(path))
    throw Error(path, msg("the key that this station was enrolled with is gone"), advice);
  const SigningKey key = load_signing_key(path, "station");
  if (read_text_file(enrolled) != to_hex(key.public_key) + "\n")
    throw Error(path, msg("is not the key that this station was enrolled with"), advice);
  return key;
}

void remember_enrolled(const std::string& path, const SigningKey& key) {
  write_private_text_file(enrolled_path(path), to_hex(key.public_key) + "\n");
}

std::string parse_public_key(const std::string& text, const Where& where) {
  std::string key = text;
  for (char& c : key)
    if (c >= 'A' && c <= 'F') c = static_cast<char>(c - 'A' + 'a');
  if (key.size() != 64 || !from_hex(key))
    throw Error(where, msg("is no public key: 64 hexadecimal digits"),
                msg("copy it from what `cavum replay --verify` says of a session of that station"));
  return key;
}

bool is_signed_by(const std::array<std::uint8_t, 32>& public_key,
                  std::span<const std::uint8_t> message,
                  const std::array<std::uint8_t, 64>& signature) {
  start_sodium();
  return crypto_sign_verify_detached(signature.data(), message.data(), message.size(),
                                     public_key.data()) == 0;
}

bool is_signed_by(const std::string& public_key, std::span<const std::uint8_t> message,
                  const std::string& signature) {
  std::array<std::uint8_t, 32> key{};
  std::array<std::uint8_t, 64> sealed{};
  const auto read = [](auto& bytes, const std::string& hex) {
    std::size_t n = 0;
    return hex.size() == 2 * bytes.size() &&
           sodium_hex2bin(bytes.data(), bytes.size(), hex.data(), hex.size(), nullptr, &n,
                          nullptr) == 0 &&
           n == bytes.size();
  };
  return read(key, public_key) && read(sealed, signature) && is_signed_by(key, message, sealed);
}

}  // namespace cavum
