// Session files that a verb is given: files, or folders of them.
#pragma once

#include <string>
#include <vector>

namespace cavum::ui {

/// All .cavum files in a folder and below, sorted. Throws Error when there is none or it cannot be
/// read.
[[nodiscard]] std::vector<std::string> sessions_in(const std::string& folder);
/// Files as they are named, folders replaced by what is in them.
[[nodiscard]] std::vector<std::string> session_files(const std::vector<std::string>& names);

}  // namespace cavum::ui
