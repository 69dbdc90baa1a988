#include "engine/tooth/import/read_volume.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "engine/base/error.h"
#include "engine/base/file_error.h"
#include "engine/base/shipped.h"
#include "engine/base/system_error.h"
#include "engine/tooth/volume/volume_limits.h"
#include "engine/tooth/volume/volume_wire.h"

namespace cavum {
namespace {

namespace fs = std::filesystem;

/// The process that reads; it ends when this does.
class Reader {
 public:
  explicit Reader(const std::string& path) {
    const std::string program = read_volume_program();
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail(program, errno);
    from_ = ends[0];
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
    ::posix_spawn_file_actions_adddup2(&actions, ends[1], k_volume_descriptor);
    std::string name = "cavum-read-volume", file = path;
    std::array<char*, 3> arguments{name.data(), file.data(), nullptr};
    const int failed =
        ::posix_spawn(&process_, program.c_str(), &actions, nullptr, arguments.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    if (failed != 0) {
      ::close(from_);
      process_ = 0;
      fail(program, failed);
    }
  }
  ~Reader() {
    ::close(from_);
    if (process_ > 0) {
      ::kill(process_, SIGKILL);
      static_cast<void>(wait());
    }
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  [[nodiscard]] int from() const noexcept { return from_; }
  /// How it ended; to be asked when nothing more is to come. One that sent all and then broke did
  /// its work.
  [[nodiscard]] Message end() {
    const int status = wait();
    process_ = 0;
    if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL))
      return msg("took more of the processor's time than its limit");
    if (WIFSIGNALED(status)) return msg("was ended by {}", ::strsignal(WTERMSIG(status)));
    return msg("ended with status {}", WEXITSTATUS(status));
  }

 private:
  [[noreturn]] static void fail(const std::string& program, int reason) {
    throw Error(program, msg("cannot be started ({})", system_words(reason)),
                msg("install Cavum again"));
  }
  int wait() const {
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
  }

  int from_ = -1;
  pid_t process_ = 0;
};

Volume read_elsewhere(const std::string& path) {
  Reader reader(path);
  try {
    return receive_volume(reader.from(), path, most_voxels(~std::uint64_t{0} / 4),
                          k_longest_read_s);
  } catch (const VolumeCutOff&) {
    throw Error(path, msg("cannot be read as a volume: the program that reads it {}", reader.end()),
                msg("give an intact MetaImage, NRRD, NIfTI, TIFF or DICOM series"));
  }
}

}  // namespace

std::string read_volume_program() {
  std::string program;
  if (const char* told = std::getenv("CAVUM_READ_VOLUME"); told != nullptr && *told != 0) {
    program = told;
  } else {
    program = (program_folder() / "cavum-read-volume").string();
  }
  if (::access(program.c_str(), X_OK) != 0)
    throw Error(FileError::missing, Name{program}, msg("is not there, and volumes are read by it"),
                msg("install it beside cavum"));
  return program;
}

Volume read_volume(const std::string& path, const std::optional<Vec3>& spacing_mm) {
  Volume v = read_elsewhere(path);
  if (v.size.x < 4 || v.size.y < 4 || v.size.z < 4)
    throw Error(FileError::malformed, Name{path},
                msg("not a volume: fewer than 4 voxels along an axis"),
                msg("give all slices of the volume"));
  for (std::size_t i = 0; i < v.gray.size(); ++i)
    if (!std::isfinite(v.gray[i]))
      throw Error(FileError::malformed, Name{path}, msg("voxel {} is not a number", i),
                  msg("export the volume again"));

  const auto& s = v.spacing_mm;
  const bool told = s[0] > 0 && s[1] > 0 && s[2] > 0 && std::isfinite(s[0] + s[1] + s[2]) &&
                    !(s[0] == 1 && s[1] == 1 && s[2] == 1);
  if (spacing_mm) {
    for (const double d : {spacing_mm->x, spacing_mm->y, spacing_mm->z})
      if (!(d > 0 && d < 100))
        throw Error("--spacing-mm", msg("must lie between 0 and 100 mm"),
                    msg("give the edge of a voxel, such as 0.125"));
    v.spacing_mm = {spacing_mm->x, spacing_mm->y, spacing_mm->z};
  } else if (!told) {
    v.spacing_mm = {k_assumed_spacing_mm, k_assumed_spacing_mm, k_assumed_spacing_mm};
    v.spacing_assumed = true;
  }
  return v;
}

}  // namespace cavum
