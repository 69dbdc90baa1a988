#include "engine/tooth/distance_transform.h"

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "tests/engine/tooth/tooth_testing.h"

namespace cavum {
namespace {

/// By asking every seed: the nearest, of equals the one with the lowest index, -1 beyond the
/// radius.
std::int32_t asked(IVec3 size, const std::vector<std::uint8_t>& seed, std::int32_t cell,
                   double radius) {
  const auto place = [&](std::int32_t i) {
    return IVec3{i % size.x, i / size.x % size.y, i / (size.x * size.y)};
  };
  std::int32_t best = -1, best_squared = 0;
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(seed.size()); ++i) {
    const IVec3 d = place(i) - place(cell);
    const std::int32_t squared = d.x * d.x + d.y * d.y + d.z * d.z;
    if (seed[static_cast<std::size_t>(i)] == 0 || squared > radius * radius ||
        (best >= 0 && squared >= best_squared))
      continue;
    best = i;
    best_squared = squared;
  }
  return best;
}

TEST(DistanceTransform, FindsTheSeedThatAskingAllOfThemFinds) {
  Random random(
      testing_tooth::drawn_seed("DistanceTransform.FindsTheSeedThatAskingAllOfThemFinds"));
  const auto edge = [&](std::uint64_t most) {
    return static_cast<std::int32_t>(1 + random.below(most));
  };
  for (int round = 0; round < 40; ++round) {
    const IVec3 size{edge(40), edge(12), round % 4 == 0 ? 1 : edge(12)};
    std::vector<std::uint8_t> seed(static_cast<std::size_t>(size.x * size.y * size.z));
    const auto rarity = 1 + random.below(round % 2 ? 12 : 200);
    for (auto& s : seed) s = random.below(rarity) == 0;
    const double radius = round % 3 ? 1e9 : random.uniform(0.5, 8);
    const auto nearest = nearest_seed(size, seed, radius);
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(seed.size()); ++i)
      ASSERT_EQ(nearest[static_cast<std::size_t>(i)], asked(size, seed, i, radius))
          << "round " << round << " cell " << i;
  }
}

TEST(DistanceTransform, WithoutASeedNothingIsNear) {
  for (const std::int32_t found : nearest_seed({5, 4, 3}, std::vector<std::uint8_t>(60)))
    EXPECT_EQ(found, -1);
}

TEST(DistanceTransform, AFarSeedIsFoundAlongEveryAxis) {
  for (const IVec3 size : {IVec3{16'384, 1, 1}, IVec3{1, 16'384, 1}, IVec3{1, 1, 16'384}}) {
    std::vector<std::uint8_t> seed(16'384);
    seed.back() = 1;
    EXPECT_EQ(nearest_seed(size, seed).front(), 16'383);
    EXPECT_EQ(nearest_seed(size, seed, 16'383.0).front(), 16'383);
    EXPECT_EQ(nearest_seed(size, seed, 16'382.0).front(), -1);
  }
}

}  // namespace
}  // namespace cavum
