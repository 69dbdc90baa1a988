// What the service of an Inverse3 says: the example of docs/inverse3.md is read as the page says,
// and what is damaged, too large or nonsense is refused and never more than that.
#include "engine/device/hardware/inverse3_protocol.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "engine/base/file.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

using testing_basics::code_of;

const char* const k_inventory = R"({"session_id": 7,
 "inverse3": [{"device_id": "049D", "config": {"handedness": "right", "device_info": {"id": "049D", "major_version": 7}},
               "state": {"cursor_position": {"x": 0.01, "y": -0.12, "z": 0.15}, "cursor_velocity": {"x": 0, "y": 0, "z": 0}},
               "status": {"calibrated": true, "power_supply": false}},
              {"device_id": "04BA", "state": {}}],
 "verse_grip": [{"device_id": "61549", "state": {"orientation": {"w": 0, "x": 2, "y": 0, "z": 0}, "button": true}}],
 "wireless_verse_grip": [{"device_id": "61548",
               "state": {"orientation": {"w": 0.6, "x": 0, "y": 0.8, "z": 0}, "buttons": {"a": false, "b": true, "c": false}}}]})";

TEST(Inverse3Protocol, AnInventoryIsReadInMillimetresWithUnitDirections) {
  const Inverse3Message m = parse_inverse3(k_inventory);
  EXPECT_TRUE(m.names_session);
  ASSERT_EQ(m.devices.size(), 2u);
  EXPECT_EQ(m.devices[0].id, "049D");
  ASSERT_TRUE(m.devices[0].position_mm.has_value());
  EXPECT_LT(length(*m.devices[0].position_mm - Vec3{10, -120, 150}), 1e-9);
  EXPECT_EQ(m.devices[0].calibrated, true);
  EXPECT_EQ(m.devices[0].powered, false);
  EXPECT_FALSE(m.devices[1].position_mm.has_value());
  EXPECT_FALSE(m.devices[1].calibrated.has_value()) << "it does not say";
  ASSERT_EQ(m.grips.size(), 2u);
  EXPECT_EQ(m.grips[0].id, "61548") << "wireless ones first";
  ASSERT_TRUE(m.grips[0].to_device.has_value());
  EXPECT_NEAR(m.grips[0].to_device->y, 0.8, 1e-12);
  EXPECT_TRUE(!m.grips[0].button_1 && m.grips[0].button_2);
  EXPECT_FALSE(m.grips[1].to_device.has_value()) << "far from a unit quaternion";
  EXPECT_TRUE(m.grips[1].button_1);
  EXPECT_FALSE(parse_inverse3("{}").names_session);
}

TEST(Inverse3Protocol, WhatIsNoMessageIsRefused) {
  for (const char* wrong :
       {"", "null", "[]", "7", "{\"inverse3\":7}", R"({"inverse3":[7]})",
        R"({"inverse3":[{"device_id":""}]})", R"({"inverse3":[{"device_id":"a\"b"}]})",
        R"({"inverse3":[{"device_id":"a","state":{"cursor_position":{"x":1,"y":1}}}]})",
        R"({"inverse3":[{"device_id":"a","state":{"cursor_position":{"x":"1","y":1,"z":1}}}]})",
        R"({"inverse3":[{"device_id":"a","state":{"cursor_position":{"x":3,"y":0,"z":0}}}]})",
        R"({"inverse3":[{"device_id":"a","state":{"cursor_position":{"x":1e999,"y":0,"z":0}}}]})",
        R"({"verse_grip":[{"device_id":"a","state":{"orientation":{"w":1}}}]})"})
    EXPECT_EQ(code_of([&] { static_cast<void>(parse_inverse3(wrong)); }),
              DeviceError::malformed_message)
        << wrong;
  for (const std::string& wrong :
       {std::string(k_inverse3_largest + 1, ' '),
        R"({"inverse3":)" + std::string(13, '[') + std::string(13, ']') + "}"})
    EXPECT_EQ(code_of([&] { static_cast<void>(parse_inverse3(wrong)); }),
              DeviceError::malformed_message);
}

TEST(Inverse3Protocol, ThePageOfLimitsSaysHowLargeAMessageMayBe) {
  const std::string page = read_text_file(std::string(CAVUM_SOURCE_DIR) + "/docs/limits.md");
  EXPECT_NE(page.find("bytes | 65,536 | `k_inverse3_largest` |"), std::string::npos);
  EXPECT_EQ(k_inverse3_largest, 65'536u);
}

TEST(Inverse3Protocol, DamageIsReadOrRefusedAndNothingElse) {
  std::mt19937_64 random(testing_basics::drawn_seed("Inverse3Protocol"));
  const std::string good = k_inventory;
  int refused = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string text = good;
    for (std::uint64_t n = random() % 4 + 1; n > 0; --n) {
      const std::size_t at = random() % text.size();
      switch (random() % 3) {
        case 0:
          text[at] = static_cast<char>(random());
          break;
        case 1:
          text.erase(at, random() % 20);
          break;
        default:
          text.insert(at, good, random() % good.size(), random() % 30);
      }
    }
    try {
      for (const auto& d : parse_inverse3(text).devices)
        ASSERT_LE(length(d.position_mm.value_or(Vec3{})), 2000.0);
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);
}

TEST(Inverse3Protocol, ACommandIsJsonWithTheForceInNewtons) {
  for (const bool vector : {true, false}) {
    const auto j = nlohmann::json::parse(inverse3_command("049D", {1.25, -0.5, 1e-9}, vector));
    ASSERT_EQ(j["inverse3"].size(), 1u);
    EXPECT_EQ(j["inverse3"][0]["device_id"], "049D");
    const auto& force =
        j["inverse3"][0]["commands"]["set_cursor_force"][vector ? "vector" : "values"];
    EXPECT_EQ(force["x"], 1.25);
    EXPECT_EQ(force["y"], -0.5);
    EXPECT_EQ(force["z"], 0.0);
  }
}

}  // namespace
}  // namespace cavum
