#include "engine/base/shipped.h"

#include <cstdlib>

namespace cavum {
namespace fs = std::filesystem;

fs::path program_folder() {
  std::error_code none;
  return fs::read_symlink("/proc/self/exe", none).parent_path();
}

std::vector<fs::path> shipped_folders(const std::string& near_file) {
  std::vector<fs::path> out;
  if (const char* told = std::getenv("CAVUM_DATA"); told != nullptr && *told != 0)
    out.emplace_back(told);
  if (!near_file.empty()) out.push_back(fs::path(near_file).parent_path() / "..");
  out.emplace_back("data");
  fs::path folder = program_folder();
  out.push_back(folder.parent_path() / "share" / "cavum");
  constexpr int k_deepest_build = 6;  // build/release/tests/simulation/ and the like
  std::error_code none;
  for (int up = 0; up < k_deepest_build && folder.has_relative_path();
       ++up, folder = folder.parent_path())
    if (fs::exists(folder / "CMakeLists.txt", none) && fs::exists(folder / "engine", none) &&
        fs::exists(folder / "data" / "teeth", none))
      out.push_back(folder / "data");
  return out;
}

}  // namespace cavum
