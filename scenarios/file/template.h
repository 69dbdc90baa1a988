// The text of a scenario to start from, with its comments; the teeth that ship, and tasks on the block.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cavum::scenarios {

/// What one scenario says of its own: steps, pauses, margins, rubric and comments are the same for all of its kind.
struct TaskText {
  std::string id, title, what;    ///< `what` is for the candidate
  std::string tooth_file, about;  ///< `about` the tooth, a comment
  std::string burs;               ///< the tray, as a TOML list
  double time_limit_s = 600.0;
  bool access = false;                                     ///< opens a pulp chamber: its steps ask for that
  std::string aims, faults;                                ///< TOML lists of tissues
  double walls_limit_mm3 = 0.0;                            ///< of wall cut beyond the leeway the exam is failed; 0: no such limit
  std::string zones, guard;                                ///< [[zones.target]] and [[zones.protected]] with comments
  std::string steps = {};                                  ///< [[steps]]; empty: those of all cavities, or of all accesses
  std::string criteria = {};                               ///< further [[rubric.criteria]]
  std::string walls_limit_of = "a quarter of the cavity";  ///< what `walls_limit_mm3` is, in words
};
/// A whole scenario with comments.
[[nodiscard]] std::string scenario_text(const TaskText& task);

/// A tooth of data/teeth by the word that `--tooth` takes for it. Tasks on it follow its landmarks (scenarios/review/tooth_task.h).
struct ShippedTooth {
  std::string_view word, file;
};
[[nodiscard]] std::span<const ShippedTooth> shipped_teeth();

/// Tasks on the block that ships, which has no landmarks.
[[nodiscard]] std::vector<std::string> block_task_words();
/// A whole scenario with comments, without mistakes. Throws Error that lists the tasks for any other word.
[[nodiscard]] std::string block_task(const std::string& word);

}  // namespace cavum::scenarios
