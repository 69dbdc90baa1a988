#include "engine/base/figures.h"

#include <fmt/core.h>

#include <cctype>
#include <cmath>
#include <utility>

namespace cavum {

std::string clock_text(double seconds) {
  const auto whole = static_cast<long long>(std::fmax(0.0, seconds));
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

std::string with_unit_signs(std::string text) {
  const auto in_word = [&text](std::size_t at) {
    return at < text.size() && (std::isalnum(static_cast<unsigned char>(text[at])) != 0 || text[at] == '_');
  };
  for (const auto& [plain, sign] : {std::pair{"mm2", "mm²"}, std::pair{"mm3", "mm³"}})
    for (std::size_t at = text.find(plain); at != std::string::npos; at = text.find(plain, at + 3))
      if ((at == 0 || !in_word(at - 1)) && !in_word(at + 3)) text.replace(at, 3, sign);
  return text;
}

}  // namespace cavum
