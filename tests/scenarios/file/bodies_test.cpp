// The kinds of bodies: what is made of their rows.
#include "scenarios/file/bodies.h"

#include <gtest/gtest.h>

#include "engine/base/file.h"

namespace cavum::scenarios {
namespace {

TEST(Bodies, ThePageListsThemWithTheirFields) {
  const std::string page = read_text_file(std::string(CAVUM_SOURCE_DIR) + "/docs/scenarios.md");
  EXPECT_NE(page.find("| body | fields | what |\n| --- | --- | --- |\n" + bodies_as_table() + "\n"),
            std::string::npos)
      << "write the table anew:\n"
      << bodies_as_table();
}

}  // namespace
}  // namespace cavum::scenarios
