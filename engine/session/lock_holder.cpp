#include "engine/session/lock_holder.h"

#include <fmt/core.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "engine/base/text.h"

namespace cavum {
namespace {

namespace fs = std::filesystem;

bool has_open(long process, const struct stat& file) {
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(fmt::format("/proc/{}/fd", process), none)) {
    struct stat info {};
    if (::stat(entry.path().c_str(), &info) == 0 && info.st_dev == file.st_dev &&
        info.st_ino == file.st_ino)
      return true;
  }
  return false;
}

/// Processes that hold a lock for writing on the file, each once, in the order of /proc/locks.
void add_writers(const std::string& path, std::vector<long>& out) {
  struct stat file {};
  if (::stat(path.c_str(), &file) != 0) return;
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    std::istringstream words(line);
    std::string number, kind, how, mode, place;
    long process = 0;
    // "7: POSIX  ADVISORY  WRITE 4711 fd:01:1234 120 120"; of one who waits for it "7: -> POSIX
    // ..."
    if (!(words >> number >> kind >> how >> mode >> process >> place) || mode != "WRITE" ||
        process <= 0)
      continue;
    unsigned major_number = 0, minor_number = 0;
    unsigned long long inode = 0;
    if (std::sscanf(place.c_str(), "%x:%x:%llu", &major_number, &minor_number, &inode) != 3 ||
        inode != file.st_ino)
      continue;
    // some file systems show another device there than stat() does
    const bool same_device =
        major_number == major(file.st_dev) && minor_number == minor(file.st_dev);
    if (!same_device && !has_open(process, file)) continue;
    if (std::find(out.begin(), out.end(), process) == out.end()) out.push_back(process);
  }
}

std::string name_of(long process) {
  std::ifstream in(fmt::format("/proc/{}/comm", process));
  std::string name;
  std::getline(in, name);
  return name;
}

}  // namespace

Message holder_of(const std::string& database_path) {
  std::vector<long> writers;
  for (const char* end : {"", "-shm"}) add_writers(database_path + end, writers);
  const auto other =
      std::find_if(writers.begin(), writers.end(), [](long p) { return p != ::getpid(); });
  if (other != writers.end())
    return msg("is held by another program: {} (process {})", name_of(*other), *other);
  return writers.empty() ? msg("is held by another program")
                         : msg("is held by this program itself");
}

}  // namespace cavum
