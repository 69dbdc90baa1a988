#include "engine/base/toml_reader.h"

#include <gtest/gtest.h>

#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

constexpr const char* k_text =
    "name = \"enamel\"\n"
    "k = 0.8\n"
    "count = 3\n"
    "  bad = \"x\"\n"
    "[inner]\n"
    "deep = 1\n";

template <class Ask>
std::string asked(const Ask& ask) {
  const toml::table document = parse_toml(k_text, "f.toml");
  return error_of([&] {
    TomlReader in(document, "f.toml");
    ask(in);
  });
}

TEST(TomlReader, SyntaxErrorsCarryLineAndColumn) {
  EXPECT_EQ(error_of([] { (void)parse_toml("a = 1\nb = = 2\n", "f.toml"); }).rfind("f.toml:2:", 0), 0u);
  EXPECT_EQ(error_of([] { (void)parse_toml("a = 1\na = 2\n", "f.toml"); }).rfind("f.toml:2:", 0), 0u) << "a key given twice";
}

TEST(TomlReader, WrongValuesAreNamedWithLineAndColumn) {
  EXPECT_EQ(asked([](TomlReader& in) { (void)in.number("k", 1, 2); }), "f.toml:2:5: 'k' is 0.8, outside 1 .. 2; choose a value in that range");
  EXPECT_EQ(asked([](TomlReader& in) { (void)in.number("bad", 0, 1); }).rfind("f.toml:4:9: 'bad' is not a number", 0), 0u);
  EXPECT_EQ(asked([](TomlReader& in) { (void)in.text("count"); }).rfind("f.toml:3:9: 'count' is not text", 0), 0u);
  EXPECT_EQ(asked([](TomlReader& in) { (void)in.table("k"); }).rfind("f.toml:2:5: 'k' is not a table", 0), 0u);
  EXPECT_EQ(asked([](TomlReader& in) { (void)in.array("inner"); }).rfind("f.toml:5:1: 'inner' is not a list", 0), 0u);
}

TEST(TomlReader, MissingKeysAreNamedWithThePlaceOfTheirTable) {
  const toml::table document = parse_toml(k_text, "f.toml");
  EXPECT_EQ(asked([](TomlReader& in) { (void)in.number("none", 0, 1); }).rfind("f.toml:1:1: 'none' is missing", 0), 0u);
  TomlReader inner(*document.get("inner")->as_table(), "f.toml");
  EXPECT_EQ(error_of([&] { (void)inner.text("none"); }).rfind("f.toml:5:1: 'none' is missing", 0), 0u);
}

TEST(TomlReader, WhatNobodyAskedForIsAnError) {
  const auto all_but = [](const std::string& left_out) {
    return asked([&](TomlReader& in) {
      for (const char* key : {"name", "k", "count", "bad"})
        if (key != left_out)
          (void)in.has(key), (void)(std::string(key) == "name" || std::string(key) == "bad" ? in.text(key) : std::to_string(in.number(key, 0, 9)));
      if (left_out != "inner") (void)in.table("inner");
      in.finish();
    });
  };
  EXPECT_EQ(all_but(""), "");
  EXPECT_EQ(all_but("bad").rfind("f.toml:4:9: 'bad' is not known here", 0), 0u);
  EXPECT_EQ(all_but("inner").rfind("f.toml:5:1: 'inner' is not known here", 0), 0u);
}

TEST(TomlReader, NotANumberIsOutsideEveryRange) {
  const toml::table document = parse_toml("a = nan\nb = inf\n", "f.toml");
  TomlReader in(document, "f.toml");
  EXPECT_EQ(error_of([&] { (void)in.number("a", 0, 1); }).rfind("f.toml:1:5: ", 0), 0u);
  EXPECT_EQ(error_of([&] { (void)in.number("b", 0, 1); }).rfind("f.toml:2:5: ", 0), 0u);
}

TEST(TomlReader, DefaultsHoldOnlyForAbsentKeys) {
  const toml::table document = parse_toml("a = 5\nb = \"t\"\n", "f.toml");
  TomlReader in(document, "f.toml");
  EXPECT_EQ(in.number_or("a", 0, 9, 1), 5);
  EXPECT_EQ(in.number_or("none", 0, 9, 1), 1);
  EXPECT_EQ(in.text_or("b", "u"), "t");
  EXPECT_EQ(in.text_or("none", "u"), "u");
  EXPECT_NE(error_of([&] { (void)in.number_or("a", 0, 4, 1); }), "");
}

}  // namespace
}  // namespace cavum
