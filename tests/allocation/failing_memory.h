// Memory that runs out at the n-th request, once: malloc, calloc, realloc and the aligned ones of
// this whole program, and so `new`, SQLite, libsodium and zstd.
#pragma once

#include <cstdint>

namespace cavum::testing_allocation {

/// Counts from now on; the request number `at` (from 1) is refused. 0: none is.
void begin_counting(std::uint64_t at) noexcept;
/// How many there were. Nothing is counted or refused afterwards.
std::uint64_t end_counting() noexcept;

}  // namespace cavum::testing_allocation
