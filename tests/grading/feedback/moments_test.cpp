// The moments that `grade --why` lists: the largest of them in order of time, none lost when many
// are alike.
#include "grading/feedback/moments.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/grading/carved.h"

namespace cavum::grading {
namespace {

std::vector<WhyItem> items_of(const std::vector<double>& amounts) {
  std::vector<WhyItem> items;
  for (std::size_t i = 0; i < amounts.size(); ++i) {
    items.emplace_back();
    items.back().tick = static_cast<std::int64_t>(i);
    items.back().amount = amounts[i];
  }
  return items;
}

TEST(Moments, TheLargestAreKeptInTheirOrder) {
  std::vector<double> amounts;
  for (int i = 0; i < 50; ++i)
    amounts.push_back(i % 7 == 0 ? 100 + i : 50 - i);  // 8 large ones, then the early ones
  auto items = items_of(amounts);
  EXPECT_EQ(keep_largest(items).size(), 50 - k_max_moments);
  ASSERT_EQ(items.size(), k_max_moments);
  std::vector<double> sorted = amounts, kept;
  std::sort(sorted.rbegin(), sorted.rend());
  std::int64_t last = -1;
  for (std::size_t i = 0; i < items.size(); ++i) {
    kept.push_back(*items[i].amount);
    EXPECT_GT(items[i].tick, last);
    last = items[i].tick;
  }
  std::sort(kept.rbegin(), kept.rend());
  for (std::size_t i = 0; i < kept.size(); ++i) EXPECT_EQ(kept[i], sorted[i]);
}

TEST(Moments, OfEqualOnesTheEarlierStay) {
  auto items = items_of(std::vector<double>(k_max_moments + 15, 0.25));
  EXPECT_EQ(keep_largest(items).size(), 15u);
  ASSERT_EQ(items.size(), k_max_moments);
  EXPECT_EQ(items.back().tick, static_cast<std::int64_t>(k_max_moments) - 1);
}

TEST(Moments, AFewAreLeftAlone) {
  auto items = items_of({3, 1, 2});
  EXPECT_TRUE(keep_largest(items).empty());
  EXPECT_EQ(items.size(), 3u);
}

TEST(Moments, LeavesLessThanAGapApartAreOneMomentWithAllTheirVolume) {
  testing::Carved c(testing::scenario_text(
                        "[[zones.target]]\nshape = \"ball\"\nat_mm = [0, 0, 0]\nradius_mm = 1\n"),
                    testing::dentin_block(2, 2, 0.1));
  c.carve([](Vec3 p) { return length(p - Vec3{-0.8, 0, 0}) - 0.3; }, 10);
  c.carve([](Vec3 p) { return length(p - Vec3{0.8, 0, 0}) - 0.3; }, 10 + k_moment_gap_ticks);
  const std::size_t first_two = c.removed.size();
  c.carve([](Vec3 p) { return length(p - Vec3{0, 1.5, -0.5}) - 0.4; }, 11 + 2 * k_moment_gap_ticks);
  c.carve([](Vec3 p) { return length(p - Vec3{0, -1.5, -0.5}) - 0.4; }, 5000);  // after the end
  const std::size_t before_end = static_cast<std::size_t>(std::count_if(
      c.removed.begin(), c.removed.end(), [](const RemovedAt& r) { return r.tick < 5000; }));
  const auto moments = removal_moments(c.input(), 5000, [](const RemovedAt&) { return true; });
  ASSERT_EQ(moments.size(), 2u);
  EXPECT_EQ(moments[0].tick, 10);
  EXPECT_EQ(moments[0].end_tick, 10 + k_moment_gap_ticks);
  EXPECT_NEAR(*moments[0].amount, static_cast<double>(first_two) * 0.001, 1e-9);
  EXPECT_NEAR(*moments[1].amount, static_cast<double>(before_end - first_two) * 0.001, 1e-9);
  EXPECT_GT((*moments[1].site_mm).y, 1.5);  // furthest from the target
}

}  // namespace
}  // namespace cavum::grading
