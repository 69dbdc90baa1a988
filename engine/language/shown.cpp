#include "engine/language/shown.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "engine/base/kept.h"
#include "engine/base/text.h"
#include "engine/language/catalogue.h"
#include "engine/language/numbers.h"
#include "engine/language/say.h"

namespace cavum {
namespace {

constexpr int k_deepest = 12;
constexpr std::size_t k_most_remembered = 20'000, k_telling_letters = 16;
constexpr char k_open[] = "\u27e6";  // of the pseudo-language
constexpr std::size_t k_mark_bytes = 3;

/// The screens of a station say the same sentences sixty times a second. Of one thread.
struct Remembered {
  std::string text;
  bool known = false;  ///< some message said it; else it stays as it is
  int depth = 0;       ///< at which nothing said it: with more room to the deepest, something may
};
std::unordered_map<std::string, Remembered>& memory() {
  thread_local std::unordered_map<std::string, Remembered> m;
  thread_local std::string language;
  if (m.size() > k_most_remembered || language != catalogue().language()) m.clear();
  language = catalogue().language();
  return m;
}

/// What files brought. Read by all threads.
std::map<std::string, std::string>& of_files() {
  static std::map<std::string, std::string> texts;
  return texts;
}

bool has_letters(std::string_view text) {
  return std::any_of(text.begin(), text.end(), [](unsigned char c) { return std::isalpha(c) != 0; });
}

/// English words of which no name is made: where one is left, the sentence is not translated.
bool is_small_word(std::string_view word) {
  static const std::unordered_set<std::string_view> k_small{"a",  "an", "and",  "at",   "by",  "for", "from", "has", "in",
                                                            "is", "it", "its",  "no",   "not", "of",  "on",   "one", "only",
                                                            "or", "so", "than", "that", "the", "to",  "was",  "with"};
  return k_small.contains(word);
}

/// One word that no dictionary need hold: a name, an identifier, a path, a number with its unit. Several: names of people, each with a capital, an
/// option with its value, a path with spaces.
bool may_stand_as_it_is(std::string_view text) {
  if ((text.starts_with("--") || text.starts_with("/")) && text.find(": ") == text.npos && text.find("; ") == text.npos) return true;
  bool capitals = true, several = false;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string_view word = text.substr(at, end - at);
    if (is_small_word(word)) return false;
    several = several || at > 0;
    capitals = capitals && (word.empty() || !has_letters(word) || !(word.front() >= 'a' && word.front() <= 'z'));
    at = end + 1;
  }
  return !has_letters(text) || !several || capitals || is_number(text);
}

std::string sentence(std::string_view text, int depth, bool& known);

/// The message that the whole text is, with or without gaps. One with a gap that holds words of which nothing is known is none: a sentence is in one
/// language. Sentences of fewer letters than `least_letters` are left out, and those with gaps that do not begin with `begin`.
bool whole(std::string_view text, int depth, std::string& out, std::size_t least_letters = 0, std::string_view begin = {}) {
  const Catalogue& c = catalogue();
  const std::string exact(text);
  if (c.kind() != Catalogue::Kind::pseudo || c.knows(exact))
    if (auto t = c.find(exact)) {
      out = Pattern(exact).gaps() == 0 ? Pattern::fill(*t, {}) : *t;  // the page's messages keep their gaps
      return true;
    }
  for (const Said& s : Catalogue::said_sentences()) {
    if (s.pattern.all_letters() < least_letters) break;  // the longest stand first
    if (!std::string_view(s.message).starts_with(begin)) continue;
    auto gaps = s.pattern.match(text);
    if (!gaps || (!begin.empty() && s.before && !gaps->front().empty())) continue;  // it begins the text, too
    const auto t = c.find(s.message);
    if (!t) continue;
    bool all_known = true;
    for (std::size_t i = 0; i < gaps->size(); ++i) {
      std::string& g = (*gaps)[i];
      const bool quoted = s.pattern.quoted(i);  // what somebody wrote; of several words it may be a scenario's text
      if (quoted && g.find(' ') == std::string::npos) continue;
      bool known = quoted || may_stand_as_it_is(g);
      g = sentence(g, depth + 1, known);
      all_known = all_known && known;
    }
    if (!all_known) continue;
    const std::string before = s.before ? gaps->front() : "", after = s.after ? gaps->back() : "";
    if (s.before) gaps->erase(gaps->begin());
    if (s.after) gaps->pop_back();
    try {
      const std::vector<std::string> lines = lines_of(*t);
      if (s.line >= lines.size()) continue;
      out = before + Pattern::fill(lines[s.line], *gaps) + after;
      return true;
    } catch (const std::exception&) {  // a translation that does not fit: English
    }
  }
  return false;
}

std::ptrdiff_t characters(std::string_view text) {
  return std::count_if(text.begin(), text.end(), [](unsigned char c) { return (c & 0xc0U) != 0x80U; });
}

/// Columns, with two spaces or more between them: those behind stay where they were, as long as there is room.
bool in_columns(std::string_view text, int depth, std::string& out) {
  if (text.find("  ") == std::string_view::npos) return false;
  bool any = false;
  std::string all;
  std::ptrdiff_t longer = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find("  ", at), text.size()), next = std::min(text.find_first_not_of(' ', end), text.size());
    const std::string_view column = text.substr(at, end - at);
    const std::string said_so = sentence(column, depth + 1, any);
    longer += characters(said_so) - characters(column);
    const std::ptrdiff_t spaces = static_cast<std::ptrdiff_t>(next - end),
                         kept = end == text.size() ? 0 : std::max<std::ptrdiff_t>(1, spaces - longer);
    all += said_so + std::string(static_cast<std::size_t>(kept), ' ');
    longer += kept - spaces;
    at = next;
  }
  if (any) out = std::move(all);
  return any;
}

/// From `at` the message of most parts, two at least, which holds `between` itself: "plug one in; a USB pedal is seen within a second". `end` is then
/// where it ends.
bool whole_of_several(std::string_view text, std::size_t at, std::string_view between, int depth, std::size_t& end, std::string& out) {
  constexpr std::size_t k_most_parts = 8;
  if (end == text.npos || (between != "; " && between != ": ")) return false;
  std::vector<std::size_t> ends;
  for (std::size_t e = text.find(between, end + between.size()); ends.size() < k_most_parts; e = text.find(between, e + between.size())) {
    ends.push_back(e);
    if (e == text.npos) break;
  }
  for (auto e = ends.rbegin(); e != ends.rend(); ++e)
    if (!(at == 0 && *e == text.npos) && whole(text.substr(at, *e == text.npos ? *e : *e - at), depth + 1, out, k_telling_letters)) {
      end = *e;
      return true;
    }
  return false;
}

/// The parts that a text was put together from: sentences and items of a list each by itself, parts of a sentence only when all of them are known.
bool in_parts(std::string_view text, int depth, std::string& out, bool some_suffice) {
  if (some_suffice && in_columns(text, depth, out)) return true;
  constexpr std::array<std::string_view, 6> k_between{"; ", ". ", ": ", " (", ", ", " \u00b7 "};
  for (const std::string_view between : k_between) {
    if (text.find(between) == std::string_view::npos) continue;
    const bool by_itself = some_suffice && (between == "; " || between == ". " || between == " \u00b7 ");
    bool any = false, every = true;
    std::string all;
    for (std::size_t at = 0;;) {
      std::size_t end = text.find(between, at);
      std::string own;
      bool known = whole_of_several(text, at, between, depth, end, own);
      const std::string_view part = text.substr(at, end == std::string_view::npos ? end : end - at);
      const std::string joined = std::string(between).append(part);
      if (known) {
      } else if (at > 0 && (catalogue().knows(joined) || between == ", ") && whole(joined, depth + 1, own, 0, between)) {  // ", of it {} mm3 beyond"
        known = true;
        all.erase(all.size() - between.size());
      } else {
        own = sentence(part, depth + 1, known);
      }
      all += own;
      any = any || known;
      every = every && (known || may_stand_as_it_is(part));
      if (end == std::string_view::npos) break;
      all += between;
      at = end + between.size();
    }
    if (any && (every || by_itself)) {
      out = std::move(all);
      return true;
    }
  }
  return false;
}

/// Sentences one after another, each said by a message of its own.
bool in_sentences(std::string_view text, int depth, std::string& out) {
  std::string all;
  bool several = false;
  for (std::size_t at = 0;;) {
    std::size_t end = text.find(". ", at);
    while (end != text.npos && (end + 2 >= text.size() || std::isupper(static_cast<unsigned char>(text[end + 2])) == 0))
      end = text.find(". ", end + 2);
    if (end == text.npos && !several) return false;
    std::string own;
    if (!whole(text.substr(at, end == text.npos ? end : end + 1 - at), depth + 1, own, k_telling_letters)) return false;
    all += own;
    if (end == text.npos) break;
    several = true;
    all += ' ';
    at = end + 2;
  }
  out = std::move(all);
  return true;
}

std::string sentence(std::string_view text, int depth, bool& known) {
  if (depth > k_deepest || text.empty() || text.starts_with(k_open)) return std::string(text);
  if (text.front() == ' ' || text.back() == ' ') {
    std::string part;  // ", at " and the like; two spaces or more put a line in, and are no beginning of " of {}"
    const std::string_view begin = text.starts_with("  ") ? "  " : text.front() == ' ' ? " " : "";
    if (has_letters(text) && whole(text, depth, part, 0, begin)) {
      known = true;
      return part;
    }
    if (text.front() == ' ') {
      const std::size_t spaces = std::min(text.find_first_not_of(' '), text.size());
      return std::string(spaces, ' ') + sentence(text.substr(spaces), depth, known);
    }
    return sentence(text.substr(0, text.size() - 1), depth, known) + " ";
  }
  if (is_number(text)) {
    std::string number = with_decimal_sign(text);
    known = known || number != text;
    return number;
  }
  if (const std::size_t blank = text.find(' '); blank != std::string_view::npos && is_number(text.substr(0, blank))) {  // "0.80 mm2 of its wall"
    bool rest_known = false;
    std::string all;
    if (in_sentences(text, depth, all) || whole(text, depth, all)) {
      known = true;
      return all;
    }
    const std::string rest = sentence(text.substr(blank + 1), depth + 1, rest_known);
    if (rest_known) {
      known = true;
      return with_decimal_sign(text.substr(0, blank)) + " " + rest;
    }
  }
  for (const std::string_view begin : {"- ", "\u2022 ", "* ", ": ", "; ", ", ", "cavum: "})  // of a list, of what follows another part, of an error
    if (text.starts_with(begin) && text.size() > begin.size()) {
      bool rest_is_known = false;
      if (std::string part; begin.front() != 'c' && whole(text, depth, part, 0, begin)) {  // ", deepest {}"
        known = true;
        return part;
      }
      const std::string rest = sentence(text.substr(begin.size()), depth + 1, rest_is_known);
      if (!rest_is_known) break;
      known = true;
      return std::string(begin) + rest;
    }
  if (!has_letters(text)) return with_decimal_signs_in(text);
  if (const auto remembered = memory().find(std::string(text));
      remembered != memory().end() && (remembered->second.known || remembered->second.depth <= depth)) {
    known = known || remembered->second.known;
    return remembered->second.text;
  }
  std::string out;
  if (const auto own = of_files().find(std::string(text)); own != of_files().end()) {
    known = true;
    return own->second;
  }
  bool found = in_sentences(text, depth, out) || whole(text, depth, out, k_telling_letters);
  if (const char last = text.back(); !found && (last == '.' || last == ')' || last == ',' || last == ';' || last == ':') && text.size() > 1) {
    out = sentence(text.substr(0, text.size() - 1), depth + 1, found);
    out += last;
  }
  if (const auto colon = text.find(": "); !found && colon != text.npos) found = whole(text, depth, out, 0, text.substr(0, colon + 2));  // "note: {}"
  if (!found) found = in_parts(text, depth, out, false);
  if (!found) found = whole(text, depth, out);  // "{} at the {}" fits much that is put together of parts
  if (!found) found = in_parts(text, depth, out, true);
  if (!found) {  // what nothing says is asked for again and again, in each way in which a sentence may be put together
    memory()[std::string(text)] = {std::string(text), false, depth};
    return std::string(text);
  }
  memory()[std::string(text)] = {out, true, depth};
  memory()[out] = {out, false, 0};
  known = true;
  return out;
}

}  // namespace

void add_translations(const std::map<std::string, std::string>& texts) {
  for (const auto& [english, translated] : texts) of_files().insert_or_assign(english, translated);
  memory().clear();
}

std::string without_marks(std::string text) {
  for (const char* mark : {k_keep, k_keep_end})
    for (std::size_t at = text.find(mark); at != text.npos; at = text.find(mark, at)) text.erase(at, k_mark_bytes);
  return text;
}

std::string shown(std::string_view english) {
  if (catalogue().kind() == Catalogue::Kind::english) return std::string(english);
  if (english.find(k_keep) != english.npos) {  // each a number of its own while the rest is translated
    std::string line;
    std::vector<std::string> identifiers;
    for (std::size_t at = 0; at < english.size();) {
      const std::size_t from = english.find(k_keep, at), to = from == english.npos ? from : english.find(k_keep_end, from);
      if (to == english.npos) {
        line += english.substr(at);
        break;
      }
      line.append(english.substr(at, from - at)).append(fmt::format("{}{}{}", k_keep_end, identifiers.size(), k_keep_end));
      std::string_view identifier = english.substr(from + k_mark_bytes, to - from - k_mark_bytes);
      const std::size_t spaces = identifier.size() - (identifier.find_last_not_of(' ') + 1);  // of a column
      line.append(spaces, ' ');
      identifier.remove_suffix(spaces);
      identifiers.emplace_back(identifier);
      at = to + k_mark_bytes;
    }
    std::string out = shown(line);
    for (std::size_t i = 0; i < identifiers.size(); ++i) {
      const std::string mark = fmt::format("{}{}{}", k_keep_end, i, k_keep_end);
      const std::string text = catalogue().kind() == Catalogue::Kind::pseudo ? "\u27e8" + identifiers[i] + "\u27e9" : identifiers[i];
      if (const auto place = out.find(mark); place != out.npos) out.replace(place, mark.size(), text);
    }
    return out;
  }
  std::string out;
  for (std::size_t at = 0;;) {
    const std::size_t end = english.find('\n', at);
    bool changed = false;
    out += sentence(english.substr(at, end == std::string_view::npos ? end : end - at), 0, changed);
    if (end == std::string_view::npos) return out;
    out += '\n';
    at = end + 1;
  }
}

std::string remembered(std::string translated) {
  if (catalogue().kind() == Catalogue::Kind::translated) memory()[translated] = {translated, false, 0};
  return translated;
}

std::string shown_svg(std::string_view svg) {
  if (catalogue().kind() == Catalogue::Kind::english) return std::string(svg);
  constexpr std::array<std::pair<std::string_view, std::string_view>, 6> k_references{
      {{"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&#39;", "'"}, {"&apos;", "'"}, {"&amp;", "&"}}};
  const auto words = [&](std::string text) {
    // an arrow beside the words, as a reference, stays
    std::string before, after;
    if (text.starts_with("&#85") && text.find("; ") != text.npos) before = text.substr(0, text.find("; ") + 2);
    text.erase(0, before.size());
    if (const auto arrow = text.rfind(" &#85"); arrow != text.npos && text.ends_with(";")) after = text.substr(arrow);
    text.erase(text.size() - after.size());
    for (const auto& [reference, sign] : k_references)
      for (std::size_t at = text.find(reference); at != text.npos; at = text.find(reference, at + 1)) text.replace(at, reference.size(), sign);
    return before + xml_text(shown(text)) + after;
  };
  std::string out;
  for (std::size_t at = 0; at < svg.size();) {
    const std::size_t open = std::min(svg.find('<', at), svg.size());
    const std::string_view text = svg.substr(at, open - at);
    const bool blank = std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isspace(c) != 0; });
    out += blank ? std::string(text) : words(std::string(text));
    if (open == svg.size()) break;
    const std::size_t close = std::min(svg.find('>', open), svg.size() - 1);
    std::string tag(svg.substr(open, close + 1 - open));
    for (const std::string_view label : {"aria-label='", "title='"})
      if (const std::size_t from = tag.find(label); from != tag.npos) {
        const std::size_t begin = from + label.size(), end = tag.find('\'', begin);
        if (end != tag.npos) tag.replace(begin, end - begin, words(tag.substr(begin, end - begin)));
      }
    out += tag;
    at = close + 1;
  }
  return out;
}

}  // namespace cavum
