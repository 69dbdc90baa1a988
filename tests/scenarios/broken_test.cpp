// Scenario files with mistakes, each with the exact messages beside it. After a message was changed on purpose,
// CAVUM_WRITE_GOLDEN=1 writes them anew: read the difference before it is committed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <regex>

#include "engine/base/file.h"
#include "scenarios/review/check.h"

namespace cavum::scenarios {
namespace {

namespace fs = std::filesystem;

const std::string k_source(CAVUM_SOURCE_DIR);
const std::string k_folder = k_source + "/tests/scenarios/broken";

std::vector<std::string> names() {
  std::vector<std::string> list;
  for (const auto& entry : fs::directory_iterator(k_folder))
    if (entry.path().extension() == ".toml") list.push_back(entry.path().stem().string());
  std::sort(list.begin(), list.end());
  return list;
}

/// All messages of a file as `cavum scenario check` prints them. The block is given by hand, so that only a file without it goes looking.
std::string messages(const std::string& name) {
  const std::string file = name + ".toml", text = read_text_file(k_folder + "/" + file);
  fs::current_path(k_folder);  // a zone's STL lies beside its file
  const bool own_tooth = text.find("\"block.cvt\"") != std::string::npos;
  std::string all;
  for (const auto& p : check_whole(text, file, own_tooth ? k_source + "/tests/replay/block.cvt" : "").problems)
    all += english_text(p.message()) + "\n";
  return all;
}

class Broken : public ::testing::TestWithParam<std::string> {};

TEST_P(Broken, SaysExactlyWhatItsGoldenFileSays) {
  const std::string golden = k_folder + "/" + GetParam() + ".txt", said = messages(GetParam());
  if (std::getenv("CAVUM_WRITE_GOLDEN") != nullptr) write_text_file(golden, said);
  EXPECT_EQ(said, read_text_file(golden));
  static const std::regex k_form(R"([a-z0-9_]+\.toml:[1-9][0-9]*:[1-9][0-9]*: (warning: )?[^;]+; .+)");
  EXPECT_FALSE(said.empty());
  for (std::size_t from = 0; from < said.size();) {
    const auto end = said.find('\n', from);
    const std::string line = said.substr(from, end - from);
    EXPECT_TRUE(std::regex_match(line, k_form)) << line;
    from = end + 1;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenarios, Broken, ::testing::ValuesIn(names()), [](const auto& test) { return test.param; });

TEST(BrokenScenarios, AreAtLeastFortyAndNoGoldenFileIsLeftOver) {
  EXPECT_GE(names().size(), 40u);
  for (const auto& entry : fs::directory_iterator(k_folder))
    EXPECT_TRUE(fs::exists(fs::path(entry.path()).replace_extension(".toml"))) << entry.path();
}

}  // namespace
}  // namespace cavum::scenarios
