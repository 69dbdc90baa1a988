#include "engine/base/file_name.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>

namespace cavum {
namespace {

TEST(FileName, OfAPlainNameIsTheName) {
  for (const char* name : {"C-7KQ2-9ZTF-X0A1", "molar_access", "tooth-16.v2", "a"})
    EXPECT_EQ(file_name_of(name), name);
}

TEST(FileName, IsAlwaysOneNameInOneFolder) {
  std::set<std::string> seen;
  const std::string hostile[] = {"",
                                 ".",
                                 "..",
                                 "../../x",
                                 "/etc/passwd",
                                 "a/b",
                                 "a\\b",
                                 "~root",
                                 "-rf",
                                 ".hidden",
                                 "a\nb",
                                 "\x1b[31m",
                                 "x.cavum\0.txt",
                                 std::string("a\0b", 3),
                                 "M\xc3\xbcller",
                                 "\xe2\x80\xae"
                                 "fdp",
                                 "con:",
                                 std::string(5000, 'a'),
                                 std::string(5000, '/')};
  for (const auto& text : hostile) {
    const std::string name = file_name_of(text);
    EXPECT_FALSE(name.empty());
    EXPECT_LE(name.size(), 120u);
    EXPECT_EQ(std::filesystem::path(name).filename().string(), name) << text;
    EXPECT_EQ(
        name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_."),
        std::string::npos)
        << name;
    EXPECT_TRUE(name.front() != '.' && name.front() != '-') << name;
    seen.insert(name);
  }
  EXPECT_EQ(seen.size(), std::size(hostile));
}

TEST(FileName, OfTwoTextsThatLookAlikeAreTwo) {
  EXPECT_NE(file_name_of("a/b"), file_name_of("a_b"));
  EXPECT_NE(file_name_of("a/b"), file_name_of("a:b"));
  EXPECT_EQ(file_name_of("a/b"), file_name_of("a/b"));
  EXPECT_TRUE(file_name_of("../../x").starts_with("_._.._x-")) << file_name_of("../../x");
}

}  // namespace
}  // namespace cavum
