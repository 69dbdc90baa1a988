// What was said in English elsewhere, in the reader's language: results, findings and errors of the rooms below, also those that a file holds.
#pragma once

#include <string>
#include <string_view>

namespace cavum {

/// `english` in the reader's language. The catalogue has sentences with gaps ("{} of {} steps"); the one with the most letters that fits gives the translation,
/// and what stood in its gaps is translated likewise. Sentences that were put together with "; ", ": ", ", " or ". " are translated part by part. Numbers get the
/// language's decimal sign. What no sentence fits stays English. Line ends stay.
[[nodiscard]] std::string shown(std::string_view english);
/// The texts in a picture: what stands between its tags, and its labels.
[[nodiscard]] std::string shown_svg(std::string_view svg);

/// The same string, of which shown() knows from now on that it is in the reader's language already.
[[nodiscard]] std::string remembered(std::string translated);

}  // namespace cavum
