#include "engine/base/toml_limits.h"

#include <fmt/core.h>

#include <algorithm>

namespace cavum {
namespace {

/// Walks a text by TOML's rules for strings and comments. Up to a text's first mistake it sees what
/// the parser sees; what follows is never kept.
class Scan {
 public:
  explicit Scan(std::string_view text) : text_(text) {}

  std::optional<TomlExcess> run() {
    if (text_.size() > k_toml_bytes)
      return excess(msg("is a text of {} bytes", text_.size()), k_toml_bytes);
    while (at_ < text_.size()) {
      take();
      if (parts_ > k_toml_parts)
        return excess(msg("a name has {} parts or more", parts_), k_toml_parts);
      if (depth_ > k_toml_depth)
        return excess(msg("lists and tables are nested {} deep", depth_), k_toml_depth);
      if (values_ > k_toml_values)
        return excess(msg("there are {} values or more", values_), k_toml_values);
      if (named_ > k_toml_named)
        return excess(msg("headers and dotted names have {} parts or more", named_), k_toml_named);
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] std::optional<TomlExcess> excess(const Message& what, std::size_t limit) const {
    return TomlExcess{line_, msg("{}, beyond the limit of {}", what, limit),
                      msg("shorten the file, or use an intact copy")};
  }

  void take() {
    const char c = text_[at_++];
    const bool header = line_begins_ && depth_ == 0 && c == '[';
    if (c != ' ' && c != '\t') line_begins_ = false;
    switch (c) {
      case '\n':
        if (in_header_) depth_ = 0;
        in_header_ = false;
        line_begins_ = true;
        ++line_;
        parts_ = 1;
        break;
      case '#':
        at_ = std::min(text_.find('\n', at_), text_.size());
        break;
      case '"':
      case '\'':
        skip_string(c);
        break;
      case '.':
        ++parts_;
        break;
      case '[':
      case '{':
        in_header_ = in_header_ || header;
        ++depth_;
        parts_ = 1;
        break;
      case ']':
      case '}':
        if (in_header_) named_ += parts_;
        depth_ -= depth_ > 0 ? 1 : 0;
        parts_ = 1;
        break;
      case '=':
        if (parts_ > 1) named_ += parts_;
        [[fallthrough]];
      case ',':
        ++values_;
        parts_ = 1;
        break;
      default:
        break;
    }
  }

  /// From behind the first quote to behind the last.
  void skip_string(char quote) {
    const bool escapes = quote == '"';
    const std::string three(3, quote);
    if (text_.substr(at_, 2) == three.substr(0, 2)) {
      for (at_ += 2; at_ < text_.size() && text_.substr(at_, 3) != three; ++at_) step_over(escapes);
      at_ = std::min(at_ + 3, text_.size());
      for (int more = 0; more < 2 && at_ < text_.size() && text_[at_] == quote; ++more)
        ++at_;  // quotes that end the text itself
      return;
    }
    for (; at_ < text_.size() && text_[at_] != quote; ++at_) {
      if (text_[at_] == '\n') return;  // no string may hold it
      step_over(escapes);
    }
    at_ = std::min(at_ + 1, text_.size());
  }
  void step_over(bool escapes) {
    if (escapes && text_[at_] == '\\' && at_ + 1 < text_.size()) ++at_;
    line_ += text_[at_] == '\n' ? 1 : 0;
  }

  std::string_view text_;
  std::size_t at_ = 0, line_ = 1, parts_ = 1, depth_ = 0, values_ = 0, named_ = 0;
  bool line_begins_ = true, in_header_ = false;
};

}  // namespace

std::optional<TomlExcess> beyond_toml_limits(std::string_view text) { return Scan(text).run(); }

}  // namespace cavum
