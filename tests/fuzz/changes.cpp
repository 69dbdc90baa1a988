#include "tests/fuzz/changes.h"

#include <algorithm>
#include <array>

namespace cavum::fuzz {

Bytes changed(Bytes input, const Bytes& other, std::mt19937_64& draw) {
  Bytes& b = input;
  const auto below = [&draw](std::size_t n) {
    return n == 0 ? 0 : static_cast<std::size_t>(draw() % n);
  };
  for (std::size_t n = 1 + below(4); n > 0; --n) {
    const auto at = static_cast<std::ptrdiff_t>(below(b.size() + 1));
    switch (b.empty() ? 3 : below(6)) {
      case 0:
        b[below(b.size())] ^= static_cast<std::uint8_t>(1U << below(8));
        break;
      case 1:
        b[below(b.size())] = std::array<std::uint8_t, 6>{0, 1, 127, 128, 255, '9'}[below(6)];
        break;
      case 2:
        b.erase(b.begin() + at,
                b.begin() + std::min<std::ptrdiff_t>(at + static_cast<std::ptrdiff_t>(1 + below(8)),
                                                     std::ssize(b)));
        break;
      case 3: {
        if (other.empty()) break;
        const std::size_t from = below(other.size()),
                          length = 1 + below(std::min<std::size_t>(64, other.size() - from));
        b.insert(b.begin() + at, other.begin() + static_cast<std::ptrdiff_t>(from),
                 other.begin() + static_cast<std::ptrdiff_t>(from + length));
        break;
      }
      case 4:
        b.resize(static_cast<std::size_t>(at));
        break;
      default:
        std::swap(b[below(b.size())], b[below(b.size())]);
    }
  }
  return input;
}

}  // namespace cavum::fuzz
