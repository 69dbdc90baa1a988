// Printing for tables in files: printf into a string.
#pragma once

#include <cstdio>
#include <string>

namespace cavum {

template <class... Args>
[[nodiscard]] std::string printed(const char* format, Args... args) {
  char text[600];
  std::snprintf(text, sizeof text, format, args...);
  return text;
}

}  // namespace cavum
