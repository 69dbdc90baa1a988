// A folder for files that nobody asked to keep.
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <string>

#include "engine/base/error.h"

namespace cavum {

/// Below TMPDIR, open to its owner alone; gone with all it holds at the end. Throws Error when it
/// cannot be made.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "cavum-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
      throw Error(name, msg("cannot be made"),
                  msg("set TMPDIR to a folder that is writable and has room"));
    folder_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  [[nodiscard]] std::string file(const std::string& name) const {
    return (folder_ / name).string();
  }

 private:
  std::filesystem::path folder_;
};

}  // namespace cavum
