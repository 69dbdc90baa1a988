#include "scenarios/file/condition.h"

#include <gtest/gtest.h>

namespace cavum::scenarios {
namespace {

TEST(Condition, IsToldFromANumber) {
  for (const char* text : {"a > 1", "(a + b) * 2 <= 3 && c == 0", "((a > 1))", "contact", "1",
                           "a > 1 ? contact : b < 2", "(a > 1) || (b > 2)", "perforated && a>=1"})
    EXPECT_TRUE(is_condition(text)) << text;
  for (const char* text :
       {"a", "a + 1", "(a)", "a > 1 && b", "max(a, b)", "2", "a > 1 ? 3 : 4", "contact + cutting"})
    EXPECT_FALSE(is_condition(text)) << text;
}

TEST(Condition, IsJudgedByTheRangesOfItsQuantities) {
  const std::map<std::string, ValueRange> ranges{
      {"percent", {0, 100}}, {"pedal", {0, 1}}, {"none", {0, 0}}};
  const auto outlook = [&](const char* text) { return judge_condition(text, ranges); };
  for (const char* text :
       {"percent > 100", "101 <= percent", "percent >= 50 && pedal > 1", "none > 0",
        "(percent > 100) || (none != 0)", "none", "0", "percent < 0"})
    EXPECT_EQ(outlook(text), Outlook::never) << text;
  for (const char* text :
       {"percent >= 0", "pedal <= 1 || unknown > 3", "1", "none == 0 && percent <= 100"})
    EXPECT_EQ(outlook(text), Outlook::always) << text;
  for (const char* text : {"percent >= 100", "unknown > 1", "percent > 100 || unknown > 1",
                           "percent / 2 > 60", "max(percent, 1) > 200", "percent > 100 ? 1 : 0"})
    EXPECT_EQ(outlook(text), Outlook::perhaps) << text;
}

TEST(Condition, ChainsCommasAndDivisionsByZeroAreFaults) {
  using Kind = ConditionFault::Kind;
  const auto fault = [](const char* text) {
    const auto found = condition_fault(text);
    return found ? std::optional(found->kind) : std::nullopt;
  };
  for (const char* text : {"0 < depth_mm < 10", "a > 1 && (0 <= b <= c)", "a == b == c",
                           "min(a < b < c, 1) > 0", "a<b!=c"})
    EXPECT_EQ(fault(text), Kind::chain) << text;
  for (const char* text : {"a > 1, b > 2", "(a, b) > 1", "a > 0,5", "max(a, (b, c)) > 1"})
    EXPECT_EQ(fault(text), Kind::comma) << text;
  for (const char* text :
       {"a / 0 > 1", "a/-0.0 > 1", "a / (1 - 1) > 2", "a > 1 && b / max(0, 0) < 3"})
    EXPECT_EQ(fault(text), Kind::zero) << text;
  for (const char* text : {"a / b > 1", "a / (b * 2) > 1", "1/abs(b) > 1"})
    EXPECT_EQ(fault(text), Kind::zero_at_first) << text;
  for (const char* text : {"a > 1 && b < 2 || c == 3", "a > 1 ? b < 2 : c >= 3",
                           "min(a, b) > max(c, 1) && d < 1", "a / max(b, 1) > 2", "a / 2 / 3 < 1",
                           "(a > 1) && (b < 2)", "a / (b + 1) > 1", "abs(a - b) < 0.5"})
    EXPECT_FALSE(fault(text)) << text;
}

}  // namespace
}  // namespace cavum::scenarios
