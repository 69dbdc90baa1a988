#include "grading/records/witness.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <sstream>

#include "engine/base/file.h"
#include "engine/base/file_name.h"
#include "engine/base/system_error.h"
#include "engine/session/session.h"
#include "grading/records/ledger_key.h"

namespace cavum::records {

std::string witness_path(const std::string& ledger_id) {
  return station_path("witness/" + file_name_of(ledger_id));
}

std::vector<Checkpoint> read_witness(const std::string& id, Findings& findings) {
  std::vector<Checkpoint> out;
  const std::string path = witness_path(id);
  if (!std::filesystem::exists(path)) return out;
  std::istringstream lines(read_text_file(path));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    Checkpoint p;
    std::string root, signature;
    if (!(words >> p.size >> root >> p.utc_ns >> signature)) continue;
    const auto bytes = from_base64(signature);
    if (!bytes || bytes->size() != p.signature.size()) continue;
    std::copy(bytes->begin(), bytes->end(), p.signature.begin());
    try {
      p.root = fixed_from_hex<32>(root, path);
    } catch (const Error&) {
      findings.push_back(finding<FindingKind::witness_changed>(path, p.size));
      break;
    }
    out.push_back(p);
  }
  return out;
}

namespace {

int open_witness(const std::string& path) {
  make_private_folder(std::filesystem::path(path).parent_path().string());
  return ::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_NOFOLLOW | O_CLOEXEC, 0600);
}

}  // namespace

void make_room_for_witness(const std::string& id, std::size_t lines) {
  constexpr off_t k_longest_line = 256;
  const std::string path = witness_path(id);
  const int fd = open_witness(path);
  const bool held =
      fd >= 0 && (::fallocate(fd, FALLOC_FL_KEEP_SIZE, ::lseek(fd, 0, SEEK_END),
                              k_longest_line * static_cast<off_t>(lines)) == 0 ||
                  errno == EOPNOTSUPP || errno == ENOSYS);  // a file system that promises nothing
  const int why = errno;
  if (fd >= 0) ::close(fd);
  if (!held)
    throw DatabaseError(
        path, msg("the ledger's witness has no room for a line ({})", system_words(why)),
        msg("make room on the disk, or the folder writable; nothing was entered"), DiskRefusal{});
}

void tell_witness(const std::string& id, const Checkpoint& p) {
  const std::string path = witness_path(id);
  std::string line =
      fmt::format("{} {} {} {}\n", p.size, to_hex(p.root), p.utc_ns, to_base64(p.signature));
  const int fd = open_witness(path);
  char last = '\n';  // after a line that a power cut left short, a new one begins
  const off_t end = fd >= 0 ? ::lseek(fd, 0, SEEK_END) : 0;
  if (end > 0 && ::pread(fd, &last, 1, end - 1) == 1 && last != '\n') line.insert(0, "\n");
  const bool told = fd >= 0 &&
                    ::write(fd, line.data(), line.size()) == static_cast<ssize_t>(line.size()) &&
                    ::fsync(fd) == 0;
  const int why = errno;
  if (fd >= 0) ::close(fd);
  if (told && end == 0) {  // the file is new, and perhaps its folder
    sync_folder_of(path);
    sync_folder_of(std::filesystem::path(path).parent_path().string());
  }
  if (!told)
    throw Error(
        path,
        msg("the entry is in the ledger, but its witness cannot be told ({})", system_words(why)),
        msg("make the folder writable; the next entry tells it again"));
}

}  // namespace cavum::records
