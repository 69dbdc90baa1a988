// The texts of the tasks that `cavum scenario new` writes: data/tasks/NAME.toml, one file a task,
// and data/tasks/common.toml for what all have in common. A text has gaps, `{width}`: another text
// of the two files, a length chosen on the tooth, or `{bodies}` (bodies.h).
#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/base/message.h"

namespace cavum::scenarios {

/// What fills a gap: as it stands in the scenario, and for people.
struct Gap {
  std::string name, toml;
  Value words = Name{};
};
using Gaps = std::vector<Gap>;
/// A length with so many digits (k_as_needed: as few as it takes).
[[nodiscard]] Gap gap_mm(const char* name, double mm, int digits);

class TaskTexts {
 public:
  /// Of data/tasks/NAME.toml. Throws Error where a file is not there, or holds what is no text,
  /// number or list of texts.
  explicit TaskTexts(const std::string& task);

  /// A text with its gaps filled, those of texts in it too; a list as TOML. A text `name` +
  /// `variant`, where there is one, is taken before `name`. Throws Error for a gap that nothing
  /// fills.
  [[nodiscard]] std::string filled(const std::string& name, const Gaps& gaps,
                                   const std::string& variant = {}) const;
  [[nodiscard]] double number(const std::string& name) const;
  /// A list, or one text, as sentences.
  [[nodiscard]] List sentences(const std::string& name, const Gaps& gaps,
                               const std::string& variant = {}) const;
  [[nodiscard]] Message sentence(const std::string& name, const Gaps& gaps,
                                 const std::string& variant = {}) const;

 private:
  struct Text {
    std::string toml;
    double number = 0.0;
    std::vector<std::string> items;
  };
  void read(const std::string& file);
  [[nodiscard]] const Text& text(const std::string& name, const std::string& variant) const;
  void fill(std::string& out, const std::string& text, const Gaps& gaps, const std::string& variant,
            int depth) const;
  std::string file_;
  std::map<std::string, Text> texts_;
};

/// Tasks on the block that ships, which has no landmarks: each file of data/tasks that begins with
/// block_.
[[nodiscard]] std::vector<std::string> block_task_words();
/// A whole scenario with comments, without mistakes. Throws Error that lists the tasks for any
/// other word.
[[nodiscard]] std::string block_task(const std::string& word);

}  // namespace cavum::scenarios
