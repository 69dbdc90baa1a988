// Who holds a file that cannot be had, as far as Linux tells: the locks in /proc/locks, of the file
// and of its write-ahead log's index.
#pragma once

#include <string>

#include "engine/base/message.h"

namespace cavum {

/// "another program: cavum (process 1234)", "another program" when nobody can be named, and "this
/// program itself" when it is another connection of our own.
[[nodiscard]] Message holder_of(const std::string& database_path);

}  // namespace cavum
