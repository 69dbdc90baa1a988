#include "engine/physics/servo/lateness.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

TEST(Lateness, EveryTickIsInTheBinWhoseEdgesHoldIt) {
  Random random(drawn_seed("Lateness.EveryTickIsInTheBinWhoseEdgesHoldIt"));
  for (int i = 0; i < 3000; ++i) {
    Lateness l;
    const auto ns = static_cast<std::int64_t>(random.below(10) == 0 ? random.below(400'000'000)
                                                                    : random.below(2'000'000));
    l.add(ns);
    const auto bin =
        static_cast<std::size_t>(std::find(l.counts.begin(), l.counts.end(), 1) - l.counts.begin());
    ASSERT_LT(bin, l.counts.size());
    if (bin < Lateness::k_edges_us.size()) {
      ASSERT_LE(ns, Lateness::k_edges_us[bin] * 1000);
    }
    if (bin > 0) {
      ASSERT_GT(ns, Lateness::k_edges_us[bin - 1] * 1000);
    }
  }
}

TEST(Lateness, CountsMeanWorstAndQuantiles) {
  Lateness l;
  for (std::int64_t i = 1; i <= 1000; ++i) l.add(i * 1000);  // 1 to 1000 µs
  l.add(-5);                                                 // early is on time
  EXPECT_EQ(l.ticks, 1001);
  EXPECT_EQ(std::accumulate(l.counts.begin(), l.counts.end(), std::int64_t{0}), 1001);
  EXPECT_NEAR(l.mean_us(), 500.0, 1.0);
  EXPECT_EQ(l.worst_us(), 1000.0);
  EXPECT_EQ(l.quantile_us(0.12), 200.0) << "the upper edge of the bin that holds 120 µs";
  EXPECT_EQ(l.quantile_us(0.05), 50.0);
  EXPECT_EQ(l.quantile_us(1.0), 1000.0);
  EXPECT_EQ(Lateness{}.quantile_us(0.99), 0.0);
}

}  // namespace
}  // namespace cavum
