// Sessions of hands, counted.
#pragma once

#include <span>
#include <string>

#include "tests/hands/examine.h"

namespace cavum::hands {

struct Counts {
  int sessions = 0, untouched = 0, opened = 0, felt = 0, felt_seen = 0, seen = 0, alarmed = 0;
  std::vector<double> delays_ms;
  void add(const Examined& e);
};
[[nodiscard]] std::string table(std::span<const Examined> all);
[[nodiscard]] std::string log_head();
[[nodiscard]] std::string log_line(const Examined& e);

}  // namespace cavum::hands
