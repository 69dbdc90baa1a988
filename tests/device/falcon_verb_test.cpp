// `cavum devices` as a user runs it, on an emulated Falcon.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "engine/device/hardware/open_stylus.h"
#include "tests/device/emulated_falcon.h"
#include "tests/device/emulated_pedal.h"
#include "tests/device/program.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

using namespace std::chrono_literals;
using testing_device::EmulatedFalcon;
using testing_device::Ran;
using testing_device::run;

class FalconVerb : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!testing_device::EmulatedPedal::possible())
      GTEST_SKIP() << "runs under umockdev-wrapper only: ctest does so";
    ::setenv("CAVUM_HOME", folder_.file("").c_str(), 1);
  }
  testing_basics::Folder folder_;
};

TEST_F(FalconVerb, IsListedAndTried) {
  EmulatedFalcon falcon;
  const auto listed = nlohmann::json::parse(run("devices --json").out);
  EXPECT_EQ(listed["styluses"][1]["id"], "falcon");
  EXPECT_EQ(listed["styluses"][1]["there"], true);
  EXPECT_TRUE(listed["styluses"][1]["problem"].is_null());
  const Ran tried = run("devices --test --stylus falcon --seconds 1 --no-push --json");
  ASSERT_EQ(tried.code, 0) << tried.out;
  const auto j = nlohmann::json::parse(tried.out);
  EXPECT_GT(j["rate_hz"], 50.0);
  EXPECT_LT(j["rate_hz"], 1100.0);
  EXPECT_EQ(run("devices --test --stylus falcon --seconds 0.2").code, 1)
      << "this one is never moved by a force";
}

TEST_F(FalconVerb, TheRuleForUdevIsPrintedForItAndForNoStylusThatNeedsNone) {
  const Ran printed = run("manual --udev-rules");
  EXPECT_EQ(printed.code, 0);
  EXPECT_NE(
      printed.out.find(
          "\nSUBSYSTEM==\"usb\", ATTR{idVendor}==\"0403\", ATTR{idProduct}==\"cb48\", MODE=\"0660\", TAG+=\"uaccess\"\n"),
      std::string::npos)
      << printed.out;
  EXPECT_EQ(printed.out.find("Inverse3"), std::string::npos) << "its service opens it";
}

TEST_F(FalconVerb, IsPlacedByFourMarks) {
  EmulatedFalcon falcon;
  std::mt19937_64 random(testing_basics::drawn_seed("FalconVerb"));
  std::normal_distribution<double> n;
  Placement truth;  // the device stands anywhere; the marks are where they are
  truth.rotation = normalized(Quat{1, 0.3 * n(random), 0.3 * n(random), 0.3 * n(random)});
  truth.offset_mm = -(rotation(truth.rotation) * k_falcon_middle_mm);
  const auto device_at = [&](Vec3 tooth_mm) {
    return rotation(truth.rotation).transposed(tooth_mm - truth.offset_mm);
  };
  const std::string said = folder_.file("said");
  const auto questions = [&said] {
    int count = 0;
    std::ifstream in(said);
    for (std::string line; std::getline(in, line);) ++count;
    return count;
  };
  const auto comes_true = [](const auto& condition) {
    for (int i = 0; i < 20000 && !condition(); ++i) std::this_thread::sleep_for(1ms);
    return condition();
  };
  int asked = 0;
  FILE* pipe = ::popen(
      (std::string(CAVUM_BINARY) + " devices --place --stylus falcon > " + said + " 2>&1").c_str(),
      "w");
  ASSERT_NE(pipe, nullptr);
  for (const Vec3 mark : {Vec3{0, 0, 0}, Vec3{20, 0, 0}, Vec3{0, 20, 0}, Vec3{0, 0, 20}}) {
    ASSERT_TRUE(comes_true([&] { return questions() > asked; }))
        << "it asks for each mark in a line";
    asked = questions();
    falcon.move_to(device_at(mark));
    const auto frames = falcon.frames();
    ASSERT_TRUE(comes_true([&] { return falcon.frames() > frames + 5; }));
    std::fputs("\n", pipe);
    std::fflush(pipe);
  }
  ASSERT_EQ(WEXITSTATUS(::pclose(pipe)), 0);
  const StationStylus kept =
      load_station_stylus(stylus_kinds().at("falcon", {}, {StylusHand::person}));
  for (const Vec3 p : {Vec3{0, 0, 0}, Vec3{10, -5, 8}})
    EXPECT_LT(length(to_tooth(kept.placement, device_at(p)).tip_mm - p), 0.2)
        << "two encoder steps and more";
}

}  // namespace
}  // namespace cavum
