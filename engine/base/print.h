// Printing for the rigs' tables: printf into a string, and text broken into lines.
#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace cavum {

template <class... Args>
[[nodiscard]] std::string printed(const char* format, Args... args) {
  char text[600];
  std::snprintf(text, sizeof text, format, args...);
  return text;
}

/// Words of `text` in lines of at most `width` bytes, each ended.
[[nodiscard]] inline std::string wrapped(const std::string& text, std::size_t width = 110) {
  std::string out, line;
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    if (!line.empty() && line.size() + 1 + word.size() > width) {
      out += line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
    at = end + 1;
  }
  return line.empty() ? out : fmt::format("{}{}\n", out, line);
}

}  // namespace cavum
