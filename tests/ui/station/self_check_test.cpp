// The station's window asks for a check of a real stylus before anybody sits down.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/ui/station/station_window.h"

namespace cavum::station {
namespace {

class SelfCheckWindow : public StationWindow {};

TEST_F(SelfCheckWindow, ARealStylusIsCheckedFirstAndOneThatIsNotThereIsNamed) {
  EXPECT_EQ(
      run("wait sign-in\ntype 4711\nkey enter\nwait self-check\npicture 30-self-check\nkey enter\nsleep 14\npicture 31-no-stylus\nclose\n",
          "--device inverse3"),
      0)
      << said();
  EXPECT_FALSE(std::filesystem::exists(session()));
  EXPECT_FALSE(std::filesystem::exists(folder_.file("home/selfcheck.jsonl")))
      << "nothing was measured";
}

TEST_F(SelfCheckWindow, AMouseAndASimulatedHandAreNot) {
  EXPECT_EQ(run("wait sign-in\ntype 4711\nkey enter\nwait device-check\nclose\n"), 0) << said();
  EXPECT_EQ(run("wait sign-in\ntype 4711\nkey enter\nwait device-check\nclose\n", "--device mouse"),
            0)
      << said();
}

}  // namespace
}  // namespace cavum::station
