// OpenHaptics at run time, against a library of ours with its names (fake_hd.cpp): what was loaded,
// begun, calibrated, asked and sent.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <random>
#include <thread>

#include "engine/device/device_error.h"
#include "engine/device/hardware/open_stylus.h"
#include "engine/device/hardware/openhaptics_stylus.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

using namespace std::chrono_literals;
using testing_basics::code_of;
using testing_basics::comes_true;
using testing_basics::tells;
using testing_basics::text_of;
using testing_basics::thrown_by;

/// The test's hands on the library that the stylus has loaded.
struct Hands {
  void* file = ::dlopen(FAKE_HD, RTLD_NOW | RTLD_LOCAL);
  void (*place)(unsigned, const double*, int) =
      reinterpret_cast<void (*)(unsigned, const double*, int)>(::dlsym(file, "fake_hd_place"));
  void (*inkwell)(unsigned) = reinterpret_cast<void (*)(unsigned)>(::dlsym(file,
                                                                           "fake_hd_inkwell"));
  long (*force)(unsigned,
                double*) = reinterpret_cast<long (*)(unsigned, double*)>(::dlsym(file,
                                                                                 "fake_hd_force"));

  [[nodiscard]] Vec3 force_n(unsigned device) const {
    double f[3];
    force(device, f);
    return {f[0], f[1], f[2]};
  }
  [[nodiscard]] long frames(unsigned device) const {
    double f[3];
    return force(device, f);
  }
};

StationStylus station(const std::string& name = {}) {
  StationStylus s = usual_station_stylus(stylus_kinds().at("touch", {}, {StylusHand::person}));
  s.placement = {};
  s.settings["library"] = FAKE_HD;
  s.settings["device_name"] = name;
  return s;
}

class OpenHaptics : public ::testing::Test {
 protected:
  void SetUp() override { forget(); }
  void TearDown() override { forget(); }
  static void forget() {
    for (const char* name : {"FAKE_HD_NO_DEVICE", "FAKE_HD_ERROR_AFTER_MS", "FAKE_HD_CALIBRATION"})
      ::unsetenv(name);
  }
  static std::optional<ErrorCode> wrong(const Stylus& stylus) {
    return code_of(stylus.health().problem);
  }
  static bool ready(const Stylus& stylus) { return !stylus.health().problem; }
  Hands hands_;
};

TEST_F(OpenHaptics, WithoutTheLibraryItSaysSo) {
  StationStylus none = station();
  none.settings["library"] = "libHD-that-is-nowhere.so";
  EXPECT_EQ(code_of([&] { const OpenHapticsStylus s(none); }), DeviceError::library_missing);
  none.settings["library"] = "libm.so.6";
  EXPECT_EQ(code_of([&] { const OpenHapticsStylus s(none); }), DeviceError::library_too_old);
  const StylusLook look = look_for_touch(none, true);
  EXPECT_FALSE(look.there);
  EXPECT_EQ(code_of(look.problem), DeviceError::library_too_old);
}

TEST_F(OpenHaptics, ADeviceThatDoesNotBeginIsNamed) {
  ::setenv("FAKE_HD_NO_DEVICE", "1", 1);
  const auto begin = [](const std::string& name) {
    return [name] { const OpenHapticsStylus s(station(name)); };
  };
  EXPECT_EQ(code_of(begin("")), DeviceError::refuses);
  EXPECT_TRUE(tells(thrown_by(begin("")), "0x0300")) << "the number of its maker's driver";
  ::unsetenv("FAKE_HD_NO_DEVICE");
  EXPECT_TRUE(tells(thrown_by(begin("right")), "right"));
  const StylusLook look = look_for_touch(station(), true);
  EXPECT_TRUE(look.there && !look.problem) << text_of(look.problem);
  StylusOptions options;
  options.station = station();
  EXPECT_EQ(open_stylus("touch", options)->facts().id, "touch") << "looking leaves it free";
}

TEST_F(OpenHaptics, PlaceDirectionAndButtonsAreTheDevices) {
  std::mt19937_64 random(testing_basics::drawn_seed("OpenHaptics"));
  std::normal_distribution<double> n;
  OpenHapticsStylus stylus(station());
  EXPECT_NEAR(stylus.facts().peak_n, 3.2, 1e-12);
  EXPECT_NEAR(stylus.facts().continuous_n, 0.9, 1e-12);
  for (int i = 0; i < 10; ++i) {
    const Quat q = normalized(Quat{n(random), n(random), n(random), n(random)});
    const Mat3 m = rotation(q);
    const Vec3 at{20 * n(random), 20 * n(random), 20 * n(random)};
    const double transform[16] = {m.row_x.x, m.row_y.x, m.row_z.x, 0,         m.row_x.y, m.row_y.y,
                                  m.row_z.y, 0,         m.row_x.z, m.row_y.z, m.row_z.z, 0,
                                  at.x,      at.y,      at.z,      1};
    hands_.place(0, transform, i % 4);
    DeviceReading r;
    ASSERT_TRUE(comes_true([&] {
      r = stylus.read(1e-3);
      return length(r.pose.tip_mm - at) < 1e-12 && (r.flags & k_stylus_fresh) != 0;
    })) << text_of(stylus.health().problem);
    EXPECT_LT(length(rotation(r.pose.rotation) * Vec3{0, 0, 1} - m * Vec3{0, 0, 1}), 1e-12)
        << "towards the handle";
    EXPECT_LT(length(rotation(r.pose.rotation) * Vec3{1, 0, 0} - m * Vec3{1, 0, 0}), 1e-12);
    EXPECT_EQ((r.flags & k_button_1) != 0, i % 4 % 2 == 1);
    EXPECT_EQ((r.flags & k_button_2) != 0, i % 4 >= 2);
  }
}

TEST_F(OpenHaptics, ForcesArriveInTheDevicesFrameAndAreCutToItsPeak) {
  StationStylus placed = station();
  placed.placement = touch_kind().placement;
  OpenHapticsStylus stylus(placed);
  ASSERT_TRUE(comes_true([&] { return ready(stylus); })) << text_of(stylus.health().problem);
  const auto arrives = [&](Vec3 sent, Vec3 wanted) {
    return comes_true([&] {
      stylus.send_force(sent);
      return length(hands_.force_n(0) - wanted) < 1e-9;
    });
  };
  EXPECT_TRUE(arrives({0, 0, 1.5}, {0, 1.5, 0})) << "occlusal is up";
  EXPECT_TRUE(arrives({0, 2, 0}, {0, 0, -2})) << "buccal is away";
  EXPECT_EQ(stylus.health().forces_cut, 0);
  EXPECT_TRUE(arrives({12, 0, 16}, {3.2 * 0.6, 3.2 * 0.8, 0})) << "direction kept";
  EXPECT_GT(stylus.health().forces_cut, 0);
  EXPECT_TRUE(arrives({std::nan(""), 1, 1}, {}));
}

TEST_F(OpenHaptics, ForceEndsWhenItIsCutWhenNobodyRenewsItAndAtTheEnd) {
  {
    OpenHapticsStylus stylus(station());
    ASSERT_TRUE(comes_true([&] { return ready(stylus); }));
    const auto pushed = [&] {
      return comes_true([&] {
        stylus.send_force({0, 0, 1});
        return hands_.force_n(0).z == 1.0;
      });
    };
    ASSERT_TRUE(pushed());
    EXPECT_TRUE(comes_true([&] { return hands_.force_n(0).z == 0.0; }))
        << "a servo that fell silent";
    ASSERT_TRUE(pushed());
    stylus.send_force({0, 0, 1});
    stylus.cut_force();
    EXPECT_TRUE(comes_true([&] { return hands_.force_n(0).z == 0.0; }));
    ASSERT_TRUE(pushed());
  }
  EXPECT_EQ(hands_.force_n(0).z, 0.0) << "closed";
}

TEST_F(OpenHaptics, NotCalibratedItGivesNoPlaceAndNoForce) {
  ::setenv("FAKE_HD_CALIBRATION", "manual", 1);
  OpenHapticsStylus stylus(station());
  ASSERT_TRUE(comes_true([&] { return wrong(stylus) == DeviceError::needs_calibration; }))
      << text_of(stylus.health().problem);
  stylus.send_force({0, 0, 1});
  std::this_thread::sleep_for(30ms);
  EXPECT_EQ(hands_.force_n(0).z, 0.0);
  EXPECT_EQ(stylus.read(1e-3).flags & k_stylus_fresh, 0);
  EXPECT_TRUE(std::isnan(stylus.read(1e-3).pose.tip_mm.x));
  hands_.inkwell(0);
  EXPECT_TRUE(comes_true([&] { return ready(stylus); })) << text_of(stylus.health().problem);
}

TEST_F(OpenHaptics, CalibratesItselfWhereTheDeviceCan) {
  ::setenv("FAKE_HD_CALIBRATION", "update", 1);
  OpenHapticsStylus stylus(station());
  EXPECT_TRUE(comes_true([&] { return ready(stylus); })) << text_of(stylus.health().problem);
}

TEST_F(OpenHaptics, LostInTheMiddleItIsNotFreshAndSaysSo) {
  ::setenv("FAKE_HD_ERROR_AFTER_MS", "300", 1);
  OpenHapticsStylus stylus(station());
  const auto fresh = [&] { return (stylus.read(1e-3).flags & k_stylus_fresh) != 0; };
  ASSERT_TRUE(comes_true(fresh));
  ASSERT_TRUE(comes_true([&] { return wrong(stylus) == DeviceError::lost; }))
      << text_of(stylus.health().problem);
  EXPECT_TRUE(comes_true([&] { return !fresh(); }));
  EXPECT_FALSE(ready(stylus));
}

TEST_F(OpenHaptics, TwoDevicesAreTwo) {
  OpenHapticsStylus one(station()), left(station("left"));
  ASSERT_TRUE(comes_true([&] { return ready(one) && ready(left); }))
      << text_of(one.health().problem) << text_of(left.health().problem);
  const double here[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1},
               there[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -7, -8, -9, 1};
  hands_.place(0, here, 0);
  hands_.place(1, there, 0);
  EXPECT_TRUE(comes_true([&] {
    return one.read(1e-3).pose.tip_mm == Vec3{1, 2, 3} &&
           left.read(1e-3).pose.tip_mm == Vec3{-7, -8, -9};
  }));
  EXPECT_TRUE(comes_true([&] {
    one.send_force({1, 0, 0});
    left.send_force({0, 1, 0});
    return hands_.force_n(0) == Vec3{1, 0, 0} && hands_.force_n(1) == Vec3{0, 1, 0};
  }));
  EXPECT_EQ(code_of([] { const OpenHapticsStylus again(station("left")); }), DeviceError::refuses)
      << "one that is in use already";
}

TEST_F(OpenHaptics, ExchangesOnceInEachOfItsFrames) {
  OpenHapticsStylus stylus(station());
  ASSERT_TRUE(comes_true([&] { return stylus.health().readings > 1500; }))
      << text_of(stylus.health().problem);
  const StylusHealth h = stylus.health();
  const long frames = hands_.frames(0);
  EXPECT_LE(h.readings, frames);
  EXPECT_GE(h.readings, frames - 500) << "every frame gives a place";
  std::printf("%.0f exchanges a second, scatter %.3f ms, longest gap %.1f ms\n",
              1 / h.mean_period_s, 1e3 * h.jitter_s, 1e3 * h.longest_gap_s);
}

}  // namespace
}  // namespace cavum
