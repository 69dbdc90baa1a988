#include "engine/base/text.h"

#include <gtest/gtest.h>

namespace cavum {
namespace {

const std::string k_umlaut = "z\xc3\xa4hne", k_tooth = "\xf0\x9f\xa6\xb7";
// a stray byte, a character cut short, one written too long, half of a UTF-16 pair, one beyond the last
const char* const k_not_utf8[] = {"a\xff", "\x80", "\xc3", "\xe2\x82", "\xc0\xaf", "\xe0\x80\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80"};

TEST(Text, PlainIsValidUtf8WithoutControlCharacters) {
  for (const std::string& good : {std::string(), std::string("gutta-percha"), k_umlaut, k_tooth}) EXPECT_TRUE(is_plain_text(good)) << good;
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

TEST(Text, NumbersReadAsPeopleWriteThem) {
  EXPECT_EQ(plain_number(60.0), "60");
  EXPECT_EQ(plain_number(3.5), "3.5");
  EXPECT_EQ(fixed(3.5, 2), "3.50");
  EXPECT_EQ(fixed(-1e300, 1).size(), 304u);
  EXPECT_EQ(fixed(-0.004, 2), "0.00") << "no zero lies below zero";
  EXPECT_EQ(fixed(-0.006, 2), "-0.01");
  EXPECT_EQ(fixed(-0.2, 0), "0");
}

}  // namespace
}  // namespace cavum
