// The language of what people read: English, or one of which there is a catalogue (data/languages).
// What programs read (JSON, CSV, TOML, recordings, ledgers) is English always, and so are the
// strings of the rooms below: they are translated where they are shown (say.h, shown.h). One
// language a process.
#pragma once

#include <string>
#include <vector>

namespace cavum {

/// A language without a file, made of English: ⟦Ñüḿḅéŕ {}⟧. What is shown without brackets was not
/// translated.
inline constexpr char k_pseudo_language[] = "qps";

/// Of all languages that can be shown: "en", then those with a catalogue, by name.
[[nodiscard]] std::vector<std::string> languages();
/// The first language that there is of what $LANGUAGE (a list with colons), $LC_ALL, $LC_MESSAGES
/// and $LANG name, as POSIX writes them
/// ("de_AT.UTF-8"); else "en".
[[nodiscard]] std::string language_of_environment();
/// Shows that language from now on ("en", "de", "qps"). Call it before anything is shown, while
/// there is one thread. Throws Error when there is no such catalogue.
void set_language(const std::string& language);
/// "en" until set_language was called.
[[nodiscard]] const std::string& language() noexcept;
/// Between whole and decimal digits.
[[nodiscard]] char decimal_sign() noexcept;
/// Messages of the reports' page (ui/report/page), in English.
[[nodiscard]] const std::vector<std::string>& page_messages();
/// Takes `--language L` and `--language=L` out of a command line, and returns L; empty where it is
/// not there. Throws Error when L is missing.
[[nodiscard]] std::string take_language_option(std::vector<std::string>& arguments);

}  // namespace cavum
