#include "engine/base/toml_limits.h"

#include <gtest/gtest.h>

#include <chrono>

#include "engine/base/file_error.h"
#include "engine/base/toml_reader.h"
#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

std::optional<Error> refused(const std::string& text) {
  return thrown_by([&] { (void)parse_toml(text, "f.toml"); });
}

TEST(TomlLimits, LongNamesAreRefusedWhereverTheyStand) {
  for (const std::string& dots : {repeated(".a", 31'000), repeated(" . a", 16),
                                  repeated(".\"x=[,\"", 40), repeated(".'#'", 40)})
    for (const std::string& text :
         {"[a" + dots + "]\n", "[[a" + dots + "]]\n", "a" + dots + " = 1\n",
          "b = {a" + dots + " = 1}\n", "b = [{\na = 1}, {a" + dots + " = 1}]\n",
          "s = \"\"\"\n\\\"\"\"\"\"\n[a" + dots + "]\n", "s = '''\n[x''''\n[a" + dots + "]\n",
          "# don't\n[a" + dots + "]\n", "s = \"\\\\\"\n[a" + dots + "]\n"})
      EXPECT_TRUE(tells(refused(text), 16)) << text.substr(0, 60);
  const auto named = refused("\n\n[a" + repeated(".a", 16) + "]\n");
  EXPECT_EQ(code_of(named), FileError::too_large);
  EXPECT_EQ(place_of(named), "f.toml:3:1");
  EXPECT_TRUE(tells(named, 17));
  EXPECT_FALSE(refused("[a" + repeated(".a", 15) + "]\n"));
}

TEST(TomlLimits, DotsInTextNumbersAndCommentsAreNoNames) {
  EXPECT_FALSE(refused("a = \"" + repeated("so. ", 100) + "\"\nb = '''" + repeated(".'.\n", 100) +
                       "'''\n# " + repeated(".", 100) + "\nc = [" + repeated("1.5, ", 100) +
                       "]\nd = \"\"\"" + repeated("[.", 100) + "\"\"\"\n"));
}

TEST(TomlLimits, ValuesInsideOneAnotherAreRefused) {
  EXPECT_TRUE(tells(refused("a = " + repeated("[", 17) + repeated("]", 17)), 17));
  EXPECT_TRUE(tells(refused("a = " + repeated("{a = [", 9)), 17));
  EXPECT_FALSE(
      refused("a = " + repeated("[", 16) + repeated("]", 16) + "\n[b]\n" + repeated("[[c]]\n", 50)))
      << "headers are not inside one another";
}

TEST(TomlLimits, NoTextTakesLong) {
  std::string names, deep, dotted;
  for (int i = 0; i < 200'000; ++i) names += "a" + std::to_string(i) + "=1\n";
  for (int i = 0; i < 20'000; ++i)
    deep += "[a" + std::to_string(i) + ".b.c.d.e.f.g.h.i.j.k.l.m.n]\n";
  for (int i = 0; i < 100'000; ++i) dotted += "a.b" + std::to_string(i) + "=1\n";
  for (const std::string& text :
       {names, deep, dotted, "a = [" + repeated("1,", 500'000) + "]",
        "a = [" + repeated("{},", 300'000) + "]", repeated("[[a]]\n", 150'000),
        "a = \"" + repeated("x", 2'000'000) + "\""}) {
    const auto began = std::chrono::steady_clock::now();
    EXPECT_EQ(code_of(refused(text)), FileError::too_large) << text.substr(0, 40);
    EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(1))
        << text.substr(0, 40);
  }
  for (std::size_t keep : {std::size_t{3'900}}) {  // the worst that is let through
    std::string text;
    for (std::size_t i = 0; i < keep / 2; ++i) text += "[a" + std::to_string(i) + ".b]\n";
    text += "[z]\na = [" + repeated("{},", 55'000) + "]\n";
    const auto began = std::chrono::steady_clock::now();
    EXPECT_FALSE(refused(text));
    EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(2));
  }
}

}  // namespace
}  // namespace cavum
