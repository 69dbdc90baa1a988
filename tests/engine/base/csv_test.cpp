#include "engine/base/csv.h"

#include <gtest/gtest.h>

#include "engine/base/file_error.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

using Fields = std::vector<std::string>;
using namespace testing_basics;

constexpr CsvForm k_any_text{.plain_text = false};

std::optional<Error> error_in(const std::string& text, const CsvForm& form = {}) {
  return thrown_by([&] { static_cast<void>(parse_csv(text, "c.csv", form)); });
}

TEST(Csv, Utf16IsRefusedByName) {
  using namespace std::string_literals;
  for (const std::string& text : {"\xff\xfe" + "a\0,\0"s, "\xfe\xff" + "\0a\0,"s})
    EXPECT_EQ(code_of(error_in(text)), FileError::unsupported);
}

TEST(Csv, AFirstLineMayNameTheSeparator) {
  for (const std::string c : {"\t", "|", ":", "~", "^"})
    for (const std::string& first :
         {"sep=" + c, "SEP=" + c, "\"sep=" + c + "\"", "\xef\xbb\xbfsep=" + c}) {
      const std::string text = first + "\r\nid" + c + "name\r\n1" + c + "B, A; C\r\n";
      const auto rows = parse_csv(text, "c.csv");
      ASSERT_EQ(rows.size(), 2u) << text;
      EXPECT_EQ(rows[0].fields, (Fields{"id", "name"})) << text;
      EXPECT_EQ(rows[1].fields, (Fields{"1", "B, A; C"})) << text;
      EXPECT_EQ(rows[1].line, 3);
    }
  EXPECT_EQ(parse_csv("sep=;\nid;a,b,c\n1;2\n", "c.csv")[0].fields, (Fields{"id", "a,b,c"}))
      << "and not what stands there most often";
  EXPECT_EQ(parse_csv("sep=,\nid,a;b;c\n1,2\n", "c.csv")[0].fields, (Fields{"id", "a;b;c"}));
  EXPECT_EQ(parse_csv("sep=\n1\n", "c.csv")[0].fields, (Fields{"sep="})) << "names none";
  EXPECT_EQ(parse_csv("sep=x\n1\n", "c.csv").size(), 2u) << "a heading";
  EXPECT_EQ(parse_csv("id\nsep=;\n", "c.csv").size(), 2u) << "in the first line only";
}

TEST(Csv, IsReadAsSpreadsheetsWriteIt) {
  const auto rows = parse_csv(
      "\xef\xbb\xbfid;name\r\n1;\"Lee; \"\"Ann\"\"\"\r\n# nobody\r\n\r\n 2 ;Müller\n", "c.csv");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].fields, (Fields{"id", "name"}));
  EXPECT_EQ(rows[1].fields, (Fields{"1", "Lee; \"Ann\""}));
  EXPECT_EQ(rows[2].fields, (Fields{"2", "Müller"}));
  EXPECT_EQ(rows[2].line, 5);
  EXPECT_EQ(parse_csv("id,name\n1,\"Meier, Hans\"\n", "c.csv")[1].fields[1], "Meier, Hans");
  EXPECT_EQ(parse_csv("id,name\n1,O\"Neil\n", "c.csv")[1].fields[1], "O\"Neil");
  for (const char* bad : {"id,name\n1\n", "id,name\n1,\"open\n", "id,name\n1,M\xfcller\n"})
    EXPECT_THROW(static_cast<void>(parse_csv(bad, "c.csv")), Error) << bad;
}

TEST(Csv, TheHeadingSaysWhatPartsTheFieldsNotTheCommentAboveIt) {
  for (const char* part : {",", ";", "\t"}) {
    const std::string p = part;
    const auto rows =
        parse_csv("# a, comment; of, its, own\n\na" + p + "\"b,,;\t\"" + p + "c\n1" + p + p + "3\n",
                  "c.csv", k_any_text);
    ASSERT_EQ(rows.size(), 2u) << part;
    EXPECT_EQ(rows[0].fields, (Fields{"a", "b,,;\t", "c"})) << part;
    EXPECT_EQ(rows[1].fields, (Fields{"1", "", "3"})) << part;
  }
}

TEST(Csv, EmptyFieldsAtTheEndsOfARowAreFields) {
  EXPECT_EQ(parse_csv("a\tb\tc\n\t2\t\n", "c.csv")[1].fields, (Fields{"", "2", ""}));
  EXPECT_EQ(parse_csv("a,b\n,\n\"\",\" \"", "c.csv")[2].fields, (Fields{"", " "}));
}

TEST(Csv, LinesAreCountedThroughQuotesAndAllLineEnds) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    const auto rows =
        parse_csv("a,b" + end + "1,\"two\nlines\"" + end + end + "3,4" + end, "c.csv", k_any_text);
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[1].fields[1], "two\nlines");
    EXPECT_EQ(rows[1].line, 2);
    EXPECT_EQ(rows[2].line, 5);
  }
  const auto open = error_in("a,b\n1,\"two\nlines\n3,4\n");
  EXPECT_EQ(code_of(open), FileError::malformed);
  EXPECT_EQ(place_of(open), "c.csv:2");
}

TEST(Csv, CommentsAreGivenWhereTheyStand) {
  CsvReader in("## first \na,b\n\"# with, comma\",\n1,2\n#\n", "c.csv");
  ASSERT_EQ(in.next(), CsvReader::Line::comment);
  EXPECT_EQ(in.comment(), "first");
  ASSERT_EQ(in.next(), CsvReader::Line::row);
  ASSERT_EQ(in.next(), CsvReader::Line::comment);
  EXPECT_EQ(in.comment(), "with, comma");
  EXPECT_EQ(in.at(), "c.csv:3");
  ASSERT_EQ(in.next(), CsvReader::Line::row);
  EXPECT_EQ(in.fields()[1], "2");
  ASSERT_EQ(in.next(), CsvReader::Line::comment);
  EXPECT_EQ(in.comment(), "");
  EXPECT_EQ(in.next(), CsvReader::Line::end);
  EXPECT_EQ(in.next(), CsvReader::Line::end);
}

TEST(Csv, ARowOfAnotherLengthIsRefused) {
  const auto longer = error_in("a,b\n\n1,2\n1,2,3\n"), shorter = error_in("a,b\n1\n");
  EXPECT_EQ(code_of(longer), FileError::inconsistent);
  EXPECT_EQ(place_of(longer), "c.csv:4");
  EXPECT_TRUE(tells(longer, 3) && tells(longer, 2));
  EXPECT_EQ(place_of(shorter), "c.csv:2");
  EXPECT_TRUE(tells(shorter, 1));
}

TEST(Csv, WhereAQuoteIsACharacterItStaysOne) {
  const auto rows = parse_csv("a,b\n\"1,2\"\n", "c.csv", {.quotes = false});
  EXPECT_EQ(rows[1].fields, (Fields{"\"1", "2\""}));
}

TEST(CsvLimits, RowsAndFieldsBeyondAreRefusedWithTheLimitNamed) {
  std::string rows = "id,name\n", fields = "id";
  for (int i = 0; i < 20'000; ++i) rows += "1,a\n";
  EXPECT_EQ(parse_csv(rows, "c.csv").size(), 20'001U);
  const auto too_many = error_in(rows + "1,a\n");
  EXPECT_EQ(code_of(too_many), FileError::too_large);
  EXPECT_EQ(place_of(too_many), "c.csv:20002");
  EXPECT_TRUE(tells(too_many, 20'000));
  for (int i = 1; i < 100; ++i) fields += ",x";
  EXPECT_EQ(parse_csv(fields, "c.csv")[0].fields.size(), 100U);
  const auto too_wide = error_in(fields + ",x");
  EXPECT_EQ(code_of(too_wide), FileError::too_large);
  EXPECT_EQ(place_of(too_wide), "c.csv:1");
  EXPECT_TRUE(tells(too_wide, 100));
}

TEST(CsvNumber, IsAllOfTheFieldAndFinite) {
  EXPECT_EQ(number_in_field("-0.5e1"), -5.0);
  EXPECT_EQ(number_in_field("+2"), 2.0);
  for (const char* other : {"", "1,5", "1 ", "0x10", "nan", "inf", "1e999", "+-1", "one"})
    EXPECT_EQ(number_in_field(other), std::nullopt) << other;
}

}  // namespace
}  // namespace cavum
