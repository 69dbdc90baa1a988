// Placements against rotations made otherwise, and marks that a placement was applied to.
#include "engine/device/placement.h"

#include <gtest/gtest.h>

#include <random>

#include "engine/device/device_error.h"
#include "engine/device/hardware/stylus_kind.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

using testing_basics::code_of;
using testing_basics::drawn_seed;

Quat drawn_rotation(std::mt19937_64& random) {
  std::normal_distribution<double> n;
  return normalized(Quat{n(random), n(random), n(random), n(random)});
}

const StylusKind& kind(const std::string& id) {
  return stylus_kinds().at(id, {}, {StylusHand::person});
}

TEST(Placement, FitFindsWhereTheMarksWere) {
  std::mt19937_64 random(drawn_seed("Placement"));
  std::uniform_real_distribution<double> place(-30, 30);
  for (int round = 0; round < 200; ++round) {
    const Placement truth{
        drawn_rotation(random), {place(random), place(random), place(random)}, {}};
    std::vector<Vec3> device, tooth;
    for (int i = 0; i < 4; ++i) {
      device.push_back({place(random), place(random), place(random)});
      tooth.push_back(to_tooth(truth, device.back()).tip_mm);
    }
    PlacementFit fit;
    if (code_of([&] { fit = fit_placement(device, tooth); })) continue;  // drawn on a line
    EXPECT_LT(fit.worst_mm, 1e-9);
    const Vec3 p{place(random), place(random), place(random)};
    EXPECT_LT(length(to_tooth(fit.placement, p).tip_mm - to_tooth(truth, p).tip_mm), 1e-7);
    EXPECT_NEAR(
        dot(force_to_device(fit.placement, {1, 2, 3}), force_to_device(fit.placement, {1, 2, 3})),
        14.0, 1e-9)
        << "forces keep their size";
  }
}

TEST(Placement, UnsteadyMarksLeaveWhatTheyScatter) {
  std::mt19937_64 random(drawn_seed("Placement"));
  std::normal_distribution<double> noise(0, 0.2);
  const Placement truth{drawn_rotation(random), {5, -3, 8}, {}};
  std::vector<Vec3> device, tooth;
  for (const Vec3 p : {Vec3{0, 0, 0}, Vec3{20, 0, 0}, Vec3{0, 20, 0}, Vec3{0, 0, 20}}) {
    tooth.push_back(to_tooth(truth, p).tip_mm);
    device.push_back(p + Vec3{noise(random), noise(random), noise(random)});
  }
  const PlacementFit fit = fit_placement(device, tooth);
  EXPECT_GT(fit.rms_mm, 0.0);
  EXPECT_LT(fit.worst_mm, 1.5);
  // least squares: any small turn or shift leaves more
  const auto left = [&](const Placement& p) {
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i)
      sum +=
          dot(to_tooth(p, device[i]).tip_mm - tooth[i], to_tooth(p, device[i]).tip_mm - tooth[i]);
    return sum;
  };
  const double best = left(fit.placement);
  for (int i = 0; i < 100; ++i) {
    Placement other = fit.placement;
    other.rotation = normalized(turned(
        other.rotation, Quat{1, 0.01 * noise(random), 0.01 * noise(random), 0.01 * noise(random)}));
    other.offset_mm += Vec3{noise(random), noise(random), noise(random)} * 0.1;
    EXPECT_GE(left(other), best);
  }
}

TEST(Placement, MarksThatSayNothingAreRefused) {
  EXPECT_EQ(code_of([] {
              static_cast<void>(fit_placement({{0, 0, 0}, {10, 0, 0}}, {{0, 0, 0}, {10, 0, 0}}));
            }),
            DeviceError::unequal_marks);
  const std::vector<Vec3> line{{0, 0, 0}, {10, 0, 0}, {20, 0, 0}, {30, 0.5, 0}},
      plane{{0, 0, 0}, {20, 0, 0}, {0, 20, 0}, {0, 0, 20}};
  EXPECT_EQ(code_of([&] { static_cast<void>(fit_placement(line, plane)); }),
            DeviceError::marks_in_line);
  EXPECT_EQ(code_of([&] {
              static_cast<void>(fit_placement({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, plane));
            }),
            DeviceError::marks_in_line);
}

TEST(Placement, RotationsFollowTheirMatrices) {
  std::mt19937_64 random(drawn_seed("Placement"));
  for (int i = 0; i < 500; ++i) {
    const Quat a = drawn_rotation(random), b = drawn_rotation(random);
    const Vec3 v{1, -2, 3};
    EXPECT_LT(length(rotation(turned(a, b)) * v - rotation(b) * (rotation(a) * v)), 1e-12);
    const Mat3 m = rotation(a);
    const Quat again = rotation_of(m * Vec3{1, 0, 0}, m * Vec3{0, 1, 0}, m * Vec3{0, 0, 1});
    EXPECT_LT(length(rotation(again) * v - m * v), 1e-12);
  }
}

TEST(StationStylus, IsReadAsItWasWritten) {
  std::mt19937_64 random(drawn_seed("StationStylus"));
  const StylusKind& falcon = kind("falcon");
  StationStylus s = usual_station_stylus(falcon);
  s.placement = {drawn_rotation(random), {1.25, -3, 77}, drawn_rotation(random)};
  s.settings["firmware"] = "/home/a \"b\"/nvent_firmware.bin";
  s.settings["arm_offset_deg"] = 41.5;
  const StationStylus read = parse_station_stylus(to_toml(s), "stylus.toml", falcon);
  EXPECT_EQ(read.placement.offset_mm, s.placement.offset_mm);
  EXPECT_NEAR(read.placement.rotation.x, s.placement.rotation.x, 1e-15);
  EXPECT_NEAR(read.placement.tool.z, s.placement.tool.z, 1e-15);
  EXPECT_EQ(read.settings, s.settings);
  EXPECT_EQ(read.number("arm_offset_deg"), 41.5);
  EXPECT_EQ(code_of([&] { static_cast<void>(read.text("library")); }), DeviceError::not_a_setting)
      << "a setting of another stylus";
  EXPECT_EQ(code_of([&] { static_cast<void>(read.text("arm_offset_deg")); }),
            DeviceError::not_a_setting)
      << "a number, not a text";
}

TEST(StationStylus, WrongFilesAreRefused) {
  const std::string good = to_toml(usual_station_stylus(kind("falcon")));
  for (const auto& [from, to] : {std::pair{"rotation", "turning"},
                                 {"offset_mm = [", "offset_mm = [1, "},
                                 {"tool = [1", "tool = [0"},
                                 {"tool = [1", "tool = [\"1\""},
                                 {"arm_offset_deg = 35", "arm_offset_deg = 135"},
                                 {"offset_mm = [0", "offset_mm = [2000"}}) {
    std::string wrong = good;
    ASSERT_NE(wrong.find(from), std::string::npos) << from << "\n" << good;
    wrong.replace(wrong.find(from), std::string(from).size(), to);
    EXPECT_THROW(static_cast<void>(parse_station_stylus(wrong, "stylus.toml", kind("falcon"))),
                 Error)
        << wrong;
  }
}

TEST(StationStylus, UsualPlaceHasTheMiddleAtTheCrownAndUpIsUp) {
  const Placement p = usual_station_stylus(kind("falcon")).placement;
  EXPECT_LT(length(to_tooth(p, {0, 0, 120}).tip_mm), 1e-9);
  EXPECT_LT(length(to_tooth(p, {0, 10, 120}).tip_mm - Vec3{0, 0, 10}), 1e-9) << "up is occlusal";
  EXPECT_LT(length(to_tooth(p, {10, 0, 120}).tip_mm - Vec3{10, 0, 0}), 1e-9) << "right is mesial";
}

}  // namespace
}  // namespace cavum
