// Scenario files with mistakes, each with the place, kind and values of all its problems beside it.
// After they were changed on purpose, CAVUM_WRITE_GOLDEN=1 writes them anew: read the difference
// before it is committed.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>

#include "engine/base/file.h"
#include "scenarios/review/check.h"
#include "tests/engine/support/basics.h"

namespace cavum::scenarios {
namespace {

namespace fs = std::filesystem;

const std::string k_source(CAVUM_SOURCE_DIR);
const std::string k_folder = k_source + "/tests/scenarios/broken";

/// The names and figures of a message, in their order: what stays when its sentence is written
/// anew.
std::string values_of(const Message& m) {
  std::string all;
  const auto add = [&all](const std::string& value) {
    all += (all.empty() || value.empty() ? "" : ", ") + value;
  };
  for (const Value& v : m.values()) {
    if (const auto* inner = std::get_if<Message>(&v))
      add(values_of(*inner));
    else if (const auto* list = std::get_if<List>(&v))
      for (const Message& item : list->items) add(values_of(item));
    else
      add(english_text(msg("{}", Value(v))));
  }
  return all;
}

/// Each problem of a file on a line: place, kind, what it names, and what its remedy names; of what
/// is no TOML and no condition, whose reason is the library's, place and kind alone. The block is
/// given by hand, so that only a file without it goes looking.
std::string golden_of(const std::string& name) {
  const std::string file = name + ".toml", text = read_text_file(k_folder + "/" + file);
  fs::current_path(k_folder);  // a zone's STL lies beside its file
  const bool own_tooth = text.find("\"block.cvt\"") != std::string::npos;
  std::string all;
  for (const auto& p :
       check_whole(text, file, own_tooth ? k_source + "/tests/replay/block.cvt" : "").problems) {
    EXPECT_TRUE(p.where.line > 0 && p.where.column > 0 && !p.what.empty() && !p.what_to_do.empty())
        << english_text(p.message());
    const bool plain = p.mistake == Mistake::not_toml || p.mistake == Mistake::condition;
    const std::string values = plain ? "" : values_of(p.what),
                      remedy = plain ? "" : values_of(p.what_to_do);
    all += std::to_string(p.where.line) + ":" + std::to_string(p.where.column) +
           (p.warning ? " warning " : " ") + std::string(name_in(p.mistake)) +
           (values.empty() ? "" : ": " + values) + (remedy.empty() ? "" : "; " + remedy) + "\n";
  }
  return all;
}

class Broken : public ::testing::TestWithParam<std::string> {};

TEST_P(Broken, HasTheProblemsOfItsGoldenFile) {
  const std::string golden = k_folder + "/" + GetParam() + ".txt", found = golden_of(GetParam());
  if (std::getenv("CAVUM_WRITE_GOLDEN") != nullptr) write_text_file(golden, found);
  EXPECT_FALSE(found.empty());
  EXPECT_EQ(found, read_text_file(golden));
}

INSTANTIATE_TEST_SUITE_P(Scenarios, Broken,
                         ::testing::ValuesIn(testing_basics::toml_names(k_folder)),
                         [](const auto& test) { return test.param; });

TEST(BrokenScenarios, AreAtLeastFortyAndNoGoldenFileIsLeftOver) {
  EXPECT_GE(testing_basics::toml_names(k_folder).size(), 40u);
  for (const auto& entry : fs::directory_iterator(k_folder))
    EXPECT_TRUE(fs::exists(fs::path(entry.path()).replace_extension(".toml"))) << entry.path();
}

}  // namespace
}  // namespace cavum::scenarios
