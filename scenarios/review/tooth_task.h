// Tasks for a tooth that nobody wrote a scenario for: which make sense on it, and a scenario for
// each, told by the tooth's landmarks. Lengths follow published preparation guides where the tooth
// has room for them, and less where it has not; what was chosen is said.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/tooth/anatomy/landmarks.h"
#include "scenarios/file/parse.h"

namespace cavum::scenarios {

/// Every task that can be asked for: "class_1", "class_2_mesial", "access", ...
[[nodiscard]] std::vector<std::string> tooth_task_words();

struct OfferedTask {
  std::string task;
  Message title;
  Message why_not;  ///< what the tooth lacks for it; empty: it is offered
};
[[nodiscard]] std::vector<OfferedTask> offered_tasks(const Tooth& tooth,
                                                     const Landmarks& landmarks);

struct WrittenTask {
  std::string text;               ///< the scenario, with comments
  std::vector<Problem> problems;  ///< what `check` still says of it: warnings only
  Message chosen;                 ///< the lengths, for people
};
/// Tries a written scenario; says what is against it, or nothing.
using TaskTrial = std::function<Message(const std::string& text)>;
/// A language beside English in which a written scenario has its words, and how it says something.
struct TaskLanguage {
  std::string name;  ///< "de"; empty: none
  std::function<std::string(const Message&)> say;
};
/// `[languages.NAME]`, TOML: title and description, and the steps and criteria that the language
/// has other words for. Empty without a language.
[[nodiscard]] std::string language_table(const Scenario& scenario, const Message& title,
                                         const Message& description, const TaskLanguage& language);

/// Writes a scenario that `check` finds no mistake in, and `trial` has nothing against: of several
/// choices of lengths the first. `tooth_file` stands in it as its tooth and must be found from
/// `path`, where it will be saved. Throws Error when the tooth is not offered that task, has no
/// room for it, or no choice holds; it says what is in the way.
[[nodiscard]] WrittenTask write_tooth_task(const Tooth& tooth, const Landmarks& landmarks,
                                           const std::string& tooth_file, const std::string& path,
                                           const std::string& task, const TaskTrial& trial = {},
                                           const TaskLanguage& language = {});

}  // namespace cavum::scenarios
