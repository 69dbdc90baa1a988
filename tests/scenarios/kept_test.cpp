// Scenario files as they shipped on 2026-11-21 (kept/), but for the names of pages: an exam office has such files, and they load for ever.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "engine/base/file.h"
#include "scenarios/file/parse.h"

namespace cavum::scenarios {
namespace {

std::size_t times(const std::string& text, const std::string& line) {
  std::size_t count = 0;
  for (auto at = text.find("\n" + line + "\n"); at != std::string::npos; at = text.find("\n" + line + "\n", at + 1)) ++count;
  return count;
}

TEST(KeptScenarios, OfTheFirstDayLoadWithAllThatTheirTextHas) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(CAVUM_SOURCE_DIR) + "/tests/scenarios/kept")) {
    const std::string path = entry.path().string(), text = read_text_file(path);
    SCOPED_TRACE(path);
    const Scenario scenario = load_scenario(path);
    EXPECT_EQ(scenario.id, entry.path().stem().string());
    EXPECT_EQ(scenario.steps.size(), times(text, "[[steps]]"));
    EXPECT_EQ(scenario.rubric.criteria.size(), times(text, "[[rubric.criteria]]"));
    EXPECT_EQ(scenario.zones.target.size(), times(text, "[[zones.target]]"));
    double points = 0;
    for (const auto& criterion : scenario.rubric.criteria) points += criterion.points;
    EXPECT_EQ(points, 100.0);
    ++files;
  }
  EXPECT_EQ(files, 8);
}

}  // namespace
}  // namespace cavum::scenarios
