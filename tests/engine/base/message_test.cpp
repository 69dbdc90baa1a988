// Messages: gaps are filled with values of every kind, in a language with other words, order,
// decimal sign and plural forms; errors are told apart by code.
#include "engine/base/message.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "engine/base/error.h"

namespace cavum {
namespace {

/// Turns words round, counts in threes, and writes a comma.
class Backwards final : public Locale {
 public:
  [[nodiscard]] std::string sentence(const char* english) const override {
    return std::string_view(english) == "{} of {}" ? "{1} <- {0}"
           : std::string_view(english) == "bad"    ? "{} {}"
                                                   : english;
  }
  [[nodiscard]] std::string sentence(const char* one, const char* many,
                                     std::int64_t count) const override {
    return count < 3 ? one : many;
  }
  [[nodiscard]] std::string term(const std::string& english) const override {
    return {english.rbegin(), english.rend()};
  }
  [[nodiscard]] std::string authored(const std::string& english) const override {
    return english + "!";
  }
  [[nodiscard]] std::string name(const std::string& text) const override {
    return "<" + text + ">";
  }
  [[nodiscard]] char decimal_sign() const noexcept override { return ','; }
};

TEST(Message, HoldsValuesUntilALanguageIsKnown) {
  if (std::getenv("CAVUM_ALTER_SENTENCES") != nullptr) GTEST_SKIP() << "asks for words";
  const Message m = msg("{} of {}", as_mm(0.3, 2, 0.05), Term{"floor"});
  EXPECT_EQ(english_text(m), "0.30 ± 0.05 mm of floor");
  EXPECT_EQ(render(m, Backwards()), "roolf <- 0,30 ± 0,05 mm");
  EXPECT_EQ(std::get<Number>(m.values().at(0)).value, 0.3);
}

TEST(Message, RendersEveryKindOfValue) {
  if (std::getenv("CAVUM_ALTER_SENTENCES") != nullptr) GTEST_SKIP() << "asks for words";
  const Backwards other;
  EXPECT_EQ(render(msg("{}", Vec3{1, -2, 0.5}), other), "[1,00; -2,00; 0,50] mm");
  EXPECT_EQ(english_text(msg("{}", Vec3{1, -2, 0.5})), "[1.00, -2.00, 0.50] mm");
  EXPECT_EQ(render(msg("{}, {}", 7, ClockTime{65.9}), other), "7, 1:05");
  EXPECT_EQ(render(msg("{}: {}", Authored{"Open"}, std::string("A.B")), other), "Open!: <A.B>");
  EXPECT_EQ(render(msg("{}", FileLocation{"a.toml", 3, 4}), other), "<a.toml:3:4>");
  EXPECT_EQ(english_text(msg("{}", list_of(std::vector<std::string>{"a", "b"}))), "a, b");
  EXPECT_EQ(render(msg("see {}", msg("{} of {}", 1, 2)), other), "see 2 <- 1");
  EXPECT_EQ(
      english_text(msg("{} {}", Number{.value = 0.5, .digits = 1, .sign = true}, as_deg(12.4))),
      "+0.5 12°");
  EXPECT_EQ(english_text(Message()), "");
}

TEST(Message, TakesTheFormThatTheLanguageCounts) {
  if (std::getenv("CAVUM_ALTER_SENTENCES") != nullptr) GTEST_SKIP() << "asks for words";
  EXPECT_EQ(english_text(msgn("{} step", "{} steps", 1, 1)), "1 step");
  EXPECT_EQ(english_text(msgn("{} step", "{} steps", 0, 0)), "0 steps");
  EXPECT_EQ(render(msgn("{} step", "{} steps", 2, 2), Backwards()), "2 step");
}

TEST(Message, FallsBackToEnglishWhenATranslationHasOtherGaps) {
  EXPECT_EQ(render(msg("bad"), Backwards()), "bad");
}

TEST(Message, IsEqualBySentenceAndValues) {
  EXPECT_EQ(msg("{} of {}", 1, 2), msg("{} of {}", 1, 2));
  EXPECT_NE(msg("{} of {}", 1, 2), msg("{} of {}", 2, 1));
  EXPECT_NE(msg("{} of {}", 1, 2), Message());
}

#define KETTLE(ERROR) ERROR(cold) ERROR(empty)
#define STOVE(ERROR) ERROR(cold)
CAVUM_NAMED_ENUM(Kettle, KETTLE)
CAVUM_NAMED_ENUM(Stove, STOVE)

TEST(Error, IsToldFromOthersByItsCode) {
  const Error e(Kettle::cold, FileLocation{"tea.toml", 2, 1}, msg("is cold"), msg("heat it"));
  EXPECT_EQ(e.code(), Kettle::cold);
  EXPECT_FALSE(e.code() == Kettle::empty);
  EXPECT_FALSE(e.code() == Stove::cold);
  EXPECT_EQ(*e.file_place(), (FileLocation{"tea.toml", 2, 1}));
  EXPECT_EQ(e.problem(), msg("is cold"));
  EXPECT_EQ(e.advice(), msg("heat it"));
  EXPECT_EQ(e.what(), english_text(e.message()));
}

}  // namespace
}  // namespace cavum
