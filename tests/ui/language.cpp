#include "tests/ui/language.h"

#include <algorithm>
#include <cctype>
#include <regex>
#include <set>

namespace cavum::testing_ui {
namespace {

std::string without(std::string text, const std::string& open, const std::string& close) {
  // from the innermost: what begins last ends first
  for (std::size_t end = text.find(close); end != std::string::npos; end = text.find(close)) {
    const std::size_t from = text.rfind(open, end);
    if (from == std::string::npos) {
      text.erase(end, close.size());
      continue;
    }
    text.replace(from, end + close.size() - from, " ");
  }
  return text;
}

}  // namespace

std::vector<std::string> untranslated(const std::string& text) {
  static const std::set<std::string> k_units{"mm",  "mm²", "mm³",  "ms",   "rpm",   "min",
                                             "kHz", "Hz",  "MB",   "SHA",  "Cavum", "UTC",
                                             "px",  "PDF", "JSON", "TOML", "CSV",   "Nm"};
  std::string rest = without(without(text, "\u27e6", "\u27e7"), "\u27e8", "\u27e9");
  std::vector<std::string> words;
  std::string word;
  const auto end_word = [&] {
    const auto letters = std::count_if(word.begin(), word.end(),
                                       [](unsigned char c) { return std::isalpha(c) != 0; });
    const bool digit =
        std::any_of(word.begin(), word.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
    const bool path = word.find('/') != std::string::npos || word.find('_') != std::string::npos ||
                      (word.find('.') != std::string::npos && word.back() != '.');
    while (!word.empty() && std::ispunct(static_cast<unsigned char>(word.back())) != 0)
      word.pop_back();
    while (!word.empty() && std::ispunct(static_cast<unsigned char>(word.front())) != 0)
      word.erase(0, 1);
    if (letters >= 2 && !digit && !path && !k_units.contains(word)) words.push_back(word);
    word.clear();
  };
  for (const char c : rest) {
    if (std::isspace(static_cast<unsigned char>(c)) != 0)
      end_word();
    else
      word += c;
  }
  end_word();
  return words;
}

std::string readable(const std::string& html) {
  std::string text;
  for (std::size_t at = 0; at < html.size();) {
    const std::size_t open = std::min(html.find('<', at), html.size());
    text += html.substr(at, open - at);
    if (open == html.size()) break;
    const std::size_t close = std::min(html.find('>', open), html.size());
    const std::string tag = html.substr(open, close - open);
    for (const std::string label : {"aria-label='", "title='"})
      if (const auto from = tag.find(label); from != std::string::npos)
        text += " " +
                tag.substr(from + label.size(),
                           tag.find('\'', from + label.size()) - from - label.size()) +
                " ";
    at = close + 1;
    for (const std::string skipped : {"style", "script"})
      if (tag.starts_with("<" + skipped)) at = std::min(html.find("</" + skipped, at), html.size());
    text += tag.starts_with("<bdi") || tag.starts_with("</bdi") || tag.starts_with("<tspan") ? ""
                                                                                             : "\n";
  }
  for (const auto& [reference, sign] : {std::pair<std::string, std::string>{"&#39;", "'"},
                                        {"&quot;", "\""},
                                        {"&lt;", "<"},
                                        {"&gt;", ">"},
                                        {"&#8594;", ""},
                                        {"&#8593;", ""},
                                        {"&amp;", "&"}})
    for (std::size_t at = text.find(reference); at != std::string::npos;
         at = text.find(reference, at))
      text.replace(at, reference.size(), sign);
  return text;
}

}  // namespace cavum::testing_ui
