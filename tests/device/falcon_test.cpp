// The Falcon through the real libusb, on one emulated by umockdev: firmware, homing, places, forces
// bit by bit, unplugged in the middle.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <random>
#include <thread>

#include "engine/base/file.h"
#include "engine/device/device_error.h"
#include "engine/device/hardware/falcon_stylus.h"
#include "engine/device/hardware/open_stylus.h"
#include "engine/device/hardware/udev_rule.h"
#include "tests/device/emulated_falcon.h"
#include "tests/device/emulated_pedal.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

using namespace std::chrono_literals;
using testing_basics::code_of;
using testing_basics::comes_true;
using testing_basics::text_of;
using testing_device::EmulatedFalcon;

/// In the device's own frame: what goes in comes out.
StationStylus own_frame() {
  StationStylus s = usual_station_stylus(falcon_kind());
  s.placement = {};
  return s;
}

class FalconTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!testing_device::EmulatedPedal::possible())
      GTEST_SKIP() << "runs under umockdev-wrapper only: ctest does so";
    ::setenv("CAVUM_HOME", folder_.file("").c_str(), 1);
    ::unsetenv("CAVUM_FALCON_FIRMWARE");
  }
  static bool ready(const Stylus& stylus) { return !stylus.health().problem; }
  static std::optional<ErrorCode> wrong(const Stylus& stylus) {
    return code_of(stylus.health().problem);
  }
  static Vec3 place(Stylus& stylus) { return stylus.read(1e-3).pose.tip_mm; }

  testing_basics::Folder folder_;
};

TEST_F(FalconTest, IsFoundAndItsPlaceIsWhereItStands) {
  EmulatedFalcon falcon;
  const StylusLook look = look_for_falcon();
  EXPECT_TRUE(look.there && !look.problem) << text_of(look.problem);
  FalconStylus stylus(own_frame());
  std::mt19937_64 random(testing_basics::drawn_seed("FalconTest"));
  std::uniform_real_distribution<double> off(-25, 25);
  for (int i = 0; i < 20; ++i) {
    const Vec3 at = k_falcon_middle_mm + Vec3{off(random), off(random), off(random)};
    falcon.move_to(at);
    ASSERT_TRUE(comes_true([&] { return length(place(stylus) - at) < 2 * k_falcon_quantum_mm; }))
        << text_of(stylus.health().problem);
  }
  EXPECT_TRUE(comes_true([&] { return (stylus.read(1e-3).flags & k_stylus_fresh) != 0; }));
  falcon.press(1);
  EXPECT_TRUE(comes_true(
      [&] { return (stylus.read(1e-3).flags & (k_button_1 | k_button_2)) == k_button_1; }));
  falcon.press(4);
  EXPECT_TRUE(comes_true(
      [&] { return (stylus.read(1e-3).flags & (k_button_1 | k_button_2)) == k_button_2; }));
}

TEST_F(FalconTest, WithoutFirmwareItSaysSo) {
  const EmulatedFalcon falcon(false);
  const FalconStylus stylus(own_frame());
  ASSERT_TRUE(comes_true([&] { return wrong(stylus) == DeviceError::firmware_missing; }))
      << text_of(stylus.health().problem);
  EXPECT_FALSE(ready(stylus));
}

TEST_F(FalconTest, FirmwareArrivesByteForByteAndRuns) {
  EmulatedFalcon falcon(false);
  std::mt19937_64 random(testing_basics::drawn_seed("FalconTest"));
  std::string firmware(1000 + random() % 100, '\0');
  for (char& c : firmware) c = static_cast<char>(random());
  write_text_file(folder_.file("fw.bin"), firmware);
  StationStylus station = own_frame();
  station.settings["firmware"] = folder_.file("fw.bin");
  FalconStylus stylus(station);
  ASSERT_TRUE(comes_true([&] { return ready(stylus); })) << text_of(stylus.health().problem);
  const auto got = falcon.firmware();
  EXPECT_EQ(std::string(got.begin(), got.end()), firmware);
}

TEST_F(FalconTest, AFirmwareThatDoesNotArriveIsSaid) {
  EmulatedFalcon falcon(false);
  falcon.take_firmware_wrong(true);
  write_text_file(folder_.file("fw.bin"), std::string(500, 'x'));
  ::setenv("CAVUM_FALCON_FIRMWARE", folder_.file("fw.bin").c_str(), 1);
  const FalconStylus stylus(own_frame());
  EXPECT_TRUE(comes_true([&] { return wrong(stylus) == DeviceError::wrong_firmware; }))
      << text_of(stylus.health().problem);
}

TEST_F(FalconTest, HomesBeforeItMeansAnything) {
  EmulatedFalcon falcon(true, false);
  FalconStylus stylus(own_frame());
  ASSERT_TRUE(comes_true([&] { return wrong(stylus) == DeviceError::needs_homing; }))
      << text_of(stylus.health().problem);
  stylus.send_force({0, 0, 5});
  std::this_thread::sleep_for(30ms);
  EXPECT_EQ(stylus.read(1e-3).flags & k_stylus_fresh, 0);
  EXPECT_TRUE(std::isnan(place(stylus).x)) << "no place at all before the first";
  const auto looking = falcon.last_frame();
  ASSERT_EQ(looking.size(), 16u);
  EXPECT_EQ(looking[13], 'A' + 8 + 1) << "red, and homing asked for";
  EXPECT_EQ(falcon.motors(), (std::vector<std::int16_t>{0, 0, 0}))
      << "an arm that does not know its place is not driven";
  for (const int arms : {1, 3, 5}) {
    falcon.set_homed(static_cast<std::uint8_t>(arms));
    std::this_thread::sleep_for(20ms);
    EXPECT_FALSE(ready(stylus)) << "one arm is not all";
  }
  falcon.set_homed(7);
  ASSERT_TRUE(comes_true([&] { return ready(stylus); })) << text_of(stylus.health().problem);
  EXPECT_TRUE(comes_true([&] { return falcon.last_frame()[13] == 'A' + 2; })) << "green";
}

TEST_F(FalconTest, ForcesAreTheTransposedMechanismInCounts) {
  EmulatedFalcon falcon;
  FalconStylus stylus(own_frame());
  ASSERT_TRUE(comes_true([&] { return ready(stylus); })) << text_of(stylus.health().problem);
  // Independent: work. Each arm's torque is the force times the way of the grip per turn of that
  // arm, by differences of the inverse mechanism's matrix.
  const Vec3 force{0.7, -1.1, 1.9};
  const auto sent = [&] {
    stylus.send_force(force);
    return falcon.motors();
  };
  ASSERT_TRUE(comes_true([&] { return sent() != std::vector<std::int16_t>{0, 0, 0}; }));
  const FalconGeometry g;
  const Vec3 at = place(stylus);
  double m[3][3];
  constexpr double h = 1e-4;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 step{axis == 0 ? h : 0, axis == 1 ? h : 0, axis == 2 ? h : 0};
    FalconAngles more{}, less{};
    ASSERT_TRUE(falcon_angles(g, at + step, more) && falcon_angles(g, at - step, less));
    for (std::size_t arm = 0; arm < 3; ++arm)
      m[axis][arm] = (more[arm] - less[arm]) / (2 * h);  // rad/mm
  }
  // the motors' torques must balance the force on every axis: sum over arms of torque * d angle / d
  // axis = force
  const auto motors = sent();
  const double f[3] = {force.x, force.y, force.z};
  for (int axis = 0; axis < 3; ++axis) {
    double sum_n = 0;
    for (std::size_t arm = 0; arm < 3; ++arm)
      sum_n += -motors[arm] * 1.9835e-5 * 7.62 * 1e3 * m[axis][arm];
    EXPECT_NEAR(sum_n, f[axis], 0.01) << "N, of axis " << axis << "; one count is about 0.002 N";
  }
  EXPECT_EQ(stylus.health().forces_cut, 0);
}

TEST_F(FalconTest, TooLargeAForceKeepsItsDirectionAndIsCounted) {
  EmulatedFalcon falcon;
  FalconStylus stylus(own_frame());
  ASSERT_TRUE(comes_true([&] { return ready(stylus); })) << text_of(stylus.health().problem);
  const auto motors_for = [&](Vec3 force) {
    stylus.send_force({});
    EXPECT_TRUE(comes_true([&] {
      stylus.send_force({});
      return falcon.motors() == std::vector<std::int16_t>{0, 0, 0};
    }));
    EXPECT_TRUE(comes_true([&] {
      stylus.send_force(force);
      return falcon.motors() != std::vector<std::int16_t>{0, 0, 0};
    }));
    return falcon.motors();
  };
  const auto whole = motors_for({0, 0, 8.9}), more = motors_for({0, 0, 30});
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(more[i], whole[i], 1);
    EXPECT_LE(std::abs(more[i]), 4096);
  }
  EXPECT_GT(stylus.health().forces_cut, 0);
  EXPECT_TRUE(comes_true([&] {
    stylus.send_force({std::nan(""), 0, 0});
    return falcon.motors() == std::vector<std::int16_t>{0, 0, 0};
  })) << "no number is no force";
}

TEST_F(FalconTest, ForceEndsWhenItIsCutAndWhenNobodyRenewsIt) {
  EmulatedFalcon falcon;
  FalconStylus stylus(own_frame());
  ASSERT_TRUE(comes_true([&] { return ready(stylus); })) << text_of(stylus.health().problem);
  const auto pushes = [&] { return falcon.motors() != std::vector<std::int16_t>{0, 0, 0}; };
  ASSERT_TRUE(comes_true([&] {
    stylus.send_force({0, 0, 2});
    return pushes();
  }));
  EXPECT_TRUE(comes_true([&] { return !pushes(); })) << "a servo that fell silent";
  ASSERT_TRUE(comes_true([&] {
    stylus.send_force({0, 0, 2});
    return pushes();
  }));
  stylus.send_force({0, 0, 2});
  stylus.cut_force();
  EXPECT_TRUE(comes_true([&] { return !pushes(); }));
  std::this_thread::sleep_for(10ms);
  EXPECT_FALSE(pushes());
}

TEST_F(FalconTest, UnpluggedItIsNotFreshAndComesBack) {
  EmulatedFalcon falcon;
  FalconStylus stylus(own_frame());
  ASSERT_TRUE(comes_true([&] { return ready(stylus); })) << text_of(stylus.health().problem);
  const auto fresh = [&] { return (stylus.read(1e-3).flags & k_stylus_fresh) != 0; };
  for (int round = 1; round <= 2; ++round) {
    ASSERT_TRUE(comes_true(fresh));
    const Vec3 before = place(stylus);
    falcon.unplug();
    ASSERT_TRUE(comes_true([&] { return !fresh(); }));
    ASSERT_TRUE(comes_true([&] { return stylus.health().unplugged == round; }));
    ASSERT_TRUE(comes_true([&] { return wrong(stylus) == DeviceError::not_there; }))
        << text_of(stylus.health().problem);
    EXPECT_FALSE(fresh());
    EXPECT_LT(length(place(stylus) - before), 1e-9) << "the last place stays, and is not fresh";
    falcon.plug_in();
    ASSERT_TRUE(comes_true([&] { return ready(stylus); })) << text_of(stylus.health().problem);
  }
  EXPECT_EQ(stylus.health().plugged_in, 3);
}

TEST_F(FalconTest, SilenceIsNotFreshAndDamagedAnswersAreLeftOut) {
  EmulatedFalcon falcon;
  FalconStylus stylus(own_frame());
  ASSERT_TRUE(comes_true([&] { return ready(stylus); })) << text_of(stylus.health().problem);
  falcon.garble(true);
  const auto before = stylus.health().readings;
  ASSERT_TRUE(comes_true([&] { return stylus.health().readings > before + 20; }))
      << "every second one is sound";
  EXPECT_LT(length(place(stylus) - k_falcon_middle_mm), 2 * k_falcon_quantum_mm);
  falcon.garble(false);
  falcon.fall_silent(true);
  ASSERT_TRUE(comes_true([&] { return (stylus.read(1e-3).flags & k_stylus_fresh) == 0; }));
  falcon.fall_silent(false);
  EXPECT_TRUE(comes_true([&] { return (stylus.read(1e-3).flags & k_stylus_fresh) != 0; }));
}

TEST_F(FalconTest, SpeaksAThousandTimesASecond) {
  EmulatedFalcon falcon;
  FalconStylus stylus(own_frame());
  ASSERT_TRUE(comes_true([&] { return ready(stylus) && stylus.health().readings > 2000; }))
      << text_of(stylus.health().problem);
  const StylusHealth h = stylus.health();
  std::printf("%.0f exchanges a second, scatter %.2f ms, longest gap %.1f ms\n",
              1 / h.mean_period_s, 1e3 * h.jitter_s, 1e3 * h.longest_gap_s);
  EXPECT_GT(h.mean_period_s, 0.9e-3) << "never faster than the servo";
}

TEST_F(FalconTest, OpensByNameAndErrorsSayWhatIsWrong) {
  {
    EmulatedFalcon falcon;
    const auto stylus = open_stylus("falcon");
    EXPECT_LT(length(first_pose(*stylus, 20.0).tip_mm), 2 * k_falcon_quantum_mm)
        << "the usual placement has the middle at the crown's";
    const auto found = list_styluses();
    EXPECT_TRUE(found[1].there);
    EXPECT_FALSE(found[1].problem) << text_of(found[1].problem);
    falcon.unplug();
    falcon.plug_in();
  }
  const auto none = list_styluses();
  EXPECT_FALSE(none[1].there);
  EXPECT_EQ(code_of(none[1].problem), DeviceError::not_there);
  EXPECT_EQ(code_of([] { static_cast<void>(open_stylus("phantom")); }),
            DeviceError::unknown_stylus);
}

TEST_F(FalconTest, OneThatMayNotBeOpenedNamesTheRule) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may open everything";
  EmulatedFalcon falcon;
  falcon.forbid();
  const StylusLook look = look_for_falcon();
  EXPECT_TRUE(look.there);
  EXPECT_EQ(code_of(look.problem), DeviceError::not_permitted);
  EXPECT_NE(text_of(look.problem).find(udev_rule(k_falcon_vendor, k_falcon_product, false)),
            std::string::npos)
      << text_of(look.problem);
  EXPECT_EQ(code_of([] { static_cast<void>(open_stylus("falcon")); }), DeviceError::not_permitted);
}

}  // namespace
}  // namespace cavum
