// Every template that `cavum scenario new` writes, on its tooth.
#include "scenarios/file/template.h"

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "scenarios/review/check.h"

namespace cavum::scenarios {
namespace {

class Template : public ::testing::TestWithParam<TemplateChoice> {};

TEST_P(Template, IsSoundWithoutAWarningAndTheExpertHasTwiceTheTime) {
  const std::string path = std::string(CAVUM_SOURCE_DIR) + "/data/scenarios/new.toml", text = scenario_template(GetParam().tooth, GetParam().task);
  const CheckedScenario checked = check_whole(text, path);
  for (const auto& p : checked.problems) ADD_FAILURE() << p.text();
  ASSERT_TRUE(checked.expert.time_s);
  EXPECT_LT(2 * *checked.expert.time_s, parse_scenario(text, path).time_limit_s);
  for (std::size_t from = 0, end = 0; from < text.size(); from = end + 1) {
    end = text.find('\n', from);
    EXPECT_LE(end - from, 150u) << text.substr(from, end - from);
  }
}

INSTANTIATE_TEST_SUITE_P(Every, Template, ::testing::ValuesIn(template_choices()),
                         [](const auto& test) { return test.param.tooth + "_" + test.param.task; });

TEST(Templates, ThatDoNotExistAreRefusedWithTheListOfThoseThatDo) {
  for (const auto& [tooth, task] : {std::pair("incisor", "class_2"), std::pair("molar", "lesion"), std::pair("", "")}) {
    try {
      static_cast<void>(scenario_template(tooth, task));
      ADD_FAILURE() << tooth << " " << task;
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find("molar with access, class_1"), std::string::npos) << e.what();
    }
  }
}

}  // namespace
}  // namespace cavum::scenarios
