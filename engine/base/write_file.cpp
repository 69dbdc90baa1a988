#include "engine/base/write_file.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <stdio.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>

#include "engine/base/encoding.h"
#include "engine/base/error.h"
#include "engine/base/file_error.h"
#include "engine/base/system_error.h"
#include "engine/base/text.h"

namespace cavum {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_try_again =
    noop("check that the folder exists, is writable and has room, then try again");

/// Closes on every way out.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const noexcept { return fd_; }

 private:
  int fd_;
};

std::string folder_of(const std::string& path) {
  const fs::path parent = fs::path(path).parent_path();
  return parent.empty() ? "." : parent.string();
}

/// Renaming onto a device, a pipe or a socket would replace it by a file.
void require_no_node(const std::string& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode))
    throw Error(FileError::not_a_file, Name{path},
                msg("is no ordinary file but a device, a pipe or a socket"), msg("name a file"));
}

/// 0, or the errno of what failed; `what` then says it.
int write_all(int fd, std::span<const std::uint8_t> bytes, Message& what) {
  what = msg("cannot be written");
  for (std::size_t done = 0; done < bytes.size();) {
    const auto n = ::write(fd, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return n == 0 ? EIO : errno;
    done += static_cast<std::size_t>(n);
  }
  what = msg("cannot be written to disk");
  return ::fsync(fd) == 0 ? 0 : errno;
}

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// renameat2 with RENAME_NOREPLACE; where the file system does not know it, a second name that is
/// made in one step; where it has no second names either (some sticks and network folders), a look
/// and a rename.
bool rename_new(const std::string& made, const std::string& path) {
  if (::renameat2(AT_FDCWD, made.c_str(), AT_FDCWD, path.c_str(), RENAME_NOREPLACE) == 0)
    return true;
  if (errno != EINVAL && errno != ENOSYS) return false;
  if (::link(made.c_str(), path.c_str()) == 0) return ::unlink(made.c_str()) == 0;
  if (errno != EPERM && errno != ENOTSUP && errno != ENOSYS) return false;
  struct stat info {};
  if (::lstat(path.c_str(), &info) == 0) errno = EEXIST;
  return errno == ENOENT && ::rename(made.c_str(), path.c_str()) == 0;
}

}  // namespace

void require_writable(const std::string& path) {
  std::error_code none;
  if (fs::is_directory(path, none))
    throw Error(FileError::not_a_file, Name{path}, msg("is a folder"), msg("name a file"));
  require_no_node(path);
  const std::string folder = folder_of(path);
  if (!fs::is_directory(folder, none))
    throw Error(FileError::not_written, Name{path},
                msg("cannot be written: there is no folder {}", folder),
                msg("make it, or name another place"));
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw Error(
        FileError::not_written, Name{path},
        msg("cannot be written: folder {} is closed to you ({})", folder, system_words(errno)),
        msg("change its permissions, or name another place"));
}

std::string temporary_name_next_to(const std::string& path) {
  std::array<unsigned char, 12> drawn{};
  if (::getrandom(drawn.data(), drawn.size(), 0) != static_cast<ssize_t>(drawn.size()))
    throw Error(path, msg("the system gives no random numbers ({})", system_words(errno)),
                msg("try again"));
  return (fs::path(path).parent_path() / fmt::format(".cavum-{}.part", to_hex(drawn))).string();
}

void write_file(const std::string& path, std::span<const std::uint8_t> bytes, const Writing& how) {
  require_no_node(path);
  const std::string temporary = temporary_name_next_to(path);
  const auto fail = [&](const Message& what, int error) {
    ::unlink(temporary.c_str());
    throw Error(error == EEXIST ? FileError::exists : FileError::not_written, Name{path},
                msg("{} ({})", what, system_words(error)), msg(k_try_again));
  };
  {
    const Descriptor file(::open(temporary.c_str(),
                                 O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC,
                                 how.is_private ? 0600 : 0666));
    if (file.get() < 0)
      throw Error(FileError::not_written, Name{path},
                  msg("cannot be created ({})", system_words(errno)), msg(k_try_again));
    Message what;
    if (const int error = write_all(file.get(), bytes, what); error != 0) fail(what, error);
  }
  if (how.may_replace ? ::rename(temporary.c_str(), path.c_str()) != 0
                      : !rename_new(temporary, path))
    fail(errno == EEXIST ? msg("is there already") : msg("cannot be put in place"), errno);
  sync_folder_of(path);
}

void write_text_file(const std::string& path, const std::string& text, const Writing& how) {
  write_file(path, bytes_of(text), how);
}
void write_private_file(const std::string& path, std::span<const std::uint8_t> bytes) {
  write_file(path, bytes, {.is_private = true});
}
void write_private_text_file(const std::string& path, const std::string& text) {
  write_private_file(path, bytes_of(text));
}

void make_private_file(const std::string& path) {
  const Descriptor file(
      ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600));
  if (file.get() >= 0) return;
  if (errno == EEXIST)
    throw Error(FileError::exists, Name{path}, msg("is there already"),
                msg("choose another name: nothing is written over it"));
  throw Error(FileError::not_written, Name{path},
              msg("cannot be created ({})", system_words(errno)), msg(k_try_again));
}

void make_private_folder(const std::string& path) {
  fs::path made;
  for (const auto& part : fs::path(path)) {
    made /= part;
    if (made.empty()) continue;
    if (::mkdir(made.c_str(), 0700) == 0) {
      sync_folder_of(made.string());
      continue;
    }
    const int error = errno;
    std::error_code none;
    if (!fs::is_directory(made, none))
      throw Error(FileError::not_written, Name{path},
                  msg("cannot be made ({})", system_words(error)),
                  msg("name another folder, or make it yourself"));
  }
}

bool put_in_place(const std::string& made, const std::string& path) {
  if (!rename_new(made, path)) {
    if (errno == EEXIST) return false;
    throw Error(path, msg("cannot be put in place ({})", system_words(errno)),
                msg("check the folder and the disk"));
  }
  try {
    sync_folder_of(path);
  } catch (const Error&) {
    ::rename(path.c_str(), made.c_str());
    throw;
  }
  return true;
}

void sync_folder_of(const std::string& path) {
  const std::string folder = folder_of(path);
  const Descriptor open(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (open.get() < 0 && (errno == EACCES || errno == EPERM))
    return;  // a folder that may be written and not be listed
  if (open.get() >= 0 && ::fsync(open.get()) == 0) return;
  if (errno == EINVAL || errno == ENOTSUP) return;  // a file system that syncs no folders
  throw Error(FileError::not_written, Name{path},
              msg("its folder cannot be synced ({})", system_words(errno)),
              msg("check the disk: the file may be gone after a power cut"));
}

}  // namespace cavum
