#include "engine/base/file.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>

#include "engine/base/error.h"
#include "engine/base/file_error.h"
#include "engine/base/system_error.h"

namespace cavum {
namespace {

/// Closes on every way out.
struct File {
  int fd;
  ~File() {
    if (fd >= 0) ::close(fd);
  }
};

/// All of the file, as bytes or as text. What fstat says of the size is only a guess: files of /sys
/// say 4096, and one may grow meanwhile.
template <class Content>
Content read_as(const std::string& path, std::uint64_t largest) {
  if (path.empty()) throw Error(msg("file"), msg("its name is empty"), msg("name a file"));
  const File file{
      ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK |
                               O_NOCTTY)};  // a pipe that nobody writes to must not hold us
  if (file.fd < 0)
    throw Error(system_code(errno), Name{path}, msg("cannot be opened ({})", system_words(errno)),
                msg("check the path and its permissions"));
  struct stat info {};
  if (::fstat(file.fd, &info) != 0)
    throw Error(path, msg("cannot be read ({})", system_words(errno)),
                msg("check the disk and the permissions"));
  if (S_ISDIR(info.st_mode))
    throw Error(FileError::not_a_file, Name{path}, msg("is a folder"), msg("name a file"));
  if (!S_ISREG(info.st_mode))
    throw Error(FileError::not_a_file, Name{path},
                msg("is no ordinary file but a device, a pipe or a socket"), msg("name a file"));
  const auto require_size = [&](std::uint64_t size) {
    if (size > largest)
      throw Error(FileError::too_large, Name{path},
                  msg("is larger than {} bytes, the most that is read of such a file", largest),
                  msg("name an intact file"));
  };
  require_size(static_cast<std::uint64_t>(info.st_size));
  Content content;
  content.reserve(static_cast<std::size_t>(info.st_size));
  std::uint8_t block[1 << 16];
  for (;;) {
    const auto n = ::read(file.fd, block, sizeof block);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0)
      throw Error(path, msg("cannot be read ({})", system_words(errno)),
                  msg("check the disk and the permissions"));
    if (n == 0) return content;
    require_size(content.size() + static_cast<std::uint64_t>(n));
    content.insert(content.end(), block, block + n);
  }
}

}  // namespace

std::string station_path(const std::string& name) {
  if (const char* home = std::getenv("CAVUM_HOME"); home != nullptr && *home != 0)
    return fmt::format("{}/{}", home, name);
  if (const char* home = std::getenv("HOME"); home != nullptr && *home != 0)
    return fmt::format("{}/.config/cavum/{}", home, name);
  throw Error(name, msg("neither CAVUM_HOME nor HOME is set"),
              msg("set CAVUM_HOME to the station's own folder"));
}

Bytes read_file(const std::string& path, std::uint64_t largest) {
  return read_as<Bytes>(path, largest);
}

std::string read_text_file(const std::string& path, std::uint64_t largest) {
  return read_as<std::string>(path, largest);
}

}  // namespace cavum
