#include "ui/cli/session_files.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "engine/base/error.h"
#include "engine/base/system_error.h"

namespace cavum::ui {

std::vector<std::string> sessions_in(const std::string& folder) {
  std::vector<std::string> found;
  try {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
      if (entry.path().extension() == ".cavum") found.push_back(entry.path().string());
  } catch (const std::filesystem::filesystem_error& e) {
    throw Error(system_code(e.code().value()), Name{folder}, system_words(e.code().value()),
                msg("check the folder and its permissions"));
  }
  if (found.empty())
    throw Error(Name{folder}, msg("holds no .cavum file"),
                msg("name a session or a folder of sessions"));
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<std::string> session_files(const std::vector<std::string>& names) {
  std::vector<std::string> files;
  std::set<std::filesystem::path> known;
  const auto add = [&](std::string file) {
    std::error_code none;
    if (known.insert(std::filesystem::weakly_canonical(file, none)).second)
      files.push_back(std::move(file));
  };
  for (const auto& name : names) {
    if (!std::filesystem::is_directory(name)) {
      add(name);
      continue;
    }
    for (auto& f : sessions_in(name)) add(std::move(f));
  }
  return files;
}

}  // namespace cavum::ui
