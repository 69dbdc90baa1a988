#include "engine/base/order.h"

#include <gtest/gtest.h>

#include "engine/base/random.h"

namespace cavum {
namespace {

TEST(Order, EachPlaceHoldsWhatSortingPutsThere) {
  Random random(3);
  for (std::size_t n = 1; n < 40; ++n) {
    std::vector<double> values(n);
    for (double& v : values) v = static_cast<double>(random.below(12));
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t place = 0; place < n; ++place)
      EXPECT_EQ(in_order(values, place), sorted[place]);
    for (const double share : {0.0, 0.05, 0.5, 0.95, 1.0})
      EXPECT_EQ(quantile(values, share), quantile_of_sorted(sorted, share));
  }
}

TEST(Order, TheMedianIsOneOfTheValuesTheUpperOfTwo) {
  EXPECT_EQ(median(std::vector<int>{9, 1, 5}), 5);
  EXPECT_EQ(median(std::vector<int>{4, 1, 3, 2}), 3);
  EXPECT_EQ(median(std::vector<int>{7}), 7);
}

TEST(Order, QuantilesReachFromTheLeastToTheLargest) {
  const std::vector<double> values = {50, 10, 40, 20, 30};
  EXPECT_EQ(quantile(values, 0.0), 10);
  EXPECT_EQ(quantile(values, 0.5), 30);
  EXPECT_EQ(quantile(values, 0.74), 30) << "rounded down";
  EXPECT_EQ(quantile(values, 0.75), 40);
  EXPECT_EQ(quantile(values, 1.0), 50);
}

}  // namespace
}  // namespace cavum
