#include "engine/base/json_reader.h"

#include <gtest/gtest.h>

#include <chrono>
#include <ctime>
#include <nlohmann/json.hpp>

#include "engine/base/file_error.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

using namespace testing_basics;

std::string nested(std::size_t depth) { return repeated("[", depth) + repeated("]", depth); }

std::optional<Error> json_refused(const std::string& text, const JsonLimits& limits = {}) {
  return thrown_by([&] { static_cast<void>(parse_json(text, "ticket.json", limits)); });
}

/// Too large, with `limit` named.
bool json_beyond(int limit, const std::optional<Error>& error) {
  return code_of(error) == FileError::too_large && tells(error, limit);
}

TEST(JsonReader, ReadsWhatTheLibraryReads) {
  for (const char* text : {"null", "1", "-1.5e3", "\"a\\u00e4\"", "[]", "{}",
                           R"({"a":[1,{"b":null}],"c":true,"a":2})", " [ 1 , 2 ] \n"}) {
    EXPECT_EQ(parse_json(text, "x"), nlohmann::json::parse(text)) << text;
    EXPECT_TRUE(is_json(text)) << text;
  }
}

TEST(JsonReader, WhatIsNoJsonIsAnErrorThatNamesTheFileAndThePlace) {
  for (const std::string& text : std::initializer_list<std::string>{
           "", "{", "[1,]", "nul", "1 2", "\"\xff\"", "{\"a\" 1}", "[\"\x01\"]"}) {
    EXPECT_EQ(code_of(json_refused(text)), FileError::malformed) << text;
    EXPECT_EQ(place_of(json_refused(text)), "ticket.json");
    EXPECT_TRUE(parse_json_or_null(text).is_null()) << text;
    EXPECT_FALSE(is_json(text)) << text;
  }
  EXPECT_TRUE(tells(json_refused("[1,\n 2,\n x]"), 3)) << "the line";
  EXPECT_EQ(code_of(json_refused("1e999")), FileError::out_of_range);
}

TEST(JsonReader, BracketsInsideOneAnotherAreRefusedBeforeTheyAreKept) {
  EXPECT_FALSE(json_refused(nested(64)));
  EXPECT_TRUE(json_beyond(64, json_refused(nested(65))));
  // closed or left open, lists or objects: 8 MB of them, more than any stack bears
  for (const std::string& text :
       {nested(4'000'000), repeated("[", 8'000'000), repeated("{\"a\":", 1'600'000),
        repeated("[{\"a\":", 1'000'000)}) {
    EXPECT_TRUE(json_beyond(64, json_refused(text)));
    EXPECT_TRUE(parse_json_or_null(text).is_null());
  }
}

TEST(JsonReader, ManyValuesAndLongTextsAreRefusedWithTheLimitNamed) {
  const JsonLimits few{100, 5, 3};
  EXPECT_FALSE(json_refused("[1,2,3,4]", few));
  EXPECT_TRUE(json_beyond(5, json_refused("[1,2,3,4,5]", few)));
  EXPECT_TRUE(json_beyond(5, json_refused(R"({"a":1,"b":2,"c":3})", few)))
      << "names count: they take memory";
  EXPECT_TRUE(json_beyond(5, json_refused(R"({"a":1,"a":1,"a":1})", few)))
      << "a name given twice counts twice";
  EXPECT_TRUE(json_beyond(100, json_refused("\"" + repeated("x", 100) + "\"", few)));
  const auto began = std::chrono::steady_clock::now();
  EXPECT_TRUE(json_beyond(1'000'000, json_refused("[" + repeated("[],", 3'000'000) + "0]")));
  EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(5));
}

// The library's callback looked at all members again after each that is an object: 330,000 took
// minutes.
TEST(JsonReader, ObjectsOfManyObjectsAreReadInTime) {
  std::string text = "{";
  for (int i = 0; i < 300'000; ++i) text += (i > 0 ? ",\"" : "\"") + std::to_string(i) + "\":{}";
  const std::clock_t began = std::clock();
  EXPECT_EQ(parse_json(text + "}", "many").size(), 300'000U);
  EXPECT_LT(static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC, 5);
}

}  // namespace
}  // namespace cavum
