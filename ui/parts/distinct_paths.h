// No verb may write over what it reads, or twice to the same place.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/file.h"

namespace cavum::ui {

/// A file that a verb reads or writes: how the user named it ("--out x.html"), and its path; empty
/// paths do not count.
struct NamedFile {
  std::string named, path;
};

/// Throws Error when one of `written` is one of `read` or another of `written`, or no file can be
/// put there.
inline void require_distinct_paths(const std::vector<NamedFile>& written,
                                   const std::vector<NamedFile>& read) {
  const auto same = [](const NamedFile& a, const NamedFile& b) {
    std::error_code none;
    return !b.path.empty() && std::filesystem::weakly_canonical(a.path, none) ==
                                  std::filesystem::weakly_canonical(b.path, none);
  };
  for (std::size_t i = 0; i < written.size(); ++i) {
    if (written[i].path.empty()) continue;
    for (const NamedFile& r : read)
      if (same(written[i], r))
        throw Error(Name{written[i].named}, msg("is also what is read"),
                    msg("write to another file"));
    for (std::size_t j = 0; j < i; ++j)
      if (same(written[i], written[j]))
        throw Error(Name{written[i].named}, msg("is the same file as {}", written[j].named),
                    msg("give each a name of its own"));
    require_writable(written[i].path);
  }
}

/// For a rig.toml that is written beside a recording: throws Error when there is one that no rig
/// wrote.
inline void require_rigs_own(const std::string& rig_toml) {
  if (std::filesystem::exists(rig_toml) &&
      !read_text_file(rig_toml).starts_with("# Virtual testing machine"))
    throw Error(Name{rig_toml}, msg("was not written by a rig, and would be lost"),
                msg("write the recording into another folder"));
}

}  // namespace cavum::ui
