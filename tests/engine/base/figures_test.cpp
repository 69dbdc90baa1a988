#include "engine/base/figures.h"

#include <gtest/gtest.h>

namespace cavum {
namespace {

TEST(Figures, AClockNamesTheSecondThatHasBegun) {
  EXPECT_EQ(clock_text(0.0), "0:00");
  EXPECT_EQ(clock_text(0.999), "0:00");
  EXPECT_EQ(clock_text(61.0), "1:01");
  EXPECT_EQ(clock_text(3599.5), "59:59");
  EXPECT_EQ(clock_text(-3.0), "0:00");
  for (int tick = 0; tick < 7'200'000; tick += 1000) {  // as ticks become seconds
    const std::string text = clock_text(tick * 0.001);
    const std::size_t colon = text.find(':');
    ASSERT_EQ(std::stoi(text.substr(0, colon)) * 60 + std::stoi(text.substr(colon + 1)),
              tick / 1000);
  }
}

}  // namespace
}  // namespace cavum
