// Where what ships with Cavum lies: teeth, scenarios, burs, materials. Found from where the program
// is, so that it can be moved.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace cavum {

/// Folder of the running program.
[[nodiscard]] std::filesystem::path program_folder();
/// Folders that may hold them, first come first served: $CAVUM_DATA; the folder above that of
/// `near_file`, for a scenario has its teeth and burs beside it; data/ here; ../share/cavum beside
/// the program, where it is installed; data/ of the source tree that the program was built in. Not
/// all need be there.
[[nodiscard]] std::vector<std::filesystem::path> shipped_folders(const std::string& near_file = {});

}  // namespace cavum
