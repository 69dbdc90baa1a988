// The station for tests: the real program with a real window on a virtual screen, its keys pressed
// by a script, in a folder of its own.
#pragma once

#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <memory>
#include <string>

#include "engine/base/file.h"
#include "engine/session/verify.h"
#include "tests/engine/support/basics.h"
#include "tests/ui/station/virtual_screen.h"

extern char** environ;

namespace cavum::station {

inline const std::string k_scenario =
    std::string(CAVUM_SOURCE_DIR) + "/tests/replay/block_cavity.toml";

class StationWindow : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { screen_ = std::make_unique<testing_station::VirtualScreen>(); }
  static void TearDownTestSuite() { screen_.reset(); }
  void SetUp() override {
    if (!screen_->there())
      GTEST_SKIP() << "SKIPPED: no Xvfb on this computer, so no window can be opened";
    ::setenv("CAVUM_HOME", folder_.file("home").c_str(), 1);
    ::setenv("LANGUAGE", "en", 1);  // whatever the machine speaks
  }

  [[nodiscard]] std::string session() const { return folder_.file("s.cavum"); }
  [[nodiscard]] std::string said() const { return read_text_file(folder_.file("err")); }
  [[nodiscard]] std::string printed() const { return read_text_file(folder_.file("out")); }

  /// Starts the station with a script; `wait` gives its exit code, -signal when a signal ended it.
  [[nodiscard]] pid_t start(const std::string& script, const std::string& more = "",
                            const std::string& scenario = k_scenario) const {
    write_text_file(folder_.file("script"), script);
    const std::string device =
        more.find("--device") == std::string::npos && more.find("--tutorial") == std::string::npos
            ? " --device simulated"
            : "";
    const std::string command = "exec " CAVUM_BINARY " station " + scenario + device + " --out " +
                                session() + " --script " + folder_.file("script") +
                                " --pictures " CAVUM_PICTURES " " + size_ + " " + more + " >" +
                                folder_.file("out") + " 2>" + folder_.file("err");
    return start_command(command);
  }
  static pid_t start_command(const std::string& command) {
    std::array<char*, 4> arguments{const_cast<char*>("sh"), const_cast<char*>("-c"),
                                   const_cast<char*>(command.c_str()), nullptr};
    pid_t child = -1;
    EXPECT_EQ(::posix_spawn(&child, "/bin/sh", nullptr, nullptr, arguments.data(), environ), 0);
    return child;
  }
  static int wait(pid_t child) {
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  int run(const std::string& script, const std::string& more = "",
          const std::string& scenario = k_scenario) const {
    return wait(start(script, more, scenario));
  }

  /// What was recorded is whole, the exam goes on from there, and closed it verifies.
  void expect_resumable(std::int64_t least_ticks) const {
    const VerifyReport open = verify_session(session());
    EXPECT_TRUE(open.intact) << testing_basics::text_of(open.findings);
    EXPECT_FALSE(open.closed);
    EXPECT_GE(open.ticks, least_ticks);
    const int status = std::system((CAVUM_BINARY " exam --resume --end --quiet --out " + session() +
                                    " >" + folder_.file("resumed") + " 2>&1")
                                       .c_str());
    EXPECT_EQ(status, 0) << read_text_file(folder_.file("resumed"));
    EXPECT_TRUE(verify_session(session()).verified);
  }

  testing_basics::Folder folder_;
  std::string size_ = "--width 800 --height 500";  ///< of the window: the processor draws it

 private:
  static inline std::unique_ptr<testing_station::VirtualScreen> screen_;
};

constexpr const char* k_to_exam = "type T5\ngo device-check\ngo briefing\nkey enter\nwait exam\n";
/// The same with mouse and keyboard as the stylus.
constexpr const char* k_to_exam_by_hand =
    "type M7\ngo device-check\nsleep 1\nkey space 0.6\ngo briefing\nkey enter\nwait exam\n";

}  // namespace cavum::station
