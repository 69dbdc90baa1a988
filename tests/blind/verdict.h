// Runs `cavum explain` as a user does and reads its answer. The program sees the recording, never
// what was hidden.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/blind/recording.h"

namespace cavum::blind {

struct Estimate {
  double value = 0.0, low = 0.0, high = 0.0;
};

struct Cause {
  std::string mechanism;
  std::vector<std::string> aliases;
  std::map<std::string, Estimate> parameters;

  /// `mechanism` or one of its aliases, in a set of at most three.
  [[nodiscard]] bool holds(const std::string& name) const;
};

struct Verdict {
  bool answered = false;  ///< false: no JSON came; `trouble` says what came instead
  std::string trouble;
  std::string verdict;
  std::vector<Cause> causes;
  std::string unexplained;  ///< variable, empty if none
  std::vector<std::string> not_testable, data_faults;
  double base_rmse_n = 0.0, extended_rmse_n = 0.0, gain_percent = 0.0;
  std::string next_experiment;
  double seconds = 0.0;  ///< wall clock
};

/// A file's bytes; empty when it cannot be read.
[[nodiscard]] std::string text_of(const std::filesystem::path& file);

/// Runs `cavum explain folder/recording.csv --json --seed seed`.
[[nodiscard]] Verdict ask(const std::filesystem::path& cavum, const std::filesystem::path& folder,
                          std::uint64_t seed, const std::string& options = "");

}  // namespace cavum::blind
