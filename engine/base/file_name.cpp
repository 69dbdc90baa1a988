#include "engine/base/file_name.h"

#include <fmt/core.h>

#include "engine/base/hash.h"

namespace cavum {

std::string file_name_of(std::string_view text) {
  constexpr std::size_t k_longest = 120, k_mark = 9;
  constexpr std::string_view k_kept =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.";
  std::string name(text.substr(0, k_longest));
  for (char& c : name)
    if (k_kept.find(c) == std::string_view::npos) c = '_';
  if (name.empty()) name = "_";
  if (name.front() == '.' || name.front() == '-') name.front() = '_';
  if (name == text) return name;
  if (name.size() > k_longest - k_mark) name.resize(k_longest - k_mark);
  return fmt::format("{}-{}", name, to_hex(sha256(std::string(text))).substr(0, k_mark - 1));
}

}  // namespace cavum
