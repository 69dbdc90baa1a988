#include "engine/base/figures.h"

#include <fmt/core.h>

#include <cmath>

namespace cavum {

std::string clock_text(double seconds) {
  const auto whole = static_cast<long long>(std::fmax(0.0, seconds));
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

}  // namespace cavum
