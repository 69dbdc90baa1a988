#include "engine/base/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

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

/// Renaming onto a device, a pipe or a socket would replace it by a file.
void require_no_node(const std::string& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode))
    throw Error(path, "is no ordinary file but a device, a pipe or a socket", "name a file");
}

/// All of the file, as bytes or as text. What fstat says of the size is only a guess: files of /sys say 4096, and one may grow meanwhile.
template <class Content>
Content read_as(const std::string& path, std::uint64_t largest) {
  if (path.empty()) throw Error("file", "its name is empty", "name a file");
  const File file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)};  // a pipe that nobody writes to must not hold us
  if (file.fd < 0) throw Error(path, "cannot be opened (" + reason() + ")", "check the path and its permissions");
  struct stat info {};
  if (::fstat(file.fd, &info) != 0) throw Error(path, "cannot be read (" + reason() + ")", "check the disk and the permissions");
  if (S_ISDIR(info.st_mode)) throw Error(path, "is a folder", "name a file");
  if (!S_ISREG(info.st_mode)) throw Error(path, "is no ordinary file but a device, a pipe or a socket", "name a file");
  const auto require_size = [&](std::uint64_t size) {
    if (size > largest)
      throw Error(path, "is larger than " + std::to_string(largest) + " bytes, the most that is read of such a file", "name an intact file");
  };
  require_size(static_cast<std::uint64_t>(info.st_size));
  Content content;
  content.reserve(static_cast<std::size_t>(info.st_size));
  std::uint8_t block[1 << 16];
  for (;;) {
    const auto n = ::read(file.fd, block, sizeof block);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw Error(path, "cannot be read (" + reason() + ")", "check the disk and the permissions");
    if (n == 0) return content;
    require_size(content.size() + static_cast<std::uint64_t>(n));
    content.insert(content.end(), block, block + n);
  }
}

}  // namespace

std::string station_path(const std::string& name) {
  if (const char* home = std::getenv("CAVUM_HOME"); home != nullptr && *home != 0) return std::string(home) + "/" + name;
  if (const char* home = std::getenv("HOME"); home != nullptr && *home != 0) return std::string(home) + "/.config/cavum/" + name;
  throw Error(name, "neither CAVUM_HOME nor HOME is set", "set CAVUM_HOME to the station's own folder");
}

Bytes read_file(const std::string& path, std::uint64_t largest) { return read_as<Bytes>(path, largest); }

std::string read_text_file(const std::string& path, std::uint64_t largest) { return read_as<std::string>(path, largest); }

void require_writable(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code none;
  if (fs::is_directory(path, none)) throw Error(path, "is a folder", "name a file");
  require_no_node(path);
  const fs::path parent = fs::path(path).parent_path();
  const std::string folder = parent.empty() ? "." : parent.string();
  if (!fs::is_directory(folder, none)) throw Error(path, "cannot be written: there is no folder " + folder, "make it, or name another place");
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw Error(path, "cannot be written: folder " + folder + " is closed to you (" + reason() + ")",
                "change its permissions, or name another place");
}

void write_file(const std::string& path, std::span<const std::uint8_t> bytes) {
  require_no_node(path);
  const std::string temporary = path + ".part";
  const auto fail = [&](const std::string& what) {
    const std::string why = reason();
    ::unlink(temporary.c_str());
    throw Error(path, what + " (" + why + ")", "check that the folder exists, is writable and has room, then try again");
  };
  {
    const File file{::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644)};
    if (file.fd < 0) fail("cannot be created");
    std::size_t done = 0;
    while (done < bytes.size()) {
      const auto n = ::write(file.fd, bytes.data() + done, bytes.size() - done);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) fail("cannot be written");
      done += static_cast<std::size_t>(n);
    }
    if (::fsync(file.fd) != 0) fail("cannot be written to disk");
  }
  if (::rename(temporary.c_str(), path.c_str()) != 0) fail("cannot be put in place");
}

void write_text_file(const std::string& path, const std::string& text) {
  write_file(path, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

}  // namespace cavum
