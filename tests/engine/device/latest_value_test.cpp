// The latest value between two threads: never torn, never older than one seen before.
#include "engine/device/latest_value.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <thread>

#include "engine/device/period_meter.h"

namespace cavum {
namespace {

TEST(LatestValue, IsNeverTornAndNeverGoesBack) {
  struct Many {
    std::array<std::uint64_t, 12> words{};
  };
  LatestValue<Many> latest;
  constexpr std::uint64_t k_values = 300000;
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= k_values; ++i) {
      Many m;
      m.words.fill(i);
      latest.put(m);
    }
  });
  std::uint64_t last = 0, torn = 0, back = 0, seen = 0;
  while (last < k_values) {
    bool is_new = false;
    const Many& m = latest.take(is_new);
    for (const std::uint64_t w : m.words) torn += w != m.words[0] ? 1u : 0u;
    back += m.words[0] < last ? 1u : 0u;
    EXPECT_TRUE(!is_new || m.words[0] > last);
    seen += is_new ? 1u : 0u;
    last = m.words[0];
  }
  writer.join();
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(back, 0u);
  EXPECT_GT(seen, 0u);
}

TEST(LatestValue, StaysUntilThereIsANewOne) {
  LatestValue<int> latest;
  bool is_new = true;
  EXPECT_EQ(latest.take(is_new), 0);
  EXPECT_FALSE(is_new);
  latest.put(3);
  latest.put(4);
  EXPECT_EQ(latest.take(is_new), 4);
  EXPECT_TRUE(is_new);
  EXPECT_EQ(latest.take(is_new), 4);
  EXPECT_FALSE(is_new);
}

TEST(PeriodMeter, MeasuresPeriodsAndTheirScatter) {
  PeriodMeter meter;
  std::int64_t now = 5'000'000'000;
  for (const int ms : {0, 1, 3, 1, 3}) meter.add(now += ms * 1'000'000);  // periods 1 3 1 3
  EXPECT_EQ(meter.count(), 5);
  EXPECT_NEAR(meter.mean_s(), 2e-3, 1e-15);
  EXPECT_NEAR(meter.scatter_s(), 1e-3, 1e-15);
  EXPECT_NEAR(meter.longest_s(), 3e-3, 1e-15);
  meter.pause();
  meter.add(now + 1'000'000'000);
  EXPECT_NEAR(meter.longest_s(), 3e-3, 1e-15) << "a pause is no period";
}

}  // namespace
}  // namespace cavum
