#include "scenarios/file/edit_text.h"

#include <fmt/core.h>
#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/base/toml_limits.h"

namespace cavum::scenarios {
namespace {

constexpr const char* k_elsewhere = noop("change it in a text editor");

/// Past a text in quotes that begins at `i`.
std::size_t after_quotes(const std::string& text, std::size_t i) {
  const char quote = text[i];
  const std::string three(3, quote);
  if (text.compare(i, 3, three) == 0) {
    for (i += 3; i < text.size() && text.compare(i, 3, three) != 0; ++i)
      if (quote == '"' && text[i] == '\\') ++i;
    i = std::min(i + 3, text.size());
    while (i < text.size() && text[i] == quote)
      ++i;  // one or two quotes may stand before the closing ones
    return i;
  }
  for (++i; i < text.size() && text[i] != quote; ++i)
    if (quote == '"' && text[i] == '\\') ++i;
  return std::min(i + 1, text.size());
}

/// Past the value that begins at `i`.
std::size_t after_value(const std::string& text, std::size_t i) {
  if (text[i] == '"' || text[i] == '\'') return after_quotes(text, i);
  if (text[i] != '[' && text[i] != '{') {
    i = std::min(text.find_first_of(",]}#\r\n", i), text.size());
    while (i > 0 && (text[i - 1] == ' ' || text[i - 1] == '\t')) --i;
    return i;
  }
  int depth = 0;
  while (i < text.size()) {
    const char c = text[i];
    if (c == '"' || c == '\'') {
      i = after_quotes(text, i);
      continue;
    }
    if (c == '#') {
      i = std::min(text.find('\n', i), text.size());
      continue;
    }
    ++i;
    if (c == '[' || c == '{') ++depth;
    if ((c == ']' || c == '}') && --depth == 0) return i;
  }
  return i;
}

/// The text with its meaning, and where the values of that stand in it.
class ReadToml {
 public:
  ReadToml(const std::string& text, const std::string& path) : text_(text), path_(path) {
    if (const auto beyond = beyond_toml_limits(text))
      throw Error(FileLocation{path, static_cast<int>(beyond->line), 1}, beyond->what,
                  beyond->what_to_do);
    try {
      table_ = toml::parse(std::string_view(text), path);
    } catch (const toml::parse_error& e) {
      throw Error(fmt::format("{}:{}:{}", path, e.source().begin.line, e.source().begin.column),
                  msg("is no TOML ({})", one_line(e.description())), msg(k_elsewhere));
    }
    lines_.push_back(text.starts_with("\xef\xbb\xbf") ? 3 : 0);  // a byte order mark is no column
    for (std::size_t i = 0; i < text.size(); ++i)
      if (text[i] == '\n') lines_.push_back(i + 1);
  }

  /// What stands at a place; null when its last part is not there.
  struct Found {
    const toml::node* node = nullptr;
    const toml::node* holder = nullptr;
    std::string key;
  };
  [[nodiscard]] Found find(const std::string& place) const {
    Found f{&table_, nullptr, {}};
    for (std::size_t i = 0; i <= place.size();) {
      const std::size_t end = std::min(place.find('/', i), place.size());
      const std::string key = place.substr(i, end - i);
      if (f.node == nullptr)
        throw Error(path_, msg("has no '{}'", place.substr(0, i - 1)),
                    msg("write it in a text editor"));
      f = {next(*f.node, key), f.node, key};
      i = end + 1;
    }
    return f;
  }
  /// The same where it must be there.
  [[nodiscard]] const toml::node& at(const std::string& place) const {
    const Found f = find(place);
    if (f.node == nullptr)
      throw Error(path_, msg("has no '{}'", place), msg("write it in a text editor"));
    return *f.node;
  }
  [[nodiscard]] const toml::array& list(const std::string& place) const {
    const auto* array = at(place).as_array();
    if (array == nullptr) fail(at(place), msg("'{}' is no list", place));
    return *array;
  }

  [[nodiscard]] std::size_t begin_of(const toml::node& node) const {
    const auto place = node.source().begin;
    if (place.line == 0 || place.line > lines_.size())
      throw Error(path_, msg("has a value without a place of its own"), msg(k_elsewhere));
    std::size_t i = lines_[place.line - 1];
    // columns count letters, not bytes
    for (auto left = place.column; left > 1 && i < text_.size(); --left)
      for (++i; i < text_.size() && (static_cast<unsigned char>(text_[i]) & 0xc0U) == 0x80U;) ++i;
    return i;
  }
  [[nodiscard]] std::size_t end_of(const toml::node& node) const {
    return after_value(text_, begin_of(node));
  }

  /// A table under its own [header].
  [[nodiscard]] bool has_header(const toml::node& node) const {
    if (node.is_table()) return text_[begin_of(node)] == '[';
    const auto* array = node.as_array();
    return array != nullptr && !array->empty() && array->is_array_of_tables() &&
           has_header((*array)[0]);
  }
  /// Where the last value of a table ends, apart from tables with a header of their own; npos when
  /// it has none.
  [[nodiscard]] std::size_t end_of_last(const toml::table& table) const {
    std::size_t last = std::string::npos;
    for (auto&& [key, node] : table) {
      if (has_header(node)) continue;
      const auto* dotted = node.as_table();
      const bool braces = dotted == nullptr || text_[begin_of(node)] == '{';
      const std::size_t end = braces ? end_of(node) : end_of_last(*dotted);
      if (end != std::string::npos && (last == std::string::npos || end > last)) last = end;
    }
    return last;
  }

  [[noreturn]] void fail(const toml::node& node, const Message& what) const {
    throw Error(
        fmt::format("{}:{}:{}", path_, node.source().begin.line, node.source().begin.column), what,
        msg(k_elsewhere));
  }
  [[nodiscard]] const std::string& text() const noexcept { return text_; }
  [[nodiscard]] const toml::table& root() const noexcept { return table_; }

 private:
  const toml::node* next(const toml::node& node, const std::string& key) const {
    if (const auto* array = node.as_array()) {
      std::size_t index = 0;
      const auto read = std::from_chars(key.data(), key.data() + key.size(), index);
      if (read.ec != std::errc{} || read.ptr != key.data() + key.size())
        fail(node, msg("a list was met where '{}' was looked for", key));
      return index < array->size() ? &(*array)[index] : nullptr;
    }
    if (const auto* table = node.as_table()) {
      // one [zones.target] alone counts as a list of one
      if (key == "0" && !table->contains(key)) return table;
      return table->get(key);
    }
    fail(node, msg("a single value was met where '{}' was looked for", key));
  }

  const std::string& text_;
  const std::string& path_;
  toml::table table_;
  std::vector<std::size_t> lines_;
};

double number_at(const ReadToml& reading, const toml::node& node, const std::string& place) {
  if (!node.is_number()) reading.fail(node, msg("'{}' is no number", place));
  return node.value<double>().value_or(0.0);
}

std::string written_point(double x, double y) {
  return fmt::format("[{}, {}]", written_number(x), written_number(y));
}

/// A number where one stands; a number that is written otherwise but is the same stays.
TextChange replaced(const ReadToml& r, const toml::node& node, const std::string& place,
                    double value) {
  const std::size_t begin = r.begin_of(node), end = r.end_of(node);
  TextChange c{begin, r.text().substr(begin, end - begin), written_number(value)};
  if (written_number(number_at(r, node, place)) == c.inserted) c.inserted = c.removed;
  return c;
}

/// A key that its table does not have yet: after the last value of it.
TextChange added(const ReadToml& r, const ReadToml::Found& f, const std::string& place,
                 const std::string& value) {
  const auto* table = f.holder->as_table();
  if (table == nullptr) r.fail(*f.holder, msg("there is no '{}'", place));
  const std::string line = fmt::format("{} = {}", f.key, value);
  const std::size_t begin = r.begin_of(*f.holder), last = r.end_of_last(*table);
  if (r.text()[begin] == '{') {
    if (last != std::string::npos) return {last, "", ", " + line};
    const std::size_t end = r.end_of(*f.holder);
    return {begin, r.text().substr(begin, end - begin), fmt::format("{{ {} }}", line)};
  }
  if (r.text()[begin] != '[')
    r.fail(*f.holder, msg("'{}' cannot be added to a table that is written in dotted keys", f.key));
  const std::size_t newline = r.text().find('\n', last == std::string::npos ? begin : last);
  const std::size_t first = r.text().find('\n');
  const std::string line_end =
      first != std::string::npos && first > 0 && r.text()[first - 1] == '\r' ? "\r\n" : "\n";
  if (newline == std::string::npos) return {r.text().size(), "", line_end + line};
  return {newline + 1, "", line + line_end};
}

/// Throws unless the text afterwards holds these numbers there (`at`: of a number or of a list of
/// them).
TextChange proved(const ReadToml& before, const std::string& path, const TextChange& change,
                  const std::string& at, const std::vector<double>& wanted) {
  const std::string text = with_change(before.text(), change);
  const ReadToml after(text, path);
  const toml::node& node = after.at(at);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const auto* array = node.as_array();
    const double is = number_at(after, array != nullptr ? *array->get(i) : node, at);
    if (written_number(is) != written_number(wanted[i]))
      after.fail(node, msg("'{}' did not become {}", at, written_number(wanted[i])));
  }
  return change;
}

void require_number(const std::string& path, double v) {
  if (!(std::fabs(v) <= 1e6))
    throw Error(path, msg("a number beyond a million was to be written"),
                msg("use mm and degrees"));
}

}  // namespace

std::string with_change(const std::string& text, const TextChange& change) {
  if (change.at > text.size() ||
      text.compare(change.at, change.removed.size(), change.removed) != 0)
    throw Error(msg("text"), msg("is not what the change was made for"),
                msg("make the change anew"));
  std::string changed = text;
  return changed.replace(change.at, change.removed.size(), change.inserted);
}

TextChange inverse(const TextChange& change) {
  return {change.at, change.inserted, change.removed};
}

std::string written_number(double value) {
  std::string s = fixed(value, 3);
  while (s.back() == '0') s.pop_back();
  if (s.back() == '.') s.pop_back();
  return s == "-0" ? "0" : s;
}

TextChange set_number(const std::string& text, const std::string& path, const std::string& place,
                      double value) {
  require_number(path, value);
  const ReadToml r(text, path);
  const ReadToml::Found f = r.find(place);
  return proved(r, path,
                f.node != nullptr ? replaced(r, *f.node, place, value)
                                  : added(r, f, place, written_number(value)),
                place, {value});
}

TextChange set_text(const std::string& text, const std::string& path, const std::string& place,
                    const std::string& value) {
  std::string quoted = "\"";
  for (const char letter : value) {
    if (static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f)
      throw Error(path, msg("'{}' was to be written with a control character", place),
                  msg("use letters, digits and punctuation"));
    if (letter == '"' || letter == '\\') quoted += '\\';
    quoted += letter;
  }
  quoted += '"';
  const ReadToml r(text, path);
  const toml::node& node = r.at(place);
  if (!node.is_string()) r.fail(node, msg("'{}' is no text", place));
  if (node.value<std::string>() == value) return {};
  const std::size_t begin = r.begin_of(node);
  TextChange change{begin, text.substr(begin, r.end_of(node) - begin), quoted};
  const std::string changed = with_change(text, change);
  if (ReadToml(changed, path).at(place).value<std::string>() != value)
    r.fail(node, msg("'{}' did not become {}", place, quoted));
  return change;
}

TextChange set_point(const std::string& text, const std::string& path, const std::string& place,
                     double x_mm, double y_mm) {
  require_number(path, x_mm);
  require_number(path, y_mm);
  const ReadToml r(text, path);
  const ReadToml::Found f = r.find(place);
  if (f.node == nullptr)
    return proved(r, path, added(r, f, place, written_point(x_mm, y_mm)), place, {x_mm, y_mm});
  const auto* array = f.node->as_array();
  if (array == nullptr || array->size() < 2)
    r.fail(*f.node, msg("'{}' is no list of numbers", place));
  const TextChange x = replaced(r, (*array)[0], place, x_mm),
                   y = replaced(r, (*array)[1], place, y_mm);
  const std::size_t after_x = x.at + x.removed.size();
  const std::string between = text.substr(after_x, y.at - after_x);
  return proved(r, path, {x.at, x.removed + between + y.removed, x.inserted + between + y.inserted},
                place, {x_mm, y_mm});
}

TextChange insert_point(const std::string& text, const std::string& path, const std::string& place,
                        std::size_t index, double x_mm, double y_mm) {
  require_number(path, x_mm);
  require_number(path, y_mm);
  const ReadToml r(text, path);
  const toml::array& list = r.list(place);
  if (list.empty() || index > list.size())
    r.fail(list, msg("'{}' has no place {} for a point", place, index));
  // parted as its neighbours are, unless a comment stands between them
  std::string parting = ", ";
  if (list.size() > 1) {
    const std::size_t i = std::clamp<std::size_t>(index, 1, list.size() - 1),
                      end = r.end_of(list[i - 1]);
    if (const std::string between = text.substr(end, r.begin_of(list[i]) - end);
        between.find('#') == std::string::npos)
      parting = between;
  }
  const std::string point = written_point(x_mm, y_mm);
  const TextChange change = index == 0 ? TextChange{r.begin_of(list[0]), "", point + parting}
                                       : TextChange{r.end_of(list[index - 1]), "", parting + point};
  return proved(r, path, change, fmt::format("{}/{}", place, index), {x_mm, y_mm});
}

TextChange remove_point(const std::string& text, const std::string& path, const std::string& place,
                        std::size_t index) {
  const ReadToml r(text, path);
  const toml::array& list = r.list(place);
  if (index >= list.size() || list.size() < 2)
    r.fail(list, msg("'{}' has no point {} to spare", place, index));
  std::size_t begin = r.begin_of(list[index]), end = r.end_of(list[index]);
  const auto bare = [&](std::size_t a, std::size_t b) {
    return text.substr(a, b - a).find('#') == std::string::npos;
  };
  if (index + 1 < list.size()) {
    const std::size_t next = r.begin_of(list[index + 1]);
    if (bare(end, next)) {
      end = next;
    } else if (const std::size_t comma = text.find(',', end); bare(end, comma)) {
      end = comma + 1;
    } else {
      r.fail(list[index], msg("a comment stands between this point and its comma"));
    }
  } else if (const std::size_t before = r.end_of(list[index - 1]); bare(before, begin)) {
    begin = before;
  } else if (const std::size_t more = text.find_first_not_of(" \t\r\n", end);
             more != std::string::npos && text[more] == ',') {
    end = more + 1;
  }
  TextChange change{begin, text.substr(begin, end - begin), ""};
  const std::string changed = with_change(text, change);
  if (ReadToml(changed, path).list(place).size() + 1 != list.size())
    r.fail(list[index], msg("the point could not be taken out"));
  return change;
}

}  // namespace cavum::scenarios
