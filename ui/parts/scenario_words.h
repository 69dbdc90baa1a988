// The texts of a scenario in the reader's language, where it has them: after this shown() knows them.
#pragma once

#include "engine/language/language.h"
#include "engine/language/shown.h"
#include "scenarios/file/scenario.h"

namespace cavum::ui {

inline void show_texts_of(const scenarios::Scenario& scenario) {
  if (const auto own = scenario.languages.find(language()); own != scenario.languages.end()) add_translations(own->second);
}

}  // namespace cavum::ui
