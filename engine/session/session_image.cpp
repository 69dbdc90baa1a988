#include "engine/session/session_image.h"

#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>
#include <optional>

#include "engine/base/file.h"
#include "engine/base/scratch_folder.h"
#include "engine/base/system_error.h"
#include "engine/session/sqlite.h"

namespace cavum {
namespace {

constexpr std::int64_t k_largest_file = 2'000'000'000;
constexpr char k_magic[] = "SQLite format 3";  // 16 bytes with its zero

void check_file(const std::string& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0)
    throw Error(system_code(errno), Name{path}, msg("cannot be opened ({})", system_words(errno)),
                msg("check the path"));
  if (!S_ISREG(info.st_mode))
    throw Error(path, msg("is not a regular file"), msg("name a session file"));
  if (info.st_size > k_largest_file)
    throw Error(path, msg("is larger than any session"), msg("name a session file"));
}

std::optional<Bytes> read_adjacent(const std::string& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0 || !S_ISREG(info.st_mode) || info.st_size == 0 ||
      info.st_size > k_largest_file)
    return std::nullopt;
  return read_file(path);
}

Bytes apply(const Bytes& file, const std::optional<Bytes>& log,
            const std::optional<Bytes>& journal) {
  const ScratchFolder folder;
  const std::string copy = folder.file("copy");
  write_file(copy, file);
  if (log) write_file(copy + "-wal", *log);
  if (journal) write_file(copy + "-journal", *journal);
  Database database = Database::open(copy, false);
  // exclusive: the index of the log then stays in memory
  database.run(
      "PRAGMA locking_mode = EXCLUSIVE; PRAGMA cell_size_check = ON; SELECT count(*) FROM sqlite_schema; PRAGMA journal_mode = DELETE");
  database.close();
  return read_file(copy);
}

}  // namespace

void require_session_image(const Bytes& file, const std::string& path) {
  if (file.empty()) throw Error(path, msg("is empty"), msg("name a session file"));
  if (file.size() < 100 || std::memcmp(file.data(), k_magic, sizeof k_magic) != 0)
    throw Error(path, msg("is not a session file (no SQLite header)"),
                msg("name a .cavum file that an exam wrote, or use an intact copy"));
}

Bytes read_session_image(const std::string& path, Damages& findings) {
  check_file(path);
  Bytes file;
  std::optional<Bytes> log, journal;
  // A recorder may be writing. While the log stays the same, the file beside it only gains pages
  // that the log holds too; so a pair is consistent when the log did not change while the file was
  // read.
  for (int attempt = 0; attempt < 20; ++attempt) {
    log = read_adjacent(path + "-wal");
    journal = read_adjacent(path + "-journal");
    file = read_file(path);
    if (log == read_adjacent(path + "-wal") && journal == read_adjacent(path + "-journal")) break;
  }
  require_session_image(file, path);
  if (!log && !journal) return file;
  try {
    return apply(file, log, journal);
  } catch (const DatabaseError& e) {
    findings.push_back(damage<DamageKind::log_left_out>(e.where_and_problem()));
    return file;
  }
}

}  // namespace cavum
