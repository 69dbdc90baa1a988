// An exchange with the Inverse3's service each millisecond, for as long as it is asked: against the
// clock, so it runs alone.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "engine/physics/servo/scheduling.h"
#include "tests/device/inverse3_hands.h"

namespace cavum {
namespace {

using testing_device::comes_true;
using testing_device::EmulatedInverse3;
using testing_device::own_frame;
using testing_device::Servo;

/// What the computer gives at most beside all that it has to do: a thread with the same timetable,
/// and one that answers it at once.
std::int64_t exchanges_of_one_byte(int seconds) {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) return -1;
  std::thread other([end = ends[1]] {
    static_cast<void>(ask_for_fifo(69));
    for (char c = 0; ::read(end, &c, 1) == 1 && ::write(end, &c, 1) == 1;) {
    }
  });
  std::int64_t count = 0;
  std::thread one([&] {
    static_cast<void>(ask_for_fifo(69));
    ask_for_sharp_timers();
    constexpr std::int64_t k_period_ns = 1'000'000;
    const std::int64_t until = monotonic_ns() + seconds * 1'000'000'000LL;
    for (std::int64_t due = monotonic_ns(); monotonic_ns() < until; ++count) {
      due = std::max(due + k_period_ns, monotonic_ns() - k_period_ns);
      char c = 'x';
      if (::write(ends[0], &c, 1) != 1 || ::read(ends[0], &c, 1) != 1) break;
      sleep_until(due);
    }
  });
  one.join();
  ::close(ends[0]);
  other.join();
  ::close(ends[1]);
  return count;
}

TEST(Inverse3Rate, AThousandExchangesASecondAreKept) {
  EmulatedInverse3 service;
  const int seconds = std::getenv("CAVUM_DEEP") != nullptr ? 60 : 4;
  Inverse3Stylus stylus(own_frame(service));
  const Servo servo(stylus, {0, 0, 0.1});
  ASSERT_TRUE(comes_true([&] { return service.force_n().z > 0; }));
  const std::int64_t before = service.told().count, from = monotonic_ns();
  const std::int64_t possible = exchanges_of_one_byte(seconds),
                     kept = service.told().count - before;
  const double took_s = static_cast<double>(monotonic_ns() - from) * 1e-9;
  const StylusHealth h = stylus.health();
  std::printf("%d s: %lld exchanges of %lld possible; scatter %.3f ms, longest gap %.1f ms\n",
              seconds, static_cast<long long>(kept), static_cast<long long>(possible),
              1e3 * h.jitter_s, 1e3 * h.longest_gap_s);
  EXPECT_GT(static_cast<double>(kept), 0.9 * static_cast<double>(possible));
  EXPECT_LE(static_cast<double>(kept), 1000.0 * took_s + 10.0) << "never faster than the servo";
  EXPECT_EQ(h.unplugged, 0);
}

}  // namespace
}  // namespace cavum
