#include "engine/physics/servo/scheduling.h"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <time.h>

#include <cerrno>
#include <cstring>

namespace cavum {
namespace {

constexpr std::int64_t k_second_ns = 1'000'000'000;

}  // namespace

std::string ask_for_fifo(int priority) {
  sched_param parameter{};
  parameter.sched_priority = priority;
  const int refused = ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameter);
  return refused == 0 ? "" : std::strerror(refused);
}

std::string ask_for_memory() { return ::mlockall(MCL_CURRENT) == 0 ? "" : std::strerror(errno); }

void give_memory_back() noexcept { ::munlockall(); }

void ask_for_sharp_timers() noexcept { ::prctl(PR_SET_TIMERSLACK, 1000UL); }

std::int64_t monotonic_ns() noexcept {
  timespec t{};
  ::clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<std::int64_t>(t.tv_sec) * k_second_ns + t.tv_nsec;
}

void sleep_until(std::int64_t at_ns) noexcept {
  const timespec t{static_cast<time_t>(at_ns / k_second_ns), static_cast<long>(at_ns % k_second_ns)};
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
  }
}

}  // namespace cavum
