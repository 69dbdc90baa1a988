// The texts of a scenario in the reader's language, where it has them: after this a message with
// one of them (Authored) is in it.
#pragma once

#include "scenarios/file/scenario.h"
#include "ui/language/language.h"
#include "ui/language/say.h"

namespace cavum::ui {

inline void show_texts_of(const scenarios::Scenario& scenario) {
  if (const auto own = scenario.languages.find(language()); own != scenario.languages.end())
    add_translations(own->second);
}

/// One of its texts, while it is still being written.
[[nodiscard]] inline std::string text_of(const scenarios::Scenario& scenario,
                                         const std::string& english) {
  const auto own = scenario.languages.find(language());
  if (own == scenario.languages.end()) return english;
  const auto text = own->second.find(english);
  return text == own->second.end() ? english : text->second;
}

}  // namespace cavum::ui
