#include "engine/base/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "engine/base/error.h"

namespace cavum {
namespace {

/// Closes on every way out.
struct File {
  int fd;
  ~File() {
    if (fd >= 0) ::close(fd);
  }
};

std::string reason() { return std::strerror(errno); }

}  // namespace

std::string station_path(const std::string& name) {
  if (const char* home = std::getenv("CAVUM_HOME"); home != nullptr && *home != 0) return std::string(home) + "/" + name;
  if (const char* home = std::getenv("HOME"); home != nullptr && *home != 0) return std::string(home) + "/.config/cavum/" + name;
  throw Error(name, "neither CAVUM_HOME nor HOME is set", "set CAVUM_HOME to the station's own folder");
}

Bytes read_file(const std::string& path) {
  if (path.empty()) throw Error("file", "its name is empty", "name a file");
  const File file{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  if (file.fd < 0) throw Error(path, "cannot be opened (" + reason() + ")", "check the path and its permissions");
  struct stat info {};
  if (::fstat(file.fd, &info) == 0 && S_ISDIR(info.st_mode)) throw Error(path, "is a folder", "name a file");
  Bytes bytes;
  std::uint8_t block[1 << 16];
  for (;;) {
    const auto n = ::read(file.fd, block, sizeof block);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw Error(path, "cannot be read (" + reason() + ")", "check the disk and the permissions");
    if (n == 0) return bytes;
    bytes.insert(bytes.end(), block, block + n);
  }
}

std::string read_text_file(const std::string& path) {
  const Bytes b = read_file(path);
  return {reinterpret_cast<const char*>(b.data()), b.size()};
}

}  // namespace cavum
