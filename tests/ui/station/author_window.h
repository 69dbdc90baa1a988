// The authoring view for tests: the real program on a virtual screen, its keys pressed by a script,
// in a folder of its own.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <memory>
#include <string>

#include "engine/base/file.h"
#include "tests/engine/support/basics.h"
#include "tests/ui/station/virtual_screen.h"

namespace cavum::station {

inline const std::string k_class_1 =
    std::string(CAVUM_SOURCE_DIR) +
    "/tests/ui/station/class_1_by_points.toml";  // its outline is drawn, not found

/// `text` with one part replaced by another; the part must be there once.
inline std::string replaced(std::string text, const std::string& part, const std::string& by) {
  EXPECT_NE(text.find(part), std::string::npos) << part;
  return text.replace(text.find(part), part.size(), by);
}

class AuthorWindow : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { screen_ = std::make_unique<testing_station::VirtualScreen>(); }
  static void TearDownTestSuite() { screen_.reset(); }
  void SetUp() override {
    if (!screen_->there())
      GTEST_SKIP() << "SKIPPED: no Xvfb on this computer, so no window can be opened";
    ::setenv("CAVUM_DATA", CAVUM_SOURCE_DIR "/data", 1);
    write_text_file(file(), read_text_file(k_class_1));
  }
  void TearDown() override { ::unsetenv("CAVUM_DATA"); }

  [[nodiscard]] std::string file() const { return folder_.file("class_1.toml"); }
  /// For what does not depend on the tooth: it is laid out in half the time.
  void on_the_block() const {
    write_text_file(file(), replaced(read_text_file(k_class_1), "lower_molar.cvt", "block.cvt"));
  }
  [[nodiscard]] std::string said() const { return read_text_file(folder_.file("err")); }
  int run(const std::string& script, const std::string& more = "") const {
    write_text_file(folder_.file("script"), script);
    const int status = std::system((CAVUM_BINARY " station --author " + file() + " --script " +
                                    folder_.file("script") + " --pictures " CAVUM_PICTURES + " " +
                                    more + " >" + folder_.file("out") + " 2>" + folder_.file("err"))
                                       .c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  testing_basics::Folder folder_;

 private:
  static inline std::unique_ptr<testing_station::VirtualScreen> screen_;
};

}  // namespace cavum::station
