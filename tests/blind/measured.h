// What the last long run counted, so that a sample fails when things get worse, and says which promises of issue 5 are not kept yet.
// Rates in the order of `rates()`; replace them after every long run (`./dev blind`), never by wish.
#pragma once

#include <array>

namespace cavum::blind {

struct Counted {
  int successes = 0, trials = 0;
};

inline constexpr const char* k_measured_by = "not measured yet";
inline constexpr std::array<Counted, 16> k_measured{};

}  // namespace cavum::blind
