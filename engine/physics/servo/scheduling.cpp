#include "engine/physics/servo/scheduling.h"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <time.h>

#include <cerrno>

namespace cavum {
namespace {

constexpr std::int64_t k_second_ns = 1'000'000'000;

}  // namespace

SystemGrant ask_for_fifo(int priority) noexcept {
  sched_param parameter{};
  parameter.sched_priority = priority;
  return {true, ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameter)};
}

SystemGrant ask_for_memory() noexcept { return {true, ::mlockall(MCL_CURRENT) == 0 ? 0 : errno}; }

void give_memory_back() noexcept { ::munlockall(); }

void ask_for_sharp_timers() noexcept { ::prctl(PR_SET_TIMERSLACK, 1000UL); }

std::int64_t monotonic_ns() noexcept {
  timespec t{};
  ::clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<std::int64_t>(t.tv_sec) * k_second_ns + t.tv_nsec;
}

void sleep_until(std::int64_t at_ns) noexcept {
  const timespec t{static_cast<time_t>(at_ns / k_second_ns),
                   static_cast<long>(at_ns % k_second_ns)};
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
  }
}

}  // namespace cavum
