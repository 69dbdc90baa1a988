// docs/limits.md says what the program refuses: its numbers are those of the code.
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "engine/base/csv.h"
#include "engine/base/file.h"
#include "engine/base/json_reader.h"
#include "engine/base/toml_limits.h"
#include "engine/device/selfcheck/check_history.h"
#include "engine/lab/scan/surface_points.h"
#include "engine/session/session_reader.h"
#include "engine/tooth/distance.h"
#include "engine/tooth/mesh/read_mesh.h"
#include "engine/tooth/tooth.h"
#include "engine/tooth/volume/volume_limits.h"
#include "scenarios/file/checked_toml.h"
#include "scenarios/zones/zone_work.h"
#include "tests/engine/support/basics.h"

namespace cavum::scenarios {
namespace {

/// Number of each row, by the name in its third column.
std::map<std::string, std::uint64_t> rows() {
  std::map<std::string, std::uint64_t> out;
  std::istringstream lines(read_text_file(std::string(CAVUM_SOURCE_DIR) + "/docs/limits.md"));
  for (std::string line; std::getline(lines, line);) {
    const auto name = line.find("| `");
    if (name == std::string::npos || !line.starts_with("| ")) continue;
    const auto number = line.rfind("| ", name - 1) + 2;
    std::string digits;
    for (std::size_t i = number; i < name; ++i)
      if (line[i] >= '0' && line[i] <= '9') digits += line[i];
    out[line.substr(name + 3, line.find('`', name + 3) - name - 3)] = std::stoull(digits);
  }
  return out;
}

TEST(LimitsPage, SaysTheNumbersOfTheCode) {
  const std::map<std::string, std::uint64_t> said = rows();
  const std::map<std::string, std::uint64_t> meant{
      {"k_largest_file", k_largest_file},
      {"k_largest_text", k_largest_text},
      {"JsonLimits::bytes", JsonLimits{}.bytes},
      {"JsonLimits::values", JsonLimits{}.values},
      {"JsonLimits::depth", JsonLimits{}.depth},
      {"k_toml_bytes", k_toml_bytes},
      {"k_toml_values", k_toml_values},
      {"k_toml_depth", k_toml_depth},
      {"k_toml_parts", k_toml_parts},
      {"k_toml_named", k_toml_named},
      {"CsvForm::most_rows", CsvForm{}.most_rows},
      {"CsvForm::most_fields", CsvForm{}.most_fields},
      {"k_max_items", k_max_items},
      {"k_max_tray", k_max_tray},
      {"k_max_points", k_max_points},
      {"k_max_zone_leaves", k_max_zone_leaves},
      {"k_max_body_leaves", k_max_body_leaves},
      {"k_max_zone_steps", k_max_zone_steps},
      {"k_max_removed_leaves", k_max_removed_leaves},
      {"k_max_lattice_leaves", k_max_lattice_leaves},
      {"k_max_row_leaves", k_max_row_leaves},
      {"k_max_placed", k_max_placed},
      {"k_longest_landmark_name", k_longest_landmark_name},
      {"k_max_near_triangles", k_max_near_triangles},
      {"k_max_scan_triangles", k_max_scan_triangles},
      {"k_max_scan_points", k_max_scan_points},
      {"k_largest_history", CheckHistory::k_largest_history},
      {"most_voxels", most_voxels(0)},
      {"most_gray_voxels", most_gray_voxels(0)}};
  for (const auto& [name, number] : meant) {
    ASSERT_TRUE(said.contains(name)) << name;
    EXPECT_EQ(said.at(name), number) << name;
  }
}

TEST(MeshLimits, TooManyTrianglesAtOneCornerAreRefusedWithTheLimitNamed) {
  std::string stl = "solid fan\n";
  const auto facet = [&](int a, int b, int z) {
    stl += "facet normal 0 0 1\nouter loop\nvertex 0 0 " + std::to_string(z) + "\nvertex " +
           std::to_string(a) + " " + std::to_string(a % 7) + " 0\nvertex " + std::to_string(b) +
           " " + std::to_string(b % 7) + " 0\nendloop\nendfacet\n";
  };
  for (int i = 0; i < 2001; ++i) facet(i, i + 1, 5);
  stl += "endsolid fan\n";
  const auto refused = testing_basics::thrown_by(
      [&] { static_cast<void>(read_closed_stl(Bytes(stl.begin(), stl.end()), "fan.stl")); });
  EXPECT_TRUE(testing_basics::tells(refused, 2000));
}

}  // namespace
}  // namespace cavum::scenarios
