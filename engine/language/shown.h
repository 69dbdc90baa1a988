// What was said in English elsewhere, in the reader's language: results, findings and errors of the rooms below, also those that a file holds.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace cavum {

/// `english` in the reader's language. The catalogue has sentences with gaps ("{} of {} steps"); the one with the most letters that fits gives the
/// translation, and what stood in its gaps is translated likewise. Sentences that were put together with "; ", ": ", ", " or ". " are translated part
/// by part. Numbers get the language's decimal sign. What no sentence fits stays English. Line ends stay.
[[nodiscard]] std::string shown(std::string_view english);
/// What is left of a text with identifiers that were marked (base/kept.h) when nothing translates it.
[[nodiscard]] std::string without_marks(std::string text);
/// The texts in a picture: what stands between its tags, and its labels.
[[nodiscard]] std::string shown_svg(std::string_view svg);

/// Texts that a file brings in the reader's language (a scenario's), by the English ones: shown() takes them before the catalogue's. Those of several
/// files add up; one that differs takes the place of the earlier. Call it before other threads show anything.
void add_translations(const std::map<std::string, std::string>& texts);

/// The same string, of which shown() knows from now on that it is in the reader's language already.
[[nodiscard]] std::string remembered(std::string translated);

}  // namespace cavum
