#include "engine/base/text.h"

#include <gtest/gtest.h>

namespace cavum {
namespace {

const std::string k_umlaut = "z\xc3\xa4hne", k_tooth = "\xf0\x9f\xa6\xb7";
// a stray byte, a character cut short, one written too long, half of a UTF-16 pair, one beyond the
// last
const char* const k_not_utf8[] = {"a\xff",    "\x80",         "\xc3",         "\xe2\x82",
                                  "\xc0\xaf", "\xe0\x80\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80"};

TEST(Text, PlainIsValidUtf8WithoutControlCharacters) {
  for (const std::string& good : {std::string(), std::string("gutta-percha"), k_umlaut, k_tooth})
    EXPECT_TRUE(is_plain_text(good)) << good;
  for (const char* bad : k_not_utf8) EXPECT_FALSE(is_plain_text(bad));
  for (const char* bad : {"a\nb", "a\tb", "\x1b[31m", "\x7f"}) EXPECT_FALSE(is_plain_text(bad));
  EXPECT_FALSE(is_plain_text(std::string_view("a\0b", 3)));
}

TEST(Text, OneLineIsAlwaysPlain) {
  EXPECT_EQ(one_line("two\nlines of " + k_umlaut + k_tooth), "two lines of " + k_umlaut + k_tooth);
  for (const char* bad : k_not_utf8) EXPECT_TRUE(is_plain_text(one_line(bad)));
  EXPECT_EQ(one_line("a\xff\x1b"), "a? ");
}

TEST(Text, XmlKeepsWhatXmlKnowsAndNothingElse) {
  EXPECT_EQ(xml_text("<a href=\"x\">&'"), "&lt;a href=&quot;x&quot;&gt;&amp;&#39;");
  EXPECT_EQ(xml_text(k_umlaut + "\n\t\r"), k_umlaut + "&#10;&#9;&#13;");
  EXPECT_EQ(xml_text("\xff\x01" + k_tooth), "??" + k_tooth);
}

// CSI as one character of C1, an override and an isolate of direction, a line separator
const char* const k_controls_of_unicode[] = {
    "a\xc2\x9b"
    "31m",
    "\xe2\x80\xae"
    "ssap",
    "\xe2\x81\xa6"
    "x",
    "a\xe2\x80\xa8"
    "b"};

TEST(Text, ControlsOfUnicodeAreControls) {
  for (const std::string text : k_controls_of_unicode) {
    EXPECT_FALSE(is_plain_text(text)) << text;
    EXPECT_TRUE(is_plain_text(one_line(text))) << text;
    EXPECT_TRUE(is_plain_text(xml_text(text))) << text;
    EXPECT_TRUE(is_plain_text(terminal_text(text))) << text;
  }
  EXPECT_EQ(one_line("\xe2\x80\xae"
                     "ssap"),
            " ssap");
  const std::string beside =
      "\xc2\xa0\xe2\x80\xa7\xe2\x80\xaf\xe2\x81\xa5\xe2\x81\xaa";  // the characters next to those
  EXPECT_EQ(one_line(beside), beside);
}

TEST(Text, XmlKnowsNoNoncharacters) {
  EXPECT_EQ(xml_text("a\xef\xbf\xbe"
                     "b\xef\xbf\xbf"),
            "a?b?");
}

TEST(Text, ForATerminalKeepsItsLayoutAndCommandsNothing) {
  EXPECT_EQ(terminal_text("a\tb\r\n" + k_umlaut), "a\tb\r\n" + k_umlaut);
  EXPECT_EQ(terminal_text("\x1b[2J\x07\x7f\xff"), "?[2J???");
}

TEST(Text, JsonForATerminalReadsTheSame) {
  EXPECT_EQ(terminal_json("{\n \"a\": \"" + k_umlaut + "\xc2\x9b\xe2\x80\xae\x7f\"\n}"),
            "{\n \"a\": \"" + k_umlaut + "\\u009b\\u202e\\u007f\"\n}");
}

TEST(Text, WholeCharactersEndWhereOneEnds) {
  const std::string text = "a" + k_tooth + "\xc3\xa4";
  const std::size_t whole[] = {0, 1, 1, 1, 1, 5, 5, 7};
  for (std::size_t n = 0; n <= text.size(); ++n)
    EXPECT_EQ(whole_characters(std::string_view(text).substr(0, n)), whole[n]) << n;
  EXPECT_EQ(whole_characters("\x80\x80\x80\x80\x80"), 5u) << "what is no UTF-8 is not waited for";
}

TEST(Text, ACsvFieldIsQuotedOnOneLineAndNeverAFormula) {
  EXPECT_EQ(csv_field("plain"), "plain");
  EXPECT_EQ(csv_field("-0.25"), "-0.25");
  EXPECT_EQ(csv_field("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_field("say \"so\""), "\"say \"\"so\"\"\"");
  EXPECT_EQ(csv_field("=1+1"), "'=1+1");
  EXPECT_EQ(csv_field("-1+cmd"), "'-1+cmd");
  EXPECT_EQ(csv_field("-1-1"), "'-1-1") << "no number, but made of the letters of one";
  EXPECT_EQ(csv_field("@x"), "'@x");
  EXPECT_EQ(csv_field("+4912"), "'+4912");
  EXPECT_EQ(csv_field("\t=x"), "' =x");
  EXPECT_EQ(csv_field("\r=x"), "' =x");
  EXPECT_EQ(csv_field("\xef\xbc\x9d"
                      "x"),
            "'\xef\xbc\x9d"
            "x");
  EXPECT_EQ(csv_field("pass\n1,2,3\r\n"), "\"pass 1,2,3  \"");
  EXPECT_EQ(csv_field("a;=x;-3;b"), "\"a;'=x;'-3;b\"") << "another program splits at semicolons";
}

TEST(Text, NumbersReadAsPeopleWriteThem) {
  EXPECT_EQ(plain_number(60.0), "60");
  EXPECT_EQ(plain_number(3.5), "3.5");
  EXPECT_EQ(fixed(3.5, 2), "3.50");
  EXPECT_EQ(fixed(-1e300, 1).size(), 304u);
  EXPECT_EQ(fixed(-0.004, 2), "0.00") << "no zero lies below zero";
  EXPECT_EQ(fixed(-0.006, 2), "-0.01");
  EXPECT_EQ(fixed(-0.2, 0), "0");
}

TEST(Text, WhatCannotBeSeenSaysNothing) {
  for (const char* nothing : {"", " ", "   ", "\u00a0", "\u200b", "\u3164", "\u2800",
                              "\u2003 \u00a0", "\ufe0f", "\ufeff"})
    EXPECT_FALSE(is_seen_text(nothing)) << '"' << nothing << '"';
  for (const char* something :
       {"x", " a b ", "\u00e4", "\u5f20\u4f1f", "\u0646\u200c\u0645", "\U0001f9b7"})
    EXPECT_TRUE(is_seen_text(something)) << something;
  EXPECT_FALSE(is_seen_text("two\nlines"));
  EXPECT_FALSE(is_seen_text("\xff"));
  EXPECT_TRUE(holds_unseen("8002\u00a0"));
  EXPECT_TRUE(holds_unseen("Seat\u200b 1"));
  EXPECT_FALSE(holds_unseen("Seat 1, Süd"));
}

}  // namespace
}  // namespace cavum
