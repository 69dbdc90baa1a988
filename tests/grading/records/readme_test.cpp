// The page that says what a ledger proves: each row of its table names tests, and each of them is
// there.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>
#include <sstream>

#include "engine/base/file.h"

namespace cavum::records {
namespace {

TEST(LedgerReadme, EveryRowOfWhatIsShownIsATestThatIsThere) {
  const std::filesystem::path source = CAVUM_SOURCE_DIR;
  std::set<std::string> tests;
  const std::regex declared(R"(TEST(?:_F|_P)?\((\w+), (\w+)\))");
  for (const auto& f : std::filesystem::recursive_directory_iterator(source / "tests")) {
    if (f.path().extension() != ".cpp") continue;
    const std::string text = read_text_file(f.path().string());
    for (std::sregex_iterator i(text.begin(), text.end(), declared), end; i != end; ++i)
      tests.insert((*i)[1].str() + "." + (*i)[2].str());
  }
  std::istringstream page(read_text_file((source / "grading/records/README.md").string()));
  const std::regex named("`(\\w+\\.\\w+)`");
  bool inside = false;
  int rows = 0;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("| somebody |")) inside = true;
    if (!inside || !line.starts_with("| ") || line.starts_with("| somebody") ||
        line.starts_with("| ---"))
      continue;
    ++rows;
    const std::string last = line.substr(line.rfind('|', line.size() - 2) + 1);
    std::sregex_iterator i(last.begin(), last.end(), named), end;
    EXPECT_NE(i, end) << "names no test: " << line;
    for (; i != end; ++i)
      EXPECT_TRUE(tests.contains((*i)[1].str())) << (*i)[1].str() << " is no test";
  }
  EXPECT_GE(rows, 45);
}

}  // namespace
}  // namespace cavum::records
