#include "engine/base/json_reader.h"

#include <gtest/gtest.h>

#include <chrono>
#include <ctime>

#include "engine/base/error.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

using testing_basics::repeated;

std::string nested(std::size_t depth) { return repeated("[", depth) + repeated("]", depth); }

std::string error_of(const std::string& text, const JsonLimits& limits = {}) {
  try {
    static_cast<void>(parse_json(text, "ticket.json", limits));
    return {};
  } catch (const Error& e) {
    return e.what();
  }
}

TEST(JsonReader, ReadsWhatTheLibraryReads) {
  for (const char* text : {"null", "1", "-1.5e3", "\"a\\u00e4\"", "[]", "{}", R"({"a":[1,{"b":null}],"c":true,"a":2})", " [ 1 , 2 ] \n"}) {
    EXPECT_EQ(parse_json(text, "x"), nlohmann::json::parse(text)) << text;
    EXPECT_TRUE(is_json(text)) << text;
  }
}

TEST(JsonReader, WhatIsNoJsonIsAnErrorThatNamesTheFileAndThePlace) {
  for (const std::string& text : std::initializer_list<std::string>{"", "{", "[1,]", "nul", "1 2", "\"\xff\"", "{\"a\" 1}", "1e999", "[\"\x01\"]"}) {
    EXPECT_TRUE(error_of(text).starts_with("ticket.json: is no JSON (")) << error_of(text);
    EXPECT_TRUE(parse_json_or_null(text).is_null()) << text;
    EXPECT_FALSE(is_json(text)) << text;
  }
  EXPECT_NE(error_of("[1,\n 2,\n x]").find("line 3"), std::string::npos) << error_of("[1,\n 2,\n x]");
}

TEST(JsonReader, BracketsInsideOneAnotherAreRefusedBeforeTheyAreKept) {
  EXPECT_EQ(error_of(nested(64)), "");
  EXPECT_NE(error_of(nested(65)).find("nested deeper than 64"), std::string::npos) << error_of(nested(65));
  // closed or left open, lists or objects: 8 MB of them, more than any stack bears
  for (const std::string& text : {nested(4'000'000), repeated("[", 8'000'000), repeated("{\"a\":", 1'600'000), repeated("[{\"a\":", 1'000'000)}) {
    EXPECT_NE(error_of(text).find("nested deeper than 64"), std::string::npos);
    EXPECT_TRUE(parse_json_or_null(text).is_null());
  }
}

TEST(JsonReader, ManyValuesAndLongTextsAreRefusedWithTheLimitNamed) {
  const JsonLimits few{100, 5, 3};
  EXPECT_EQ(error_of("[1,2,3,4]", few), "");
  EXPECT_NE(error_of("[1,2,3,4,5]", few).find("more than 5 values"), std::string::npos);
  EXPECT_NE(error_of(R"({"a":1,"b":2,"c":3})", few).find("more than 5 values"), std::string::npos) << "names count: they take memory";
  EXPECT_NE(error_of(R"({"a":1,"a":1,"a":1})", few).find("more than 5 values"), std::string::npos) << "a name given twice counts twice";
  EXPECT_NE(error_of("\"" + repeated("x", 100) + "\"", few).find("102 bytes, more than 100"), std::string::npos);
  const auto began = std::chrono::steady_clock::now();
  EXPECT_NE(error_of("[" + repeated("[],", 3'000'000) + "0]").find("more than 1000000 values"), std::string::npos);
  EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(5));
}

// The library's callback looked at all members again after each that is an object: 330,000 took minutes.
TEST(JsonReader, ObjectsOfManyObjectsAreReadInTime) {
  std::string text = "{";
  for (int i = 0; i < 300'000; ++i) text += (i > 0 ? ",\"" : "\"") + std::to_string(i) + "\":{}";
  const std::clock_t began = std::clock();
  EXPECT_EQ(parse_json(text + "}", "many").size(), 300'000U);
  EXPECT_LT(static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC, 5);
}

}  // namespace
}  // namespace cavum
