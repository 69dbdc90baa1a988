#include "engine/base/text.h"

#include <cstdio>

namespace cavum {
namespace {

/// Bytes of the UTF-8 character that `text` (not empty) begins with; 0 when it begins with none.
std::size_t utf8_length(std::string_view text) noexcept {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t n = first >= 0xc2 && first <= 0xdf ? 2 : first >= 0xe0 && first <= 0xef ? 3 : first >= 0xf0 && first <= 0xf4 ? 4 : 0;
  if (n == 0 || text.size() < n) return 0;
  // longer than needed, half of a pair of UTF-16, or beyond the last character
  const unsigned low = first == 0xe0 ? 0xa0 : first == 0xf0 ? 0x90 : 0x80, high = first == 0xed ? 0x9f : first == 0xf4 ? 0x8f : 0xbf;
  if (byte(1) < low || byte(1) > high) return 0;
  for (std::size_t i = 2; i < n; ++i)
    if ((byte(i) & 0xc0) != 0x80) return 0;
  return n;
}

bool is_control(char c) noexcept { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

/// Copies `text` character by character; `control` writes what stands for a control character, `plain` for another of one byte.
template <class Control, class Plain>
std::string rewritten(std::string_view text, const Control& control, const Plain& plain) {
  std::string out;
  while (!text.empty()) {
    const std::size_t n = utf8_length(text);
    if (n == 0)
      out += '?';
    else if (n > 1)
      out += text.substr(0, n);
    else
      out += is_control(text.front()) ? control(text.front()) : plain(text.front());
    text.remove_prefix(n == 0 ? 1 : n);
  }
  return out;
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
    if (n == 0 || is_control(text.front())) return false;
    text.remove_prefix(n);
  }
  return true;
}

std::string one_line(std::string_view text) {
  return rewritten(
      text, [](char) { return ' '; }, [](char c) { return c; });
}

std::string xml_text(std::string_view text) {
  const auto control = [](char c) -> std::string { return c == '\n' ? "&#10;" : c == '\r' ? "&#13;" : c == '\t' ? "&#9;" : "?"; };
  return rewritten(text, control, xml_character);
}

std::string plain_number(double v) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.6g", v);
  return buffer;
}

std::string fixed(double v, int digits) {
  char buffer[400];  // the largest number has 309 digits before the point
  std::snprintf(buffer, sizeof buffer, "%.*f", digits, v);
  const std::string_view text = buffer;
  return std::string(text.find_first_not_of("-0.") == std::string_view::npos && text.front() == '-' ? text.substr(1) : text);  // no zero below zero
}

}  // namespace cavum
