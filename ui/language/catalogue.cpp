#include "ui/language/catalogue.h"

#include <algorithm>
#include <boost/locale/gnu_gettext.hpp>
#include <boost/locale/message.hpp>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/pseudo.h"
#include "engine/base/shipped.h"
#include "engine/base/text.h"
#include "ui/language/language.h"

namespace cavum {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_page_messages[] = {
#include <cavum_page_messages.inc>
    "",
};

/// Folders of catalogues, L/LC_MESSAGES/cavum.mo in them: built ones stand beside the program that
/// was built, installed ones in share/cavum.
std::vector<fs::path> catalogue_folders() {
  std::vector<fs::path> out;
  for (const auto& data : shipped_folders()) out.push_back(data / "languages");
  constexpr int k_deepest_build = 6;
  fs::path folder = program_folder();
  for (int up = 0; up < k_deepest_build && folder.has_relative_path();
       ++up, folder = folder.parent_path())
    out.push_back(folder / "languages");
  return out;
}

bool is_catalogue_of(const fs::path& folder, const std::string& language) {
  std::error_code none;
  return fs::is_regular_file(folder / language / "LC_MESSAGES" / "cavum.mo", none);
}

/// "de" of "de_AT.UTF-8@euro"; "en" of "C" and "POSIX".
std::string language_part(const std::string& locale) {
  const std::string name = locale.substr(0, locale.find_first_of("_.@-"));
  return name == "C" || name == "POSIX" ? "en" : name;
}

Catalogue& current() {
  static Catalogue c;
  return c;
}

}  // namespace

Catalogue::Catalogue(const std::string& language) : language_(language) {
  if (language == "en") return;
  if (language == k_pseudo_language) {
    kind_ = Kind::pseudo;
    return;
  }
  const std::vector<fs::path> folders = catalogue_folders();
  const auto folder = std::find_if(folders.begin(), folders.end(),
                                   [&](const fs::path& f) { return is_catalogue_of(f, language); });
  if (language.empty() || language.find('/') != std::string::npos || folder == folders.end()) {
    throw Error("--language", msg("there is no catalogue of '{}'", language),
                msg("give one of {}", list_of(languages())));
  }
  boost::locale::gnu_gettext::messages_info info;
  info.language = language;
  info.encoding = "UTF-8";
  info.domains.emplace_back("cavum");
  info.paths.push_back(folder->string());
  locale_ = std::locale(std::locale::classic(),
                        boost::locale::gnu_gettext::create_messages_facet<char>(info));
  kind_ = Kind::translated;
  // the catalogue says it, as the translator of this message
  if (const auto sign = find(noop(".")); sign && sign->size() == 1) decimal_sign_ = sign->front();
}

std::optional<std::string> Catalogue::find(const std::string& english) const {
  if (kind_ == Kind::pseudo) return pseudo(english);
  if (kind_ == Kind::english) return std::nullopt;
  const char* text =
      std::use_facet<boost::locale::message_format<char>>(locale_).get(0, nullptr, english.c_str());
  return text != nullptr && *text != 0 ? std::optional<std::string>(text) : std::nullopt;
}

std::optional<std::string> Catalogue::find(const std::string& one, const std::string& many,
                                           long long count) const {
  if (kind_ == Kind::pseudo) return pseudo(count == 1 ? one : many);
  if (kind_ == Kind::english) return std::nullopt;
  const int n = static_cast<int>(std::clamp<long long>(count, 0, std::numeric_limits<int>::max()));
  const char* text =
      std::use_facet<boost::locale::message_format<char>>(locale_).get(0, nullptr, one.c_str(), n);
  return text != nullptr && *text != 0 ? std::optional<std::string>(text) : std::nullopt;
}

const Catalogue& catalogue() noexcept { return current(); }

std::vector<std::string> languages() {
  std::set<std::string> found;
  for (const auto& folder : catalogue_folders()) {
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder, none))
      if (is_catalogue_of(folder, entry.path().filename().string()))
        found.insert(entry.path().filename().string());
  }
  std::vector<std::string> out{"en"};
  out.insert(out.end(), found.begin(), found.end());
  return out;
}

std::string language_of_environment() {
  const std::vector<std::string> known = languages();
  std::vector<std::string> asked;
  for (const char* name : {"LANGUAGE", "LC_ALL", "LC_MESSAGES", "LANG"}) {
    const char* value = std::getenv(name);
    std::string list = value != nullptr ? value : "";
    for (std::size_t at = 0; at < list.size();) {
      const std::size_t end = std::min(list.find(':', at), list.size());
      asked.push_back(language_part(list.substr(at, end - at)));
      at = end + 1;
    }
  }
  for (const auto& a : asked)
    if (a == k_pseudo_language || std::find(known.begin(), known.end(), a) != known.end()) return a;
  return "en";
}

void set_language(const std::string& language) { current() = Catalogue(language); }

const std::string& language() noexcept { return current().language(); }

char decimal_sign() noexcept { return current().decimal_sign(); }

const std::vector<std::string>& page_messages() {
  static const std::vector<std::string> all(std::begin(k_page_messages),
                                            std::end(k_page_messages) - 1);
  return all;
}

std::string take_language_option(std::vector<std::string>& arguments) {
  std::string language;
  for (std::size_t i = 0; i < arguments.size() && arguments[i] != "--";) {
    constexpr std::string_view k_option = "--language";
    const std::string a = arguments[i];
    if (a == k_option) {
      if (i + 1 == arguments.size())
        throw Error(msg("command line"), msg("--language needs a language"),
                    msg("give one, for example --language de"));
      language = arguments[i + 1];
      arguments.erase(arguments.begin() + static_cast<std::ptrdiff_t>(i),
                      arguments.begin() + static_cast<std::ptrdiff_t>(i) + 2);
    } else if (a.starts_with(std::string(k_option) + "=")) {
      language = a.substr(k_option.size() + 1);
      arguments.erase(arguments.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      ++i;
    }
  }
  return language;
}

}  // namespace cavum
