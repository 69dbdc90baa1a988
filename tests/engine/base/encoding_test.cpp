// Bytes as text, against the examples of RFC 4648, section 10, and for what is no such text.
#include "engine/base/encoding.h"

#include <gtest/gtest.h>

#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

using testing_basics::bytes_of;

TEST(Encoding, IsAsRfc4648Prints) {
  const char* examples[][3] = {{"", "", ""},
                               {"f", "Zg==", "66"},
                               {"fo", "Zm8=", "666f"},
                               {"foo", "Zm9v", "666f6f"},
                               {"foob", "Zm9vYg==", "666f6f62"}};
  for (const auto& [text, base64, hex] : examples) {
    EXPECT_EQ(to_base64(bytes_of(text)), base64);
    EXPECT_EQ(from_base64(base64), bytes_of(text));
    EXPECT_EQ(to_hex(bytes_of(text)), hex);
    EXPECT_EQ(from_hex(hex), bytes_of(text));
  }
  EXPECT_EQ(to_base64(bytes_of("\xfb\xff"), Base64::in_address), "-_8");
  EXPECT_EQ(from_base64("-_8", Base64::in_address), bytes_of("\xfb\xff"));
}

TEST(Encoding, RefusesEveryOtherText) {
  for (const char* bad : {"Zg", "Zg=", "Zh==", "Zg==\n", "-_8=", "Zm9\xff"})
    EXPECT_FALSE(from_base64(bad)) << bad;
  for (const char* bad : {"-_8=", "+/8", "-_9"})
    EXPECT_FALSE(from_base64(bad, Base64::in_address)) << bad;
  for (const char* bad : {"6", "6F", "6g", " 6f", "6f "}) EXPECT_FALSE(from_hex(bad)) << bad;
}

}  // namespace
}  // namespace cavum
