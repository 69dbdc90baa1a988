// The volume of a file or folder as ITK reads it, in this process: only for a process that nobody
// misses, for damaged files make ITK's libraries abort, spin and fill the memory. Users call
// read_volume, which starts such a process.
#pragma once

#include <string>

namespace cavum {

/// Sets this process's limits by the size of the input, reads it, and sends the volume or the error
/// to `fd`. Returns an exit status: 0 when something was sent.
int serve_volume(const std::string& path, int fd);
/// What serve_volume does without limits: for a caller that has set some itself.
int send_volume_of(const std::string& path, int fd);

}  // namespace cavum
