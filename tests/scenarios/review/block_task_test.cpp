// Every task that `cavum scenario new` writes on the block.
#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "scenarios/review/check.h"
#include "scenarios/review/task_texts.h"
#include "tests/engine/support/basics.h"

namespace cavum::scenarios {
namespace {

class BlockTask : public ::testing::TestWithParam<std::string> {};

TEST_P(BlockTask, IsSoundWithoutAWarningAndTheExpertHasTwiceTheTime) {
  const std::string path = std::string(CAVUM_SOURCE_DIR) + "/data/scenarios/new.toml",
                    text = block_task(GetParam());
  const CheckedScenario checked = check_whole(text, path);
  for (const auto& p : checked.problems) ADD_FAILURE() << english_text(p.message());
  ASSERT_TRUE(checked.expert.time_s);
  EXPECT_LT(2 * *checked.expert.time_s, parse_scenario(text, path).time_limit_s);
  for (std::size_t from = 0, end = 0; from < text.size(); from = end + 1) {
    end = text.find('\n', from);
    EXPECT_LE(end - from, 150u) << text.substr(from, end - from);
  }
}

INSTANTIATE_TEST_SUITE_P(Every, BlockTask, ::testing::ValuesIn(block_task_words()),
                         [](const auto& test) { return test.param; });

TEST(BlockTasks, ThatDoNotExistAreRefusedWithTheListOfThoseThatDo) {
  for (const char* task : {"class_2", "lesion", ""}) {
    const auto refused = testing_basics::thrown_by([&] { static_cast<void>(block_task(task)); });
    for (const auto& word : block_task_words())
      EXPECT_TRUE(testing_basics::tells(refused, word)) << task << ": " << word;
  }
}

}  // namespace
}  // namespace cavum::scenarios
