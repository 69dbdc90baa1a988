#include "ui/office/pieces.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sodium.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <regex>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/hash.h"
#include "engine/session/sqlite.h"

namespace cavum::office {
namespace {

/// A descriptor that is closed.
class OpenFile {
 public:
  OpenFile(const std::string& path, int how)
      : number_(::open(path.c_str(), how | O_CLOEXEC | O_NOFOLLOW, 0600)) {
    if (number_ < 0)
      throw DatabaseError(path, msg("cannot be opened"),
                          msg("make room on the disk, and send it again"),
                          {DiskFault::input_output});
  }
  ~OpenFile() { ::close(number_); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  [[nodiscard]] int number() const noexcept { return number_; }

 private:
  int number_;
};

bool write_at(int file, std::uint64_t at, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(file, bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (written <= 0 && errno != EINTR) return false;
    if (written <= 0) continue;
    at += static_cast<std::uint64_t>(written);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace

Pieces::Pieces(std::string folder, Whole whole, std::function<std::int64_t()> now_s,
               const PiecesLimits& limits)
    : folder_(std::move(folder)),
      whole_(std::move(whole)),
      now_s_(std::move(now_s)),
      limits_(limits) {
  make_private_folder(folder_);
  static const std::regex k_name("([0-9a-f]{64})-([0-9a-f]{64})-([0-9]{1,9})");
  std::vector<std::string> unknown;
  for (const auto& file : std::filesystem::directory_iterator(folder_)) {
    const std::string name = file.path().filename().string();
    std::smatch found;
    struct stat facts {};
    const bool ours = std::regex_match(name, found, k_name) &&
                      ::lstat(file.path().c_str(), &facts) == 0 && S_ISREG(facts.st_mode);
    const std::uint64_t of = ours ? std::stoull(found[3]) : 0,
                        have = ours ? static_cast<std::uint64_t>(facts.st_size) : 0;
    if (!ours || have >= of)
      unknown.push_back(
          file.path()
              .string());  // whole, and its server ended before it was checked: it is sent again
    else
      uploads_[{found[1], found[2]}] = {have, of, facts.st_mtime, false};
  }
  for (const auto& path : unknown) std::filesystem::remove_all(path);
  remove_old();
}

std::string Pieces::path_of(const Key& key, std::uint64_t of) const {
  return fmt::format("{}/{}-{}-{}", folder_, key.first, key.second, of);
}

void Pieces::remove(const Key& key) {
  const auto found = uploads_.find(key);
  if (found == uploads_.end()) return;
  ::unlink(path_of(key, found->second.of).c_str());
  uploads_.erase(found);
}

void Pieces::remove_old() {
  std::vector<Key> old;
  for (const auto& [key, u] : uploads_)
    if (!u.checked && now_s_() - u.last_s > k_life_of_pieces_s) old.push_back(key);
  for (const Key& key : old) remove(key);
}

void Pieces::begin(const Key& key, std::uint64_t of) {
  std::size_t own = 0;
  std::uint64_t announced = of;
  const Key* oldest = nullptr;
  for (const auto& [other, u] : uploads_) {
    announced += u.of;
    if (other.first != key.first) continue;
    ++own;
    if (!u.checked && (oldest == nullptr || u.last_s < uploads_.at(*oldest).last_s))
      oldest = &other;
  }
  if (own >= limits_.of_a_station) {
    if (oldest == nullptr)
      throw Error(msg("the session"), msg("is one too many at once"),
                  msg("wait until the others are checked"));
    announced -= uploads_.at(*oldest).of;
    remove(Key(*oldest));
  }
  if (announced > limits_.all_bytes)
    throw DatabaseError(folder_, msg("holds as many exams that are not whole as it may"),
                        msg("wait until others are handed in"), {DiskFault::full});
  uploads_[key] = {0, of, now_s_(), false};
}

Pieces::Have Pieces::have(const std::string& station, const std::string& sha256) {
  const std::lock_guard guard(lock_);
  remove_old();
  const auto found = uploads_.find({station, sha256});
  return found == uploads_.end() ? Have{}
                                 : Have{found->second.have, found->second.of, false, false};
}

Pieces::Have Pieces::add(const std::string& station, const std::string& sha256, std::uint64_t at,
                         std::uint64_t of, std::string_view bytes) {
  const Key key{station, sha256};
  std::unique_lock guard(lock_);
  remove_old();
  if (of == 0 || of > k_largest_session)
    throw Error(msg("the session"), msg("is empty, or too large"),
                msg("hand in an exam of at most 256 MB"));
  if (bytes.empty() || bytes.size() > k_largest_piece)
    throw Error(msg("the piece"), msg("is empty, or too large"), msg("send at most 1 MB at once"));
  if (at > of || bytes.size() > of - at)
    throw Error(msg("the piece"), msg("goes beyond the end of the session"), msg("send it again"));
  if (bytes.size() < k_smallest_piece && at + bytes.size() != of)
    throw Error(msg("the piece"), msg("is too small"),
                msg("send 64 kB at least, but for the last one"));
  if (!uploads_.contains(key)) {
    if (at != 0) return {0, 0, false, false};
    begin(key, of);
  }
  Upload& u = uploads_.at(key);
  if (u.checked || u.of != of || u.have != at) return {u.have, u.of, false, false};
  const std::string path = path_of(key, of);
  {
    const OpenFile file(path, O_WRONLY | O_CREAT);
    if (!write_at(file.number(), at, bytes)) {
      static_cast<void>(::ftruncate(file.number(), static_cast<off_t>(at)));
      throw DatabaseError(folder_, msg("cannot be written"),
                          msg("make room on the disk, and send it again"),
                          {DiskFault::input_output});
    }
  }
  u.have += bytes.size();
  u.last_s = now_s_();
  if (u.have < of) return {u.have, of, true, false};
  u.checked = true;  // nobody changes the file while the others go on
  guard.unlock();
  bool whole = false;
  try {
    whole = is_whole(path, sha256);
    if (whole) whole_(path, sha256, station);
  } catch (...) {
    guard.lock();
    remove(key);
    throw;
  }
  guard.lock();
  remove(key);
  if (!whole)
    throw Error(msg("the session"), msg("is not the one whose hash was named"),
                msg("send it again"));
  return {of, of, true, true};
}

bool Pieces::is_whole(const std::string& path, const std::string& sha256) const {
  const OpenFile file(path, O_RDONLY);
  crypto_hash_sha256_state state{};
  crypto_hash_sha256_init(&state);
  std::vector<unsigned char> part(k_largest_piece);
  for (ssize_t n = 0; (n = ::read(file.number(), part.data(), part.size())) != 0;) {
    if (n < 0 && errno == EINTR) continue;
    if (n < 0)
      throw DatabaseError(path, msg("cannot be read"), msg("look at the disk, and send it again"),
                          {DiskFault::input_output});
    crypto_hash_sha256_update(&state, part.data(), static_cast<std::size_t>(n));
  }
  Sha256 hash{};
  crypto_hash_sha256_final(&state, hash.data());
  if (to_hex(hash) != sha256) return false;
  if (::fsync(file.number()) != 0)
    throw DatabaseError(path, msg("cannot be written"),
                        msg("make room on the disk, and send it again"), {DiskFault::input_output});
  return true;
}

}  // namespace cavum::office
