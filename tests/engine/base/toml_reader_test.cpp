#include "engine/base/toml_reader.h"

#include <gtest/gtest.h>

#include <functional>

#include "engine/base/file_error.h"
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

struct Asked {
  FileError code;
  const char* place;
  std::function<void(TomlReader&)> ask;
};

void expect_refused(const char* text, const std::vector<Asked>& list) {
  const toml::table document = parse_toml(text, "f.toml");
  for (const Asked& asked : list) {
    TomlReader in(document, "f.toml");
    const auto error = thrown_by([&] { asked.ask(in); });
    EXPECT_EQ(code_of(error), asked.code) << asked.place;
    EXPECT_EQ(place_of(error), asked.place);
  }
}

TEST(TomlReader, SyntaxErrorsCarryTheirLine) {
  for (const char* text : {"a = 1\nb = = 2\n", "a = 1\na = 2\n"}) {
    const auto error = thrown_by([&] { (void)parse_toml(text, "f.toml"); });
    EXPECT_EQ(code_of(error), FileError::malformed);
    EXPECT_TRUE(place_of(error).starts_with("f.toml:2:")) << text;
  }
}

TEST(TomlReader, WrongAndMissingValuesAreRefusedAtTheirPlaceOrThatOfTheirTable) {
  expect_refused(
      k_text,
      {{FileError::out_of_range, "f.toml:2:5", [](TomlReader& in) { (void)in.number("k", 1, 2); }},
       {FileError::wrong_type, "f.toml:4:9", [](TomlReader& in) { (void)in.number("bad", 0, 1); }},
       {FileError::wrong_type, "f.toml:3:9", [](TomlReader& in) { (void)in.text("count"); }},
       {FileError::wrong_type, "f.toml:2:5", [](TomlReader& in) { (void)in.table("k"); }},
       {FileError::wrong_type, "f.toml:5:1", [](TomlReader& in) { (void)in.array("inner"); }},
       {FileError::missing, "f.toml:1:1", [](TomlReader& in) { (void)in.number("none", 0, 1); }},
       {FileError::missing, "f.toml:5:1",
        [](TomlReader& in) { (void)TomlReader(*in.table("inner"), "f.toml").text("none"); }}});
  const toml::table document = parse_toml(k_text, "f.toml");
  const auto outside = thrown_by([&] { (void)TomlReader(document, "f.toml").number("k", 1, 2); });
  EXPECT_TRUE(tells(outside, "k") && tells(outside, 0.8) && tells(outside, 1.0) &&
              tells(outside, 2.0));
}

TEST(TomlReader, WhatNobodyAskedForIsAnError) {
  const auto all_but = [](const std::string& left_out) {
    return [left_out](TomlReader& in) {
      for (const char* key : {"name", "k", "count", "bad"})
        if (key != left_out)
          (void)in.has(key), (void)(std::string(key) == "name" || std::string(key) == "bad"
                                        ? in.text(key)
                                        : std::to_string(in.number(key, 0, 9)));
      if (left_out != "inner") (void)in.table("inner");
      in.finish();
    };
  };
  const toml::table document = parse_toml(k_text, "f.toml");
  TomlReader in(document, "f.toml");
  EXPECT_NO_THROW(all_but("")(in));
  expect_refused(k_text, {{FileError::unknown, "f.toml:4:9", all_but("bad")},
                          {FileError::unknown, "f.toml:5:1", all_but("inner")}});
}

TEST(TomlReader, NotANumberIsOutsideEveryRange) {
  expect_refused("a = nan\nb = inf\n", {{FileError::out_of_range, "f.toml:1:5",
                                         [](TomlReader& in) { (void)in.number("a", 0, 1); }},
                                        {FileError::out_of_range, "f.toml:2:5",
                                         [](TomlReader& in) { (void)in.number("b", 0, 1); }}});
}

TEST(TomlReader, DefaultsHoldOnlyForAbsentKeys) {
  const toml::table document = parse_toml("a = 5\nb = \"t\"\n", "f.toml");
  TomlReader in(document, "f.toml");
  EXPECT_EQ(in.number_or("a", 0, 9, 1), 5);
  EXPECT_EQ(in.number_or("none", 0, 9, 1), 1);
  EXPECT_EQ(in.text_or("b", "u"), "t");
  EXPECT_EQ(in.text_or("none", "u"), "u");
  EXPECT_EQ(code_of([&] { (void)in.number_or("a", 0, 4, 1); }), FileError::out_of_range);
}

}  // namespace
}  // namespace cavum
