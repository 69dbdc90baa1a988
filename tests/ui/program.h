// The built program as a user runs it: a fixture with a folder of its own, a station's home in it,
// and what a command printed.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/base/file.h"
#include "tests/engine/support/basics.h"

namespace cavum::testing_ui {

/// What ships, and a small task on a block.
inline const std::string k_data = std::string(CAVUM_SOURCE_DIR) + "/data";
inline const std::string k_block =
    std::string(CAVUM_SOURCE_DIR) + "/tests/replay/block_cavity.toml";

struct Ran {
  int exit_code = -1;  ///< -1: ended by a signal
  std::string out, err;
};

class Program : public ::testing::Test {
 protected:
  void SetUp() override {
    setenv("CAVUM_HOME", path("home").c_str(), 1);
    setenv("LANGUAGE", "en", 1);  // whatever the machine speaks
  }

  /// A file of the test's folder, which goes away with it.
  [[nodiscard]] std::string path(const std::string& name) const { return folder_.file(name); }
  /// Runs `cavum ARGUMENTS` through the shell.
  [[nodiscard]] Ran run(const std::string& arguments) const {
    const int status = std::system(
        (std::string(CAVUM_BINARY) + " " + arguments + " >" + path("out") + " 2>" + path("err"))
            .c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text_file(path("out")),
            read_text_file(path("err"))};
  }
  /// The JSON object of a command that must succeed.
  [[nodiscard]] nlohmann::json run_json(const std::string& arguments) const {
    const Ran r = run(arguments + " --json");
    EXPECT_EQ(r.exit_code, 0) << arguments << r.err;
    return nlohmann::json::parse(r.out, nullptr, false);
  }
  /// Exit 2, nothing on standard output but the error as JSON where that was asked for, and one
  /// line of error that holds all of `parts`.
  void expect_refused(const std::string& arguments, const std::vector<std::string>& parts) const {
    const Ran r = run(arguments);
    EXPECT_EQ(r.exit_code, 2) << arguments << "\n" << r.err;
    if (arguments.find("--json") == std::string::npos)
      EXPECT_EQ(r.out, "") << arguments;
    else
      EXPECT_TRUE(nlohmann::json::parse(r.out, nullptr, false).contains("error"))
          << arguments << r.out;
    EXPECT_TRUE(r.err.starts_with("cavum: ")) << r.err;
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
    for (const auto& p : parts)
      EXPECT_NE(r.err.find(p), std::string::npos) << "'" << p << "' is missing in: " << r.err;
  }

  testing_basics::Folder folder_;
};

}  // namespace cavum::testing_ui
