// The real hidapi on an emulated pedal: found, read at 1 kHz without a gap, unplugged and plugged
// in again, silent, and with descriptors that make no sense.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <thread>

#include "engine/device/device_error.h"
#include "engine/device/hardware/hid_pedal.h"
#include "tests/device/the_pedal.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

using namespace std::chrono_literals;
using testing_basics::code_of;
using testing_basics::comes_true;
using testing_basics::text_of;
using EmulatedPedal = testing_device::ThePedal;

class PedalTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!EmulatedPedal::possible())
      GTEST_SKIP() << "runs under umockdev-wrapper only: ctest does so";
  }
};

TEST_F(PedalTest, IsFoundWithItsAxes) {
  const EmulatedPedal pedal;
  const auto found = list_hid_pedals();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].id(), "068e:00f2");
  EXPECT_EQ(found[0].axes.size(), 3u);
  EXPECT_FALSE(found[0].problem) << text_of(found[0].problem);
  EXPECT_EQ(found[0].path, pedal.path());
  EXPECT_EQ(found[0].name, "CH Products Pro Pedals");
}

TEST_F(PedalTest, PresentButSilentIsUnknown) {
  const EmulatedPedal pedal;
  HidPedal reader(0x068e, 0x00f2, {});
  ASSERT_TRUE(comes_true([&] { return !reader.problem(); })) << text_of(reader.problem());
  std::this_thread::sleep_for(100ms);
  const PedalReading r = reader.read();
  EXPECT_FALSE(r.fresh);
  EXPECT_TRUE(std::isnan(r.position));
}

TEST_F(PedalTest, ReadsTheCalibratedAxisAndGoesStale) {
  EmulatedPedal pedal;
  HidPedal reader(0x068e, 0x00f2,
                  {.axis = 1, .released = 200, .pressed = 100, .speaks_on_change = false});
  ASSERT_TRUE(comes_true([&] { return !reader.problem(); })) << text_of(reader.problem());
  pedal.report_axes(7, 150, 9);
  ASSERT_TRUE(comes_true([&] { return std::abs(reader.read().position - 0.5) < 1e-4; }));
  pedal.report_axes(7, 250, 9);
  ASSERT_TRUE(comes_true([&] { return reader.read().position == 0.0; }));
  std::this_thread::sleep_for(std::chrono::duration<double>(1.2 * HidPedal::k_stale_after_s));
  EXPECT_FALSE(reader.read().fresh) << "a continuous pedal that says nothing is unknown";
}

TEST_F(PedalTest, OneThatSpeaksOnChangeHoldsWhileItIsPluggedIn) {
  EmulatedPedal pedal;
  HidPedal reader(0x068e, 0x00f2,
                  {.axis = 0, .released = 0, .pressed = 255, .speaks_on_change = true});
  ASSERT_TRUE(comes_true([&] { return !reader.problem(); })) << text_of(reader.problem());
  EXPECT_FALSE(reader.read().fresh) << "nothing heard yet";
  pedal.report_axes(255, 0, 0);
  ASSERT_TRUE(comes_true([&] { return reader.read().fresh; }));
  std::this_thread::sleep_for(300ms);
  EXPECT_TRUE(reader.read().fresh);
  EXPECT_EQ(reader.read().position, 1.0);
  pedal.unplug();
  EXPECT_TRUE(comes_true([&] { return !reader.read().fresh; }, 100ms));
}

TEST_F(PedalTest, ThreeThousandReportsArriveWithoutAGap) {
  EmulatedPedal pedal;
  HidPedal reader(0x068e, 0x00f2,
                  {.axis = 0, .released = 0, .pressed = 255, .speaks_on_change = false});
  ASSERT_TRUE(comes_true([&] { return !reader.problem(); })) << text_of(reader.problem());
  constexpr int k_reports = 3000;
  auto next = std::chrono::steady_clock::now();
  for (int i = 0; i < k_reports; ++i) {
    ASSERT_TRUE(pedal.report({static_cast<std::uint8_t>(i), 1, 2}));
    next += 1ms;
    std::this_thread::sleep_until(next);
  }
  ASSERT_TRUE(comes_true([&] { return reader.counts().reports >= k_reports; }));
  EXPECT_EQ(reader.counts().reports, k_reports);
  EXPECT_EQ(reader.counts().foreign_reports, 0);
  std::printf("longest gap between two of %d reports sent each millisecond: %.1f ms\n", k_reports,
              1e3 * reader.counts().longest_gap_s);
}

TEST_F(PedalTest, UnpluggedIsUnknownWithin50msAndComesBack) {
  EmulatedPedal pedal;
  HidPedal reader(0x068e, 0x00f2,
                  {.axis = 0, .released = 0, .pressed = 255, .speaks_on_change = false});
  ASSERT_TRUE(comes_true([&] { return !reader.problem(); })) << text_of(reader.problem());
  for (int round = 0; round < 2; ++round) {
    ASSERT_TRUE(comes_true([&] {
      pedal.report_axes(255, 0, 0);
      return reader.read().fresh && reader.read().position == 1.0;
    }));
    std::this_thread::sleep_for(5ms);  // what was sent is heard
    pedal.unplug();
    const auto gone = std::chrono::steady_clock::now();
    auto last_fresh = gone;  // the last moment before which it was asked and still held
    ASSERT_TRUE(comes_true([&] {
      const auto asked = std::chrono::steady_clock::now();
      if (!reader.read().fresh) return true;
      last_fresh = asked;
      return false;
    }));
    EXPECT_LT(last_fresh - gone, 50ms);
    ASSERT_TRUE(comes_true([&] { return std::isnan(reader.read().position); }));
    EXPECT_TRUE(reader.problem());
    pedal.plug_in();
  }
  ASSERT_TRUE(comes_true([&] { return reader.counts().plugged_in == 3; }));
  EXPECT_EQ(reader.counts().unplugged, 2);
}

TEST_F(PedalTest, OneThatMayNotBeOpenedNamesTheRule) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may open everything";
  EmulatedPedal pedal;
  pedal.forbid();
  const auto found = list_hid_pedals();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(code_of(found[0].problem), DeviceError::not_permitted);
  EXPECT_NE(text_of(found[0].problem).find("{idVendor}==\"068e\""), std::string::npos)
      << text_of(found[0].problem);
}

TEST_F(PedalTest, NoAxisOrNonsenseIsSaidAndNeverCuts) {
  using Descriptor = std::vector<std::uint8_t>;
  for (const auto& [descriptor, wrong] :
       {std::pair{Descriptor{0x05, 0x07, 0x19, 0xe0, 0x29, 0xe7, 0x15, 0, 0x25, 1, 0x75, 1, 0x95, 8,
                             0x81, 2},
                  DeviceError::no_such_axis},
        {Descriptor{0xff, 0x80, 0x12}, DeviceError::bad_descriptor}}) {
    EmulatedPedal pedal(descriptor);
    HidPedal reader(0x068e, 0x00f2, {});
    ASSERT_TRUE(comes_true([&, wrong = wrong] { return code_of(reader.problem()) == wrong; }))
        << text_of(reader.problem());
    pedal.report({0xff, 0xff, 0xff});
    std::this_thread::sleep_for(30ms);
    EXPECT_FALSE(reader.read().fresh);
  }
}

}  // namespace
}  // namespace cavum
