// What a thread asks of Linux to be on time. Each request may be refused, and the refusal is told,
// never hidden.
#pragma once

#include <cstdint>

namespace cavum {

/// What the system said to a request.
struct SystemGrant {
  bool asked = false;
  std::int32_t error = 0;  ///< errno where it refused
  [[nodiscard]] bool granted() const noexcept { return asked && error == 0; }
};
/// SCHED_FIFO for the calling thread.
[[nodiscard]] SystemGrant ask_for_fifo(int priority) noexcept;
/// Brings all pages of the process into memory, those reserved and never touched too, and keeps
/// them there: a page that came in during a tick would wait for whoever else is changing the
/// process's memory.
[[nodiscard]] SystemGrant ask_for_memory() noexcept;
void give_memory_back() noexcept;
/// Wake-ups of the calling thread may be off by 1 µs instead of 50, where it has no SCHED_FIFO.
void ask_for_sharp_timers() noexcept;

/// CLOCK_MONOTONIC, ns.
[[nodiscard]] std::int64_t monotonic_ns() noexcept;
/// Sleeps until `at_ns` on that clock; returns at once when it has passed.
void sleep_until(std::int64_t at_ns) noexcept;

}  // namespace cavum
