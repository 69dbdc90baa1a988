#include "engine/base/text.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <utility>

namespace cavum {
namespace {

/// Bytes of the UTF-8 character that `text` (not empty) begins with; 0 when it begins with none.
std::size_t utf8_length(std::string_view text) noexcept {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t n = first >= 0xc2 && first <= 0xdf   ? 2
                        : first >= 0xe0 && first <= 0xef ? 3
                        : first >= 0xf0 && first <= 0xf4 ? 4
                                                         : 0;
  if (n == 0 || text.size() < n) return 0;
  // longer than needed, half of a pair of UTF-16, or beyond the last character
  const unsigned low = first == 0xe0   ? 0xa0
                       : first == 0xf0 ? 0x90
                                       : 0x80,
                 high = first == 0xed   ? 0x9f
                        : first == 0xf4 ? 0x8f
                                        : 0xbf;
  if (byte(1) < low || byte(1) > high) return 0;
  for (std::size_t i = 2; i < n; ++i)
    if ((byte(i) & 0xc0) != 0x80) return 0;
  return n;
}

/// Code point of a whole UTF-8 character of `n` bytes.
char32_t code_of(std::string_view text, std::size_t n) noexcept {
  const auto byte = [&](std::size_t i) {
    return static_cast<char32_t>(static_cast<unsigned char>(text[i]));
  };
  char32_t code = n == 1 ? byte(0) : byte(0) & (0xffu >> (n + 1));
  for (std::size_t i = 1; i < n; ++i) code = code << 6 | (byte(i) & 0x3f);
  return code;
}

bool is_control(char32_t c) noexcept {
  return c < 0x20 || (c >= 0x7f && c < 0xa0) || (c >= 0x2028 && c <= 0x202e) ||
         (c >= 0x2066 && c <= 0x2069);
}

/// Blanks other than a space, and characters without a picture (Unicode: White_Space,
/// Default_Ignorable_Code_Point, and the empty braille pattern).
bool is_unseen(char32_t c) noexcept {
  static constexpr std::pair<char32_t, char32_t> k_unseen[] = {
      {0xa0, 0xa0},      {0xad, 0xad},     {0x34f, 0x34f},   {0x61c, 0x61c},     {0x115f, 0x1160},
      {0x1680, 0x1680},  {0x17b4, 0x17b5}, {0x180b, 0x180f}, {0x2000, 0x200f},   {0x2028, 0x202f},
      {0x205f, 0x206f},  {0x2800, 0x2800}, {0x3000, 0x3000}, {0x3164, 0x3164},   {0xfe00, 0xfe0f},
      {0xfeff, 0xfeff},  {0xffa0, 0xffa0}, {0xfff0, 0xfff8}, {0x1bca0, 0x1bca3}, {0x1d173, 0x1d17a},
      {0xe0000, 0xe0fff}};
  return std::any_of(std::begin(k_unseen), std::end(k_unseen),
                     [c](const auto& range) { return c >= range.first && c <= range.second; });
}

/// Whether `is` holds of one of its whole characters.
template <class Is>
bool any_character(std::string_view text, const Is& is) {
  while (!text.empty()) {
    const std::size_t n = utf8_length(text);
    if (n != 0 && is(code_of(text, n))) return true;
    text.remove_prefix(n == 0 ? 1 : n);
  }
  return false;
}

/// Copies `text` character by character; `control` writes what stands for a control character,
/// `plain` for another of one byte.
template <class Control, class Plain>
std::string rewritten(std::string_view text, const Control& control, const Plain& plain) {
  std::string out;
  while (!text.empty()) {
    const std::size_t n = utf8_length(text);
    const char32_t code = n == 0 ? U'?' : code_of(text, n);
    if (n == 0)
      out += '?';
    else if (is_control(code))
      out += control(code);
    else if (n > 1)
      out += text.substr(0, n);
    else
      out += plain(text.front());
    text.remove_prefix(n == 0 ? 1 : n);
  }
  return out;
}

std::string json_escape(char32_t code) {
  return fmt::format("\\u{:04x}", static_cast<unsigned>(code) & 0xffffu);
}

bool is_number(std::string_view text) noexcept {
  double value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  return read.ec == std::errc() && read.ptr == text.data() + text.size() && std::isfinite(value);
}

/// What a spreadsheet reads as a formula: = + - @, and the wide ones of East Asian keyboards,
/// behind spaces too.
bool begins_formula(std::string_view text) noexcept {
  text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  for (const std::string_view sign :
       {"=", "+", "@", "-", "\xef\xbc\x9d", "\xef\xbc\x8b", "\xef\xbc\x8d", "\xef\xbc\xa0"})
    if (text.starts_with(sign)) return !is_number(text);
  return false;
}

std::string xml_character(char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&#39;";
    default:
      return {c};
  }
}

}  // namespace

bool is_plain_text(std::string_view text) noexcept {
  while (!text.empty()) {
    const std::size_t n = utf8_length(text);
    if (n == 0 || is_control(code_of(text, n))) return false;
    text.remove_prefix(n);
  }
  return true;
}

bool is_seen_text(std::string_view text) noexcept {
  return is_plain_text(text) &&
         any_character(text, [](char32_t c) { return c != U' ' && !is_unseen(c); });
}

bool holds_unseen(std::string_view text) noexcept { return any_character(text, is_unseen); }

std::string one_line(std::string_view text) {
  return rewritten(
      text, [](char32_t) { return ' '; }, [](char c) { return c; });
}

std::string xml_text(std::string_view text) {
  const auto control = [](char32_t c) -> std::string {
    return c == '\n' ? "&#10;" : c == '\r' ? "&#13;" : c == '\t' ? "&#9;" : "?";
  };
  std::string out = rewritten(text, control, xml_character);
  for (const std::string_view unknown : {"\xef\xbf\xbe", "\xef\xbf\xbf"})  // U+FFFE and U+FFFF
    for (auto at = out.find(unknown); at != std::string::npos; at = out.find(unknown, at))
      out.replace(at, unknown.size(), 1, '?');
  return out;
}

std::string csv_field(std::string_view text) {
  std::string out = one_line(text);
  for (std::size_t at = 0;
       at !=
       std::string::npos;) {  // a spreadsheet that splits at semicolons sees a field after each
    if (begins_formula(std::string_view(out).substr(at))) out.insert(at, 1, '\'');
    const auto next = out.find(';', at);
    at = next == std::string::npos ? next : next + 1;
  }
  if (out.find_first_of(",\";") == std::string::npos) return out;
  std::string quoted = "\"";
  for (const char c : out) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + "\"";
}

std::size_t whole_characters(std::string_view text) noexcept {
  for (std::size_t back = 1; back <= 3 && back <= text.size(); ++back) {
    const auto byte = static_cast<unsigned char>(text[text.size() - back]);
    const std::size_t wanted = byte >= 0xf0 ? 4 : byte >= 0xe0 ? 3 : byte >= 0xc0 ? 2 : 1;
    if ((byte & 0xc0) != 0x80) return wanted > back ? text.size() - back : text.size();
  }
  return text.size();
}

std::string terminal_text(std::string_view text) {
  return rewritten(
      text,
      [](char32_t c) { return c == '\n' || c == '\t' || c == '\r' ? static_cast<char>(c) : '?'; },
      [](char c) { return c; });
}

std::string terminal_json(std::string_view json) {
  return rewritten(
      json, [](char32_t c) { return c == '\n' ? std::string("\n") : json_escape(c); },
      [](char c) { return c; });
}

std::string plain_number(double v) { return fmt::format("{:.6g}", v); }

std::string fixed(double v, int digits) {
  const std::string text = fmt::format("{:.{}f}", v, digits);
  return text.find_first_not_of("-0.") == std::string::npos && text.front() == '-'
             ? text.substr(1)
             : text;  // no zero below zero
}

}  // namespace cavum
