#include "grading/feedback/measures_page.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <stdexcept>

#include "engine/base/file.h"
#include "grading/feedback/moments_of_measure.h"

namespace cavum::grading {
namespace {

TEST(MeasuresPage, IsTheOneInTheManual) {
  if (std::getenv("CAVUM_ALTER_SENTENCES") != nullptr) GTEST_SKIP() << "asks for words";
  EXPECT_EQ(measures_page(), read_text_file(CAVUM_SOURCE_DIR "/docs/measures.md")) << "write it anew: cavum grade --measures > docs/measures.md";
}

TEST(MeasuresPage, HasARowForEveryMeasure) {
  const std::string page = measures_page();
  for (const auto& m : scenarios::measures())
    EXPECT_NE(page.find("| `" + (m.tissue.empty() ? m.name : "touched_TISSUE_mm3") + "` |"), std::string::npos) << m.name;
}

TEST(MomentsOfMeasure, ARowThatIsLackingOrTooManyOrUnfinishedIsRefused) {
  const auto rows = moments_of_measures();
  EXPECT_NO_THROW(static_cast<void>(checked_moments(rows)));
  auto changed = rows;
  changed.pop_back();
  EXPECT_THROW(static_cast<void>(checked_moments(changed)), std::logic_error);
  changed = rows;
  changed.push_back(rows[0]);
  changed.back().measure = "nonsense_mm3";
  EXPECT_THROW(static_cast<void>(checked_moments(changed)), std::logic_error);
  changed = rows;
  changed[2].list = nullptr;
  EXPECT_THROW(static_cast<void>(checked_moments(changed)), std::logic_error);
}

}  // namespace
}  // namespace cavum::grading
