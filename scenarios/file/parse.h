// Reads scenario and rubric files. Every mistake of a file is found in one go, each with its place.
#pragma once

#include <fmt/core.h>

#include <string>
#include <vector>

#include "engine/base/error.h"
#include "engine/tooth/tooth.h"
#include "scenarios/file/mistake.h"
#include "scenarios/file/scenario.h"

namespace cavum::scenarios {

/// One mistake, or a warning of what is legal but unwise.
struct Problem {
  FileLocation where;
  Message what, what_to_do;
  bool warning = false;
  Mistake mistake = Mistake::other;
  [[nodiscard]] Message message() const {
    return warning ? msg("{}: warning: {}; {}", where, what, what_to_do)
                   : msg("{}: {}; {}", where, what, what_to_do);
  }
  friend bool operator==(const Problem&, const Problem&) = default;
};

/// Several mistakes at once. `what()` is the first one's text and how many more there are; the
/// command line prints each on a line of its own.
class ProblemsError : public Error {
 public:
  explicit ProblemsError(std::vector<Problem> list);
  [[nodiscard]] const std::vector<Problem>& problems() const noexcept { return problems_; }

 private:
  std::vector<Problem> problems_;
};
/// Throws ProblemsError unless the list is empty.
void require_none(std::vector<Problem> problems);

/// Throws Error naming the first mistake, and how many there are. `path` names the file in it.
[[nodiscard]] Scenario parse_scenario(const std::string& text, const std::string& path);
/// What could be read of a file, and all its mistakes in the order of the file; none when it is
/// sound.
struct ReadScenario {
  Scenario scenario;
  std::vector<Problem> problems;
};
[[nodiscard]] ReadScenario read_scenario(const std::string& text, const std::string& path);
[[nodiscard]] Scenario load_scenario(const std::string& path);
/// A problem that stands at one of the scenario's `places`, or at the nearest one that holds it.
[[nodiscard]] Problem problem_at(const Scenario& scenario, const std::string& place,
                                 const Message& what, const Message& what_to_do,
                                 Mistake mistake = Mistake::other);
/// Every tissue that zones, perforation or the rubric's measures name and the tooth does not have.
[[nodiscard]] std::vector<Problem> missing_tissues(const Scenario& scenario, const Tooth& tooth);
/// Throws ProblemsError when a tissue that the scenario names is none of the tooth's: misspelt, it
/// would never be touched.
void require_tissues(const Scenario& scenario, const Tooth& tooth);
/// A rubric alone: the same keys as [rubric] of a scenario, at the top of the file (or under
/// [rubric]). Throws ProblemsError naming every mistake.
[[nodiscard]] RubricSpec parse_rubric(const std::string& text, const std::string& path);

/// The tooth file of a scenario: beside the scenario file, else in ../teeth of it, else data/teeth
/// of the working directory. Throws Error when none is there.
[[nodiscard]] std::string find_tooth_file(const Scenario& scenario);

}  // namespace cavum::scenarios
