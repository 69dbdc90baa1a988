// What a scenario says in other languages: texts by id, mistakes with their place, nothing lost on
// the way through a recording.
#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "scenarios/file/parse.h"
#include "tests/engine/support/basics.h"

namespace cavum::scenarios {
namespace {

using testing_basics::tells;

std::string slot() {
  return read_text_file(std::string(CAVUM_SOURCE_DIR) + "/data/scenarios/slot.toml");
}

/// The slot with other languages than its own.
std::string with(const std::string& languages) {
  const std::string text = slot();
  return text.substr(0, text.find("[languages")) + languages;
}

std::vector<Message> problems_of(const std::string& text) {
  std::vector<Message> all;
  for (const Problem& p : read_scenario(text, "s.toml").problems) all.push_back(p.message());
  return all;
}

TEST(ScenarioLanguages, EachTextOfAShippedScenarioHasItsGermanOne) {
  for (const char* name : {"class_1", "class_2", "class_2_neighbour", "cross", "hidden_lesion",
                           "incisor_access", "molar_access", "premolar_access", "slot"}) {
    const std::string file = std::string(CAVUM_SOURCE_DIR) + "/data/scenarios/" + name + ".toml";
    const Scenario s = parse_scenario(read_text_file(file), file);
    ASSERT_TRUE(s.languages.contains("de")) << name;
    const auto& german = s.languages.at("de");
    EXPECT_TRUE(german.contains(s.title) && german.contains(s.description)) << name;
    for (const auto& step : s.steps)
      EXPECT_TRUE(german.contains(step.instruction)) << name << " " << step.id;
    for (const auto& c : s.rubric.criteria)
      EXPECT_TRUE(german.contains(c.title)) << name << " " << c.id;
  }
}

TEST(ScenarioLanguages, AMistakeIsNamedWithItsPlace) {
  EXPECT_TRUE(problems_of(with("[languages.fr]\ntitle = \"Rainure\"\n")).empty());
  EXPECT_TRUE(tells(problems_of(with("[languages.de]\nsteps.nowhere = \"x\"\n")), "nowhere"));
  EXPECT_TRUE(tells(problems_of(with("[languages.de]\ncriteria.walls = 3\n")), "walls"));
  EXPECT_TRUE(tells(problems_of(with("[languages.de]\ntitel = \"x\"\n")), "titel"));
  for (const char* wrong : {"[languages.en]\ntitle = \"x\"\n",
                            "[languages.German]\ntitle = \"x\"\n", "[languages]\nde = \"x\"\n"})
    EXPECT_EQ(read_scenario(with(wrong), "s.toml").problems.at(0).mistake,
              Mistake::unknown_language)
        << wrong;
}

TEST(ScenarioLanguages, WhatAScenarioAsksDoesNotDependOnThem) {
  const Scenario with_german = parse_scenario(slot(), "s.toml"),
                 without = parse_scenario(with(""), "s.toml");
  EXPECT_EQ(with_german.title, without.title);
  EXPECT_TRUE(without.languages.empty());
  EXPECT_EQ(with_german.steps.size(), without.steps.size());
}

}  // namespace
}  // namespace cavum::scenarios
