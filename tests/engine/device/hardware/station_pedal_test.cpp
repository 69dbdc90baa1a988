// The station's pedal file and calibration.
#include "engine/device/hardware/station_pedal.h"

#include <gtest/gtest.h>

#include "engine/device/device_error.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

TEST(StationPedal, IsReadAsItWasWritten) {
  const StationPedal pedal{
      .vendor = 0x068e,
      .product = 0x00f2,
      .calibration = {.axis = 2, .released = 240, .pressed = 11, .speaks_on_change = true}};
  const StationPedal read = parse_station_pedal(to_toml(pedal), "pedal.toml");
  EXPECT_EQ(usb_id(read.vendor, read.product), "068e:00f2");
  EXPECT_EQ(read.calibration.axis, 2);
  EXPECT_EQ(read.calibration.released, 240);
  EXPECT_EQ(read.calibration.pressed, 11);
  EXPECT_TRUE(read.calibration.speaks_on_change);
}

TEST(StationPedal, WrongFilesAreRefused) {
  const std::string good =
      to_toml({.vendor = 1,
               .product = 2,
               .calibration = {.axis = 0, .released = 0, .pressed = 9, .speaks_on_change = false}});
  for (const auto& [from, to] : {std::pair{"released = 0", "released = 9"},
                                 {"axis = 0", "axis = -1"},
                                 {"0001:0002", "0001-0002"},
                                 {"0001:0002", "0001:000g"},
                                 {"= false", "= \"no\""},
                                 {"pressed = 9", "pressed = nan"},
                                 {"axis", "achse"}}) {
    std::string wrong = good;
    wrong.replace(wrong.find(from), std::string(from).size(), to);
    EXPECT_THROW(static_cast<void>(parse_station_pedal(wrong, "pedal.toml")), Error) << wrong;
  }
}

TEST(StationPedal, CalibrationTakesTheAxisThatMovedAndRestsAtZero) {
  const PedalCalibration c =
      calibrate_pedal({{.released = 128, .pressed = 130, .jitter = 1, .reports = 99},
                       {.released = 250, .pressed = 50, .jitter = 3, .reports = 99}},
                      {255, 255}, false);
  EXPECT_EQ(c.axis, 1);
  EXPECT_EQ(c.released, 243) << "3 of jitter and 4 of the way";
  EXPECT_EQ(c.pressed, 57);
  EXPECT_EQ(pedal_position(248, c.released, c.pressed), 0.0) << "the foot off, a little noise";
  EXPECT_EQ(pedal_position(50, c.released, c.pressed), 1.0);
  EXPECT_NEAR(pedal_position(150, c.released, c.pressed), 0.5, 1e-12);
  EXPECT_EQ(testing_basics::code_of([] {
              static_cast<void>(calibrate_pedal(
                  {{.released = 100, .pressed = 110, .jitter = 0, .reports = 5}}, {255}, false));
            }),
            DeviceError::axes_still);
}

}  // namespace
}  // namespace cavum
