// One program at a time in a folder that several may change: who comes second waits. The lock goes
// with the program that holds it.
#pragma once

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <string>

#include "engine/base/error.h"
#include "engine/base/system_error.h"

namespace cavum::records {

class FolderLock {
 public:
  /// Waits until nobody else holds `folder`. Throws Error when it cannot be locked; `what` and
  /// `what_to_do` say what that means there.
  FolderLock(const std::string& folder, const Message& what, const Message& what_to_do)
      : fd_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (fd_ >= 0 && ::flock(fd_, LOCK_EX) == 0) return;
    const Message why = system_words(errno);
    if (fd_ >= 0) ::close(fd_);
    throw Error(folder, msg("{} ({})", what, why), what_to_do);
  }
  ~FolderLock() { ::close(fd_); }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int fd_ = -1;
};

}  // namespace cavum::records
