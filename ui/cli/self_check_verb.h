// `cavum devices --self-check`: the station checks its own stylus, and says what changed.
#pragma once

#include <string>

namespace cavum::ui {

struct SelfCheckArguments {
  std::string stylus;
  std::string new_history;  ///< reason; empty: none
  std::string go_on;     ///< why exams take place with what the last check found; empty: not asked
  bool history = false;  ///< only what was kept
  bool json = false;
};

/// 0 when nothing changed, or while it learns; 1 when something changed or the check says nothing.
/// Throws Error.
[[nodiscard]] int self_check(const SelfCheckArguments& o);

}  // namespace cavum::ui
