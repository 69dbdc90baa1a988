// The lines of Python on the page of the recording's format read the forces of a session, tick by
// tick, as the program does.
#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>

#include "engine/base/file.h"
#include "engine/session/session_reader.h"
#include "tests/engine/session/fixture.h"

namespace cavum {
namespace {

TEST(PythonReader, ShownOnTheFormatsPageReadsTheForces) {
  if (std::system("/usr/bin/python3 -c 'import zstandard' 2>/dev/null") != 0)
    GTEST_SKIP() << "python3-zstandard is not installed";
  const test::Folder folder;
  const std::string page =
                        read_text_file(std::string(CAVUM_SOURCE_DIR) + "/docs/formats/session.md"),
                    begin = "```python\n";
  const auto from = page.find(begin);
  ASSERT_NE(from, std::string::npos);
  write_text_file(folder.file("read.py"),
                  page.substr(from + begin.size(),
                              page.find("```", from + begin.size()) - from - begin.size()));
  const std::string path = folder.file("exam.cavum");
  test::make_closed_session(path, 2600);
  ASSERT_EQ(std::system(("/usr/bin/python3 " + folder.file("read.py") + " " + path + " >" +
                         folder.file("forces"))
                            .c_str()),
            0);

  std::istringstream lines(read_text_file(folder.file("forces")));
  const SessionReader session(path);
  std::int64_t expected = 0, tick = 0;
  double force_n = 0, most_n = 0;
  for (std::size_t c = 0; c < session.chunks().size(); ++c)
    for (const auto& record : session.motion(c).records) {
      ASSERT_TRUE(lines >> tick >> force_n) << "after tick " << expected - 1;
      ASSERT_EQ(tick, expected++);
      ASSERT_NEAR(force_n, record.model_un * 1e-6, 1e-9) << "tick " << tick;
      most_n = std::max(most_n, force_n);
    }
  EXPECT_EQ(expected, 2600);
  EXPECT_FALSE(lines >> tick) << "lines beyond the last tick";
  EXPECT_GT(most_n, 0.1) << "the session presses on something";
}

}  // namespace
}  // namespace cavum
