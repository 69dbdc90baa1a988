// A class list in any encoding and separator: what it holds arrives, and what nobody asked about is
// asked.
#include "ui/office/roster.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/engine/support/basics.h"

namespace cavum::office {
namespace {

using testing_basics::tells;

std::string problem_of(const Roster& roster) {
  std::string lines;
  for (const Message& m : roster.problems) lines += (lines.empty() ? "" : "\n") + english_text(m);
  return lines;
}

std::string utf16(const std::u16string& text, bool big_endian) {
  std::string out = big_endian ? "\xfe\xff" : "\xff\xfe";
  for (const char16_t c : text) {
    const char high = static_cast<char>(c >> 8), low = static_cast<char>(c);
    out += big_endian ? high : low;
    out += big_endian ? low : high;
  }
  return out;
}

TEST(Roster, ReadsTheSameInEveryEncodingAndWithEverySeparator) {
  const std::string utf8 = "id,name\n1,M\u00fcller \u2013 \u20ac\n";
  const std::pair<std::string, std::string> encoded[] = {
      {utf8, "UTF-8"},
      {"\xef\xbb\xbf" + utf8, "UTF-8"},
      {utf16(u"id,name\n1,M\u00fcller \u2013 \u20ac\n", false), "UTF-16"},
      {utf16(u"id,name\n1,M\u00fcller \u2013 \u20ac\n", true), "UTF-16"},
      {"id,name\n1,M\xfcller \x96 \x80\n", "Windows-1252"}};
  for (const auto& [bytes, name] : encoded) {
    const Roster r = read_roster(bytes, {});
    EXPECT_EQ(r.encoding, name);
    ASSERT_EQ(r.people.size(), 1u) << name << ": " << problem_of(r);
    EXPECT_EQ(r.people[0].name, "M\u00fcller \u2013 \u20ac");
  }
  for (const char separator : {',', ';', '\t', '|'}) {
    std::string text = "id,name,extra_time_percent\r\n4711,B,25\r\n";
    std::replace(text.begin(), text.end(), ',', separator);
    const Roster r = read_roster(text, {});
    EXPECT_EQ(r.separator, separator);
    ASSERT_TRUE(r.ready()) << problem_of(r);
    EXPECT_EQ(r.people[0].grant.extra_time_percent, 25.0);
  }
}

TEST(Roster, AsksAboutEachColumnThatItDoesNotKnow) {
  const std::string text = "Matrikel;Name;Mehr Zeit;Platz\n1;A;25;3\n2;B;;4\n";
  const Roster asked = read_roster(text, {});
  EXPECT_FALSE(asked.ready());
  EXPECT_EQ(problem_of(asked), "");
  ASSERT_EQ(asked.columns.size(), 4u);
  EXPECT_EQ(asked.columns[1].use, "name") << "whatever its capitals";
  for (const int c : {0, 2, 3}) EXPECT_EQ(asked.columns[static_cast<std::size_t>(c)].use, "");
  EXPECT_EQ(asked.columns[3].samples, (std::vector<std::string>{"3", "4"}));
  EXPECT_EQ(asked.columns[2].samples, (std::vector<std::string>{"25"}))
      << "of who has none nothing is shown";
  EXPECT_FALSE(read_roster(text, {"id", "", "extra_time_percent", ""}).ready()) << "one waits";
  const Roster answered = read_roster(text, {"id", "", "extra_time_percent", k_pass_over});
  ASSERT_TRUE(answered.ready()) << problem_of(answered);
  EXPECT_EQ(answered.people[0].grant.extra_time_percent, 25.0);
  EXPECT_EQ(answered.people[1].grant.extra_time_percent, std::nullopt);
  EXPECT_FALSE(read_roster(text, {"something", "", "extra_time_percent", k_pass_over}).ready())
      << "no such use";
}

TEST(Roster, TakesTheSeparatorThatASpreadsheetNames) {
  for (const char separator : {';', ',', '\t', '|', ':'}) {
    std::string text = "sep=;\r\nid;name;extra_time_percent\r\n4711;B;25 %\r\n";
    std::replace(text.begin(), text.end(), ';', separator);
    const Roster r = read_roster(text, {});
    ASSERT_TRUE(r.ready()) << problem_of(r);
    EXPECT_EQ(r.separator, separator);
    EXPECT_EQ(r.rows, 1u);
    EXPECT_EQ(r.people[0].grant.extra_time_percent, 25.0);
  }
}

TEST(Roster, TellsAllMistakesEachOnALine) {
  const Roster r = read_roster("id;name\n1\n2;B;C\n3;C\n3;D\n", {});
  EXPECT_FALSE(r.ready());
  EXPECT_EQ(std::ranges::count(problem_of(r), '\n'), 2) << problem_of(r);
  /// Of each line its mistake: the place, and how many fields it has.
  const auto expect_told = [](const Roster& roster,
                              const std::vector<std::pair<std::string, Value>>& wanted) {
    ASSERT_EQ(roster.problems.size(), wanted.size()) << problem_of(roster);
    for (std::size_t i = 0; i < wanted.size(); ++i)
      EXPECT_TRUE(tells(roster.problems[i], wanted[i].first) &&
                  tells(roster.problems[i], wanted[i].second))
          << roster.problems[i];
  };
  const auto fields = [](std::int64_t n) { return Value(n); };
  expect_told(
      r, {{"the list:2", fields(1)}, {"the list:3", fields(3)}, {"the list:5", Value(Name{"3"})}});
  const Roster asked = read_roster("id;Place\n1\n2;B\n3;C;D\n", {});
  EXPECT_EQ(asked.columns.size(), 2u);
  EXPECT_EQ(asked.columns[1].samples, (std::vector<std::string>{"B", "C"}));
  expect_told(asked,
              {{"the list:2", fields(1)}, {"the list:4", fields(3)}});  // also while a column waits
}

TEST(Roster, SaysWhatIsWrong) {
  const std::pair<std::string, std::string> wrong[] = {{"", ""},
                                                       {"id\n", "the list"},
                                                       {"id\n1\n1\n", "the list:3"},
                                                       {"id,extra_time_percent\n1,much\n", "much"},
                                                       {"id,extra_time_percent\n1,9000\n", "9000"},
                                                       {"id,name\n1\n", "the list:2"},
                                                       {"name\nA\n", "the list:1"}};
  for (const auto& [text, told] : wrong) {
    const Roster r = read_roster(text, {});
    EXPECT_FALSE(r.ready()) << text;
    ASSERT_EQ(r.problems.size(), 1u) << text;
    EXPECT_NE(problem_of(r).find(told), std::string::npos) << text << ": " << problem_of(r);
  }
  EXPECT_TRUE(tells(read_roster("id,Number\n1,2\n", {"id", "id"}).problems, "id"));
}

TEST(Roster, JoinsSurnameAndFirstName) {
  const std::string text = "id;Nachname;Name;Vorname\n1;Weber;;Ada\n2;Stein;zu;\n3;;;Eva\n";
  const Roster joined = read_roster(text, {"id", "name", "name", "name"});
  ASSERT_EQ(joined.people.size(), 3u) << problem_of(joined);
  EXPECT_EQ(joined.people[0].name, "Weber, Ada");
  EXPECT_EQ(joined.people[1].name, "Stein, zu");
  EXPECT_EQ(joined.people[2].name, "Eva");
  EXPECT_EQ(joined.columns[3].use, "name") << "as it was answered";
  EXPECT_TRUE(tells(read_roster("id;Nachname;Vorname\n1;Weber\n", {"id", "name", "name"}).problems,
                    Value(std::int64_t{3})));
}

TEST(Roster, SaysWhetherAKnownNameStandsInTheFirstLine) {
  EXPECT_TRUE(read_roster("Matrikel;NAME\n1;A\n", {}).headed);
  EXPECT_FALSE(read_roster("4711;Ada\n4712;Bert\n", {}).headed)
      << "the first candidate would be lost";
  EXPECT_FALSE(read_roster("4711;Ada\n4712;Bert\n", {"id", "name"}).headed)
      << "whatever was answered";
}

TEST(Roster, TakesGermanYesAndNoAndACross) {
  const Roster r = read_roster("id;left_handed\n1;JA\n2;Nein\n3;X\n4;x\n5;yes\n6;\n", {});
  ASSERT_EQ(r.people.size(), 6u) << problem_of(r);
  const std::optional<bool> wanted[] = {true, false, true, true, true, std::nullopt};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(r.people[i].grant.left_handed, wanted[i]) << i;
}

}  // namespace
}  // namespace cavum::office
