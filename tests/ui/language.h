// What of a text was shown in the pseudo-language, and what was not.
#pragma once

#include <string>
#include <vector>

namespace cavum::testing_ui {

/// Words of two letters or more of `text` that stand in no brackets ⟦ … ⟧ of the pseudo-language
/// and were not passed as they are (⟨ … ⟩): nobody translated them. Units, numbers and what holds a
/// digit (hashes, dates, names of files) are no words.
[[nodiscard]] std::vector<std::string> untranslated(const std::string& text);

/// What a person reads of a page: texts of elements and labels, without style, scripts and tags.
[[nodiscard]] std::string readable(const std::string& html);

}  // namespace cavum::testing_ui
