// `cavum devices` as a user runs it, on an emulated pedal.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <thread>

#include "engine/device/hardware/station_pedal.h"
#include "tests/device/emulated_pedal.h"
#include "tests/device/program.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

using namespace std::chrono_literals;
using testing_device::EmulatedPedal;
using testing_device::Ran;
using testing_device::run;

class DevicesVerb : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!EmulatedPedal::possible())
      GTEST_SKIP() << "runs under umockdev-wrapper only: ctest does so";
    ::setenv("CAVUM_HOME", home_.file("").c_str(), 1);
  }
  testing_basics::Folder home_;
};

/// Speaks all the time, as most pedals do.
class Speaking {
 public:
  explicit Speaking(EmulatedPedal& pedal)
      : thread_([this, &pedal] {
          while (!stop_) {
            pedal.report_axes(foot_, 128, static_cast<std::uint8_t>(127 + (++count_ & 1)));
            std::this_thread::sleep_for(5ms);
          }
        }) {}
  ~Speaking() {
    stop_ = true;
    thread_.join();
  }
  void press(std::uint8_t foot) { foot_ = foot; }

 private:
  std::atomic<bool> stop_{false};
  std::atomic<std::uint8_t> foot_{20};
  int count_ = 0;
  std::thread thread_;
};

TEST_F(DevicesVerb, ListsThePedalAndThatItIsNotCalibrated) {
  const EmulatedPedal pedal;
  const Ran text = run("devices"), json = run("devices --json");
  EXPECT_EQ(text.code, 0);
  EXPECT_NE(text.out.find("068e:00f2"), std::string::npos) << text.out;
  const auto j = nlohmann::json::parse(json.out);
  ASSERT_EQ(j["pedals"].size(), 1u);
  EXPECT_EQ(j["pedals"][0]["axes"].size(), 3u);
  EXPECT_EQ(j["pedals"][0]["calibrated"], false);
}

TEST_F(DevicesVerb, SaysThatThereIsNone) {
  EmulatedPedal pedal;
  pedal.unplug();
  EXPECT_TRUE(nlohmann::json::parse(run("devices --json").out)["pedals"].empty());
  EXPECT_EQ(run("devices --test").code, 2);
  EXPECT_EQ(run("devices --test --pedal nonsense").code, 2);
  pedal.plug_in();
}

TEST_F(DevicesVerb, TestsHowItSpeaks) {
  EmulatedPedal pedal;
  EXPECT_EQ(run("devices --test --seconds 0.3 --json").code, 1) << "present but silent";
  const Speaking speaking(pedal);
  const Ran r = run("devices --test --seconds 1 --json");
  ASSERT_EQ(r.code, 0) << r.out;
  const auto j = nlohmann::json::parse(r.out);
  EXPECT_GT(j["rate_hz"], 20.0);
  EXPECT_LT(j["rate_hz"], 210.0);
  EXPECT_EQ(j["axes"][2]["quantum"], 1);
  EXPECT_EQ(j["axes"][0]["quantum"], 0);
}

TEST_F(DevicesVerb, CalibratesAndKeepsIt) {
  EmulatedPedal pedal;
  Speaking speaking(pedal);
  // the foot goes down between the two questions
  FILE* pipe =
      ::popen((std::string(CAVUM_BINARY) + " devices --calibrate-pedal --seconds 1 >/dev/null 2>&1")
                  .c_str(),
              "w");
  ASSERT_NE(pipe, nullptr);
  std::fputs("\n", pipe);
  std::fflush(pipe);
  std::this_thread::sleep_for(2500ms);
  speaking.press(220);
  std::this_thread::sleep_for(100ms);
  std::fputs("\n", pipe);
  ASSERT_EQ(WEXITSTATUS(::pclose(pipe)), 0);
  const auto kept = load_station_pedal(home_.file("pedal.toml"));
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->calibration.axis, 0);
  EXPECT_EQ(kept->calibration.released, 24);
  EXPECT_EQ(kept->calibration.pressed, 216);
  EXPECT_EQ(nlohmann::json::parse(run("devices --json").out)["pedals"][0]["calibrated"], true);
}

}  // namespace
}  // namespace cavum
