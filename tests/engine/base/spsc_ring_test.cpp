#include "engine/base/spsc_ring.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <thread>

#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

TEST(SpscRing, GivesBackInOrderAndRefusesWhatDoesNotFit) {
  SpscRing<int> ring(5);
  EXPECT_EQ(ring.capacity(), 8u);
  const std::vector<int> six{1, 2, 3, 4, 5, 6};
  EXPECT_TRUE(ring.push(six));
  EXPECT_FALSE(ring.push(std::span(six).first(3)));
  EXPECT_EQ(ring.room(), 2u) << "a refused push leaves nothing behind";
  std::vector<int> out(4);
  EXPECT_TRUE(ring.pop(std::span(out)));
  EXPECT_EQ(out, (std::vector<int>{1, 2, 3, 4}));
  EXPECT_FALSE(ring.pop(std::span(out)));
  EXPECT_EQ(ring.ready(), 2u);
  EXPECT_TRUE(ring.push(std::span(six).first(6))) << "around the end of the buffer";
  out.resize(8);
  EXPECT_TRUE(ring.pop(std::span(out)));
  EXPECT_EQ(out, (std::vector<int>{5, 6, 1, 2, 3, 4, 5, 6}));
  int one = 0;
  EXPECT_FALSE(ring.pop(one));
}

TEST(SpscRing, BetweenTwoThreadsNothingIsLostDoubledOrTorn) {
  struct Pair {
    std::uint64_t a = 0, b = 0;
  };
  SpscRing<Pair> ring(256);
  constexpr std::uint64_t k_items = 300000;
  std::thread producer([&] {
    Random random(1);
    std::vector<Pair> some;
    for (std::uint64_t next = 0; next < k_items;) {
      some.clear();
      for (std::uint64_t n = 1 + random.below(40); n > 0 && next + some.size() < k_items; --n)
        some.push_back({next + some.size(), ~(next + some.size())});
      if (ring.push(some))
        next += some.size();
      else
        std::this_thread::yield();
    }
  });
  Pair p;
  std::uint64_t expected = 0, wrong = 0;
  while (expected < k_items) {
    if (!ring.pop(p)) {
      std::this_thread::yield();
      continue;
    }
    wrong += p.a != expected || p.b != ~expected;
    ++expected;
  }
  producer.join();
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(ring.ready(), 0u);
}

}  // namespace
}  // namespace cavum
