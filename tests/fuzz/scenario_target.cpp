// A scenario's text, checked as `cavum scenario check` does before it asks for the tooth, and as a
// rubric.
#include <filesystem>

#include "engine/base/file.h"
#include "scenarios/file/parse.h"
#include "tests/fuzz/material.h"
#include "tests/fuzz/targets.h"

namespace cavum::fuzz {

void fuzz_scenario(Data data) {
  const std::string text = text_of(data);
  const Tooth tooth;
  const scenarios::ReadScenario read = scenarios::read_scenario(text, "scenario.toml");
  for (const auto& problem : read.problems) static_cast<void>(english_text(problem.message()));
  static_cast<void>(scenarios::missing_tissues(read.scenario, tooth));
  try {
    static_cast<void>(scenarios::parse_rubric(text, "rubric.toml"));
  } catch (const Error&) {
  }
}

std::vector<Bytes> scenario_seeds() {
  std::vector<Bytes> seeds;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(CAVUM_SOURCE_DIR) + "/data/scenarios"))
    if (entry.path().extension() == ".toml") seeds.push_back(read_file(entry.path().string()));
  for (const auto& entry : std::filesystem::directory_iterator(std::string(CAVUM_SOURCE_DIR) +
                                                               "/tests/scenarios/broken"))
    if (entry.path().extension() == ".toml") seeds.push_back(read_file(entry.path().string()));
  return seeds;
}

}  // namespace cavum::fuzz
