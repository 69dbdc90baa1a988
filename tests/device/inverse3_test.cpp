// The Inverse3's stylus on the emulated service: places, directions and forces in the right axes
// and units; and no force whenever something is wrong.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <random>

#include "engine/device/hardware/inverse3_stylus.h"
#include "engine/device/hardware/open_stylus.h"
#include "tests/device/inverse3_hands.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

using namespace std::chrono_literals;
using testing_basics::code_of;
using testing_basics::tells;
using testing_basics::text_of;
using testing_device::comes_true;
using testing_device::EmulatedInverse3;
using testing_device::own_frame;
using testing_device::Servo;
using Answer = EmulatedInverse3::Answer;
using Clock = std::chrono::steady_clock;

class Inverse3 : public ::testing::Test {
 protected:
  static bool ready(const Stylus& stylus) { return !stylus.health().problem; }
  static bool fresh(Stylus& stylus) { return (stylus.read(1e-3).flags & k_stylus_fresh) != 0; }
  static bool becomes(const Stylus& stylus, DeviceError wrong) {
    return comes_true([&] { return code_of(stylus.health().problem) == wrong; });
  }
  EmulatedInverse3 service_;
};

TEST_F(Inverse3, PlaceDirectionAndButtonsAreTheDevices) {
  std::mt19937_64 random(testing_basics::drawn_seed("Inverse3"));
  std::normal_distribution<double> n;
  Inverse3Stylus stylus(own_frame(service_));
  EXPECT_EQ(stylus.facts().serial, "049D");
  for (int i = 0; i < 10; ++i) {
    const Vec3 at_m{0.05 * n(random), 0.05 * n(random), 0.05 * n(random)};
    const Quat q = normalized(Quat{n(random), n(random), n(random), n(random)});
    const bool a = i % 2 == 0, b = i % 3 == 0;
    service_.change([&](auto& devices, auto& grips) {
      devices["049D"].position_m = at_m;
      grips["61548"] = {.orientation = q, .a = a, .b = b};
    });
    DeviceReading r;
    ASSERT_TRUE(comes_true([&] {
      r = stylus.read(1e-3);
      return (r.flags & k_stylus_fresh) != 0 && length(r.pose.tip_mm - at_m * 1000.0) < 1e-6;
    })) << text_of(stylus.health().problem);
    const Vec3 handle = rotation(r.pose.rotation) * Vec3{0, 0, 1},
               points = rotation(q) * Vec3{0, 1, 0};
    EXPECT_LT(length(handle + points), 1e-6) << "the handle lies where the grip does not point";
    EXPECT_EQ((r.flags & k_button_1) != 0, a);
    EXPECT_EQ((r.flags & k_button_2) != 0, b);
  }
  EXPECT_TRUE(comes_true([&] { return fresh(stylus); }));
}

TEST_F(Inverse3, TheUsualPlacementIsWhatTheCandidateSees) {
  StationStylus usual = usual_station_stylus(inverse3_kind());
  usual.settings["port"] = static_cast<double>(service_.port());
  Inverse3Stylus stylus(usual);
  const auto tip = [&](Vec3 at_m) {
    service_.move_to(at_m);
    static_cast<void>(
        comes_true([&, n = stylus.health().readings] { return stylus.health().readings > n + 5; }));
    return stylus.read(1e-3).pose.tip_mm;
  };
  const Vec3 middle_m{0, -0.12, 0.15};
  EXPECT_LT(length(tip(middle_m)), 1e-9) << "the crown's middle";
  EXPECT_LT(length(tip(middle_m + Vec3{0.01, 0, 0}) - Vec3{10, 0, 0}), 1e-9) << "right is mesial";
  EXPECT_LT(length(tip(middle_m + Vec3{0, 0.01, 0}) - Vec3{0, 10, 0}), 1e-9) << "away is buccal";
  EXPECT_LT(length(tip(middle_m + Vec3{0, 0, 0.01}) - Vec3{0, 0, 10}), 1e-9) << "up is occlusal";
}

TEST_F(Inverse3, ForcesArriveInItsAxesAndInTheFormOfItsVersion) {
  StationStylus turned_by_90 = own_frame(service_);
  turned_by_90.placement.rotation =
      rotation_of({0, 1, 0}, {-1, 0, 0}, {0, 0, 1});  // its x is the tooth's y
  {
    Inverse3Stylus stylus(turned_by_90);
    const Servo servo(stylus, {1.0, 2.0, -0.5});
    EXPECT_TRUE(comes_true([&] {
      return length(service_.force_n() - Vec3{2.0, -1.0, -0.5}) < 1e-3;
    })) << text_of(stylus.health().problem);
    EXPECT_EQ(service_.told().name, "vector");
  }
  EmulatedInverse3 older(false);
  Inverse3Stylus stylus(own_frame(older));
  const Servo servo(stylus, {0.25, 0, 0});
  EXPECT_TRUE(comes_true([&] { return older.force_n().x == 0.25; }));
  EXPECT_EQ(older.told().name, "values");
  EXPECT_EQ(older.commands_that_were_none() + service_.commands_that_were_none(), 0);
}

TEST_F(Inverse3, AForceThatNobodyRenewsIsLetGo) {
  Inverse3Stylus stylus(own_frame(service_));
  {
    const Servo servo(stylus, {1, 0, 0});
    ASSERT_TRUE(comes_true([&] { return service_.force_n().x == 1.0; }));
  }
  EXPECT_TRUE(comes_true([&] { return length(service_.force_n()) == 0.0; }));
  EXPECT_TRUE(comes_true([&] { return fresh(stylus); })) << "while the line goes on";
  stylus.send_force({1, 0, 0});
  stylus.cut_force();
  EXPECT_FALSE(comes_true([&] { return length(service_.force_n()) > 0; }, 50ms));
}

TEST_F(Inverse3, TooLargeForcesKeepTheirDirectionAndNoNumberIsNoForce) {
  Inverse3Stylus stylus(own_frame(service_));
  {
    const Servo servo(stylus, {30, 0, -40});
    ASSERT_TRUE(comes_true([&] { return length(service_.force_n()) > 0; }));
    const double peak_n = stylus.facts().peak_n;
    EXPECT_LT(length(service_.force_n() - Vec3{0.6, 0, -0.8} * peak_n), 1e-3);
    EXPECT_GT(stylus.health().forces_cut, 0);
  }
  const Servo servo(stylus, {std::nan(""), 0, 1});
  EXPECT_TRUE(comes_true([&] { return length(service_.force_n()) == 0.0; }));
}

TEST_F(Inverse3, AtTheEndNoForceIsLeft) {
  {
    Inverse3Stylus stylus(own_frame(service_));
    const Servo servo(stylus, {1, 0, 0});
    ASSERT_TRUE(comes_true([&] { return service_.force_n().x == 1.0; }));
  }
  EXPECT_EQ(length(service_.force_n()), 0.0);
  EXPECT_TRUE(comes_true([&] { return service_.lines() == 0; }));
}

TEST_F(Inverse3, ASilenceOf100msIsAnsweredWithNoForceAndWhenItSpeaksAgainItIsTaken) {
  Inverse3Stylus stylus(own_frame(service_));
  const Servo servo(stylus, {1, 0, 0});
  ASSERT_TRUE(comes_true([&] { return service_.force_n().x == 1.0; }));
  const auto silent_from = Clock::now();
  service_.answer_with(Answer::nothing);
  ASSERT_TRUE(comes_true([&] { return length(service_.force_n()) == 0.0; }));
  const auto after = service_.told().since - silent_from;
  EXPECT_GE(after, 95ms) << "not at the first late answer";
  EXPECT_LE(after, 600ms) << "100 ms, on a computer that has other work";
  EXPECT_TRUE(comes_true([&] { return !fresh(stylus); }));
  EXPECT_TRUE(becomes(stylus, DeviceError::silent));
  EXPECT_EQ(stylus.health().unplugged, 1);
  service_.answer_with(Answer::state);
  EXPECT_TRUE(comes_true([&] {
    return ready(stylus) && fresh(stylus) && service_.force_n().x == 1.0;
  })) << text_of(stylus.health().problem);
}

TEST_F(Inverse3, WhatIsNoMessageEndsInNoForceAndIsGotOver) {
  for (const auto answer :
       {Answer::no_json, Answer::cut_short, Answer::another_json, Answer::too_large,
        Answer::too_deep, Answer::bytes, Answer::far_away, Answer::half}) {
    const auto which = static_cast<int>(answer);
    Inverse3Stylus stylus(own_frame(service_));
    const Servo servo(stylus, {1, 0, 0});
    ASSERT_TRUE(comes_true([&] { return service_.force_n().x == 1.0; })) << which;
    service_.answer_with(answer);
    EXPECT_TRUE(becomes(
        stylus, answer == Answer::half ? DeviceError::silent : DeviceError::malformed_message))
        << which << ": " << text_of(stylus.health().problem);
    EXPECT_TRUE(comes_true([&] { return length(service_.force_n()) == 0.0; })) << which;
    EXPECT_TRUE(comes_true([&] { return !fresh(stylus); })) << which;
    service_.answer_with(Answer::state);
    EXPECT_TRUE(comes_true([&] {
      return ready(stylus) && fresh(stylus) && service_.force_n().x == 1.0;
    })) << which
        << ": " << text_of(stylus.health().problem);
  }
}

TEST_F(Inverse3, AMessageInTwoPartsIsOneMessage) {
  service_.answer_with(Answer::in_two_parts);
  Inverse3Stylus stylus(own_frame(service_));
  service_.move_to({0.02, 0, 0});
  EXPECT_TRUE(comes_true([&] { return std::fabs(stylus.read(1e-3).pose.tip_mm.x - 20.0) < 1e-9; }))
      << text_of(stylus.health().problem);
  EXPECT_EQ(stylus.health().unplugged, 0);
}

TEST_F(Inverse3, ALineThatIsCutAndAServiceThatIsBegunAgainAreTakenUp) {
  Inverse3Stylus stylus(own_frame(service_));
  const Servo servo(stylus, {1, 0, 0});
  ASSERT_TRUE(comes_true([&] { return service_.force_n().x == 1.0; }));
  service_.cut();
  ASSERT_TRUE(comes_true([&] { return stylus.health().unplugged == 1; }));
  ASSERT_TRUE(
      comes_true([&] { return stylus.health().plugged_in == 2 && service_.force_n().x == 1.0; }));
  service_.stop();
  EXPECT_TRUE(becomes(stylus, DeviceError::no_service)) << text_of(stylus.health().problem);
  EXPECT_TRUE(comes_true([&] { return !fresh(stylus); }));
  service_.start();
  EXPECT_TRUE(
      comes_true([&] { return ready(stylus) && fresh(stylus) && service_.force_n().x == 1.0; }));
  EXPECT_EQ(stylus.health().plugged_in, 3);
}

TEST_F(Inverse3, OfTwoDevicesOneIsChosenAndBothCanBeOpen) {
  service_.change([](auto& devices, auto& grips) {
    devices["AAAA"].position_m = {0.03, 0, 0};
    grips["70000"].wired = true;
  });
  {
    const Inverse3Stylus any(own_frame(service_));
    EXPECT_TRUE(becomes(any, DeviceError::several)) << text_of(any.health().problem);
    for (const char* there : {"049D", "AAAA"})
      EXPECT_TRUE(tells(any.health().problem, there)) << text_of(any.health().problem);
    const Inverse3Stylus other(own_frame(service_, "BBBB"));
    EXPECT_TRUE(becomes(other, DeviceError::not_there)) << text_of(other.health().problem);
    const Inverse3Stylus no_grip(own_frame(service_, "AAAA"));
    EXPECT_TRUE(becomes(no_grip, DeviceError::several)) << text_of(no_grip.health().problem);
  }
  Inverse3Stylus left(own_frame(service_, "049D", "61548")),
      right(own_frame(service_, "AAAA", "70000"));
  EXPECT_TRUE(comes_true([&] {
    return std::fabs(right.read(1e-3).pose.tip_mm.x - 30.0) < 1e-9 &&
           left.read(1e-3).pose.tip_mm.x == 0.0;
  }));
  const Servo left_servo(left, {1, 0, 0}), right_servo(right, {0, 2, 0});
  EXPECT_TRUE(comes_true([&] {
    return service_.force_n("049D") == (Vec3{1, 0, 0}) &&
           service_.force_n("AAAA") == (Vec3{0, 2, 0});
  }));
}

TEST_F(Inverse3, WithoutPowerCalibrationGripOrDeviceThereIsNoForceAndItSaysWhy) {
  using Change = std::function<void(std::map<std::string, EmulatedInverse3::Device>&,
                                    std::map<std::string, EmulatedInverse3::Grip>&)>;
  const std::vector<std::pair<Change, DeviceError>> wrongs{
      {[](auto& d, auto&) { d["049D"].powered = false; }, DeviceError::no_power},
      {[](auto& d, auto&) { d["049D"].calibrated = false; }, DeviceError::needs_calibration},
      {[](auto&, auto& g) { g.clear(); }, DeviceError::not_there},
      {[](auto&, auto& g) {
         g["61548"].orientation = {0, 0, 0, 0};
       },
       DeviceError::no_direction},
      {[](auto& d, auto&) { d.clear(); }, DeviceError::not_there}};
  for (const auto& [wrong, problem] : wrongs) {
    const auto which = static_cast<int>(problem);
    Inverse3Stylus stylus(own_frame(service_));
    const Servo servo(stylus, {1, 0, 0});
    ASSERT_TRUE(comes_true([&] { return service_.force_n().x == 1.0; })) << which;
    service_.change(wrong);
    EXPECT_TRUE(becomes(stylus, problem)) << which << ": " << text_of(stylus.health().problem);
    EXPECT_TRUE(comes_true([&] { return length(service_.force_n()) == 0.0; })) << which;
    EXPECT_TRUE(comes_true([&] { return !fresh(stylus); })) << which;
    service_.change([](auto& devices, auto& grips) {
      devices = {{"049D", {}}};
      grips = {{"61548", {}}};
    });
    EXPECT_TRUE(comes_true([&] { return ready(stylus) && service_.force_n().x == 1.0; }))
        << which << ": " << text_of(stylus.health().problem);
  }
}

TEST_F(Inverse3, WithNoGripTheHandpieceIsHeldAsThePlacementSays) {
  service_.change([](auto&, auto& grips) { grips.clear(); });
  StationStylus station = own_frame(service_, "", "none");
  station.placement.tool = rotation_of({1, 0, 0}, {0, 0, 1}, {0, -1, 0});
  Inverse3Stylus stylus(station);
  EXPECT_FALSE(stylus.facts().measures_direction);
  ASSERT_TRUE(comes_true([&] { return fresh(stylus); })) << text_of(stylus.health().problem);
  EXPECT_LT(length(rotation(stylus.read(1e-3).pose.rotation) * Vec3{0, 0, 1} - Vec3{0, -1, 0}),
            1e-12);
}

TEST_F(Inverse3, ALookFindsItOrSaysWhy) {
  const StylusKind kind = inverse3_kind();
  const StylusLook found = kind.look(own_frame(service_), true);
  EXPECT_TRUE(found.there);
  EXPECT_FALSE(found.problem) << text_of(found.problem);
  EXPECT_EQ(kind.serial(own_frame(service_)), "049D");
  service_.answer_with(Answer::nothing);
  EXPECT_EQ(code_of(kind.look(own_frame(service_), true).problem), DeviceError::silent);
  service_.stop();
  const StylusLook none = kind.look(own_frame(service_), true);
  EXPECT_FALSE(none.there);
  EXPECT_EQ(code_of(none.problem), DeviceError::no_service) << text_of(none.problem);
  EXPECT_EQ(kind.serial(own_frame(service_, "049D")), "049D")
      << "the one that the station has chosen";
}

}  // namespace
}  // namespace cavum
