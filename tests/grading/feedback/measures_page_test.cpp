#include "grading/feedback/measures_page.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "engine/base/file.h"
#include "scenarios/file/measures.h"

namespace cavum::grading {
namespace {

TEST(MeasuresPage, IsTheOneInTheManual) {
  if (std::getenv("CAVUM_ALTER_SENTENCES") != nullptr) GTEST_SKIP() << "asks for words";
  EXPECT_EQ(measures_page(), read_text_file(CAVUM_SOURCE_DIR "/docs/measures.md"))
      << "write it anew: cavum grade --measures > docs/measures.md";
}

TEST(MeasuresPage, HasARowForEveryMeasure) {
  const std::string page = measures_page();
  for (const auto& m : scenarios::measures())
    EXPECT_NE(page.find("| `" + (m.tissue.empty() ? m.name : "touched_TISSUE_mm3") + "` |"),
              std::string::npos)
        << m.name;
}

}  // namespace
}  // namespace cavum::grading
