#include "engine/device/motion_file.h"

#include <gtest/gtest.h>

#include "engine/base/det_math.h"
#include "engine/base/file_error.h"
#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

const std::string k_header = "t_s,x_mm,y_mm,z_mm,qw,qx,qy,qz,pedal\n";

std::optional<Error> error_in(const std::string& text) {
  try {
    (void)parse_motion(text, "m.csv");
  } catch (const Error& e) {
    return e;
  }
  return {};
}
void expect_error(const std::string& text, int line, ErrorCode code) {
  const auto error = error_in(text);
  ASSERT_TRUE(error) << text;
  EXPECT_EQ(error->code(), code) << error->what();
  ASSERT_TRUE(error->file_place()) << error->what();
  EXPECT_EQ(error->file_place()->file, "m.csv");
  EXPECT_EQ(error->file_place()->line, line) << error->what();
}

TEST(MotionFile, ReadsColumnsInAnyOrderWithBurButtonsAndComments) {
  const Motion m = parse_motion(
      "# made by hand\r\n# bur = round-1.0\r\n\r\npedal,bur,b2,b1,qz,qy,qx,qw,z_mm,y_mm,x_mm,t_s\r\n"
      "0.5,2,1,0,0,0,0,1,3,2,1,10\r\n"
      " 1 , 0, 0, 1, 0,0,0,-1, 6,4,2, 10.5\r\n",
      "m.csv");
  EXPECT_EQ(m.bur, "round-1.0");
  ASSERT_EQ(m.samples.size(), 2u);
  EXPECT_EQ(m.samples[0].pose.tip_mm, (Vec3{1, 2, 3}));
  EXPECT_EQ(m.samples[0].pedal, 0.5);
  EXPECT_EQ(m.samples[0].bur, 2);
  EXPECT_FALSE(m.samples[0].button_1);
  EXPECT_TRUE(m.samples[0].button_2);
  EXPECT_TRUE(m.samples[1].button_1);
  EXPECT_DOUBLE_EQ(m.duration_s(), 0.5);
}

TEST(MotionFile, EveryFaultIsAnErrorWithItsLine) {
  const std::string good = "0,0,0,0,1,0,0,0,0\n1,1,0,0,1,0,0,0,0\n";
  ASSERT_FALSE(error_in(k_header + good));
  expect_error("# c\nt_s,x_mm,y_mm,z_mm,qw,qx,qy,qz\n" + good, 2, MotionError::column_missing);
  expect_error("t_s,x_mm,y_mm,z_mm,qw,qx,qy,qz,pedal,colour\n" + good, 1,
               MotionError::unknown_column);
  expect_error("t_s,x_mm,y_mm,z_mm,qw,qx,qy,qz,pedal,x_mm\n" + good, 1, MotionError::column_twice);
  expect_error("t_s,x_m,y_mm,z_mm,qw,qx,qy,qz,pedal\n" + good, 1, MotionError::column_unit);
  expect_error("t_ms,x_mm,y_mm,z_mm,qw,qx,qy,qz,pedal\n" + good, 1, MotionError::column_unit);
  expect_error(good, 1, MotionError::unknown_column);  // no header at all
  expect_error(k_header + good + "\n# c\n2,nan,0,0,1,0,0,0,0\n", 6, MotionError::not_finite);
  expect_error(k_header + good + "2,0,0,inf,1,0,0,0,0\n", 4, MotionError::not_finite);
  expect_error(k_header + good + "2,0,0,0,1,0,0,nan,0\n", 4, MotionError::not_finite);
  expect_error(k_header + good + "nan,0,0,0,1,0,0,0,0\n", 4, MotionError::not_finite);
  expect_error(k_header + good + "2,0,0,0,1,0,0,0,nan\n", 4, MotionError::not_finite);
  expect_error(k_header + good + "2,0,0,0,1,0,0,0,1.01\n", 4, MotionError::pedal);
  expect_error(k_header + good + "2,0,0,0,1,0,0,0,-0.01\n", 4, MotionError::pedal);
  expect_error(k_header + good + "1,0,0,0,1,0,0,0,0\n", 4, MotionError::time_order);
  expect_error(k_header + good + "0.5,0,0,0,1,0,0,0,0\n", 4, MotionError::time_order);
  expect_error(k_header + "-0.5,0,0,0,1,0,0,0,0\n" + good, 2, MotionError::time);
  expect_error(k_header + good + "1e12,0,0,0,1,0,0,0,0\n", 4, MotionError::time);
  expect_error(k_header + good + "90000,0,0,0,1,0,0,0,0\n", 4, MotionError::too_long);
  expect_error(k_header + good + "2,0,0,0,0,0,0,0,0\n", 4, MotionError::rotation);
  expect_error(k_header + good + "2,0,0,0,3,0,0,0,0\n", 4, MotionError::rotation);
  expect_error(k_header + good + "2,0,0,0,1,0,0,0\n", 4, FileError::inconsistent);
  expect_error(k_header + good + "2,0,0,0,1,0,0,0,0,0\n", 4, FileError::inconsistent);
  expect_error(k_header + good + "2,0,0,zero,1,0,0,0,0\n", 4, MotionError::not_a_number);
  expect_error(k_header + good + "2,0,,0,1,0,0,0,0\n", 4, MotionError::not_a_number);
  expect_error(k_header + good + "2,\"0\",0,0,1,0,0,0,0\n", 4, MotionError::not_a_number);
  expect_error(k_header + good + "2,0,0,501,1,0,0,0,0\n", 4, MotionError::too_far);
  for (const char* bur : {"0.5", "256", "-2"})
    expect_error(
        "t_s,x_mm,y_mm,z_mm,qw,qx,qy,qz,pedal,bur\n0,0,0,0,1,0,0,0,0,0\n1,1,0,0,1,0,0,0,0," +
            std::string(bur) + "\n",
        3, MotionError::bur);
}

TEST(MotionFile, ReadsWhatSpreadsheetsWriteOnEverySystem) {
  for (const std::string end : {"\n", "\r\n", "\r"})
    for (const std::string mark : {"", "\xef\xbb\xbf"}) {
      const std::string rows = k_header.substr(0, k_header.size() - 1) + end + "0,0,0,0,1,0,0,0,0" +
                               end + "1,1,0,0,1,0,0,0,0" + end;
      ASSERT_FALSE(error_in(mark + rows));
      EXPECT_EQ(parse_motion(mark + "# bur = round-1.0" + end + rows, "m.csv").bur, "round-1.0");
      expect_error(mark + rows + end + "2,nan,0,0,1,0,0,0,0" + end, 5, MotionError::not_finite);
    }
}

TEST(MotionFile, AClockThatDoesNotBeginAtZeroIsAccepted) {
  const Motion m =
      parse_motion(k_header + "1795238400,0,0,0,1,0,0,0,0\n1795238402,4,0,0,1,0,0,0,0\n", "m.csv");
  EXPECT_DOUBLE_EQ(m.duration_s(), 2);
  EXPECT_NEAR(m.at(1).pose.tip_mm.x, 2, 1e-6);
}

TEST(MotionFile, FaultsOfTheWholeFileAreFound) {
  EXPECT_EQ(code_of(error_in("")), MotionError::too_short);
  EXPECT_EQ(code_of(error_in(k_header + "0,0,0,0,1,0,0,0,0\n")), MotionError::too_short);
  // a way of 10 mm written in metres
  EXPECT_EQ(code_of(error_in(k_header + "0,0,0,0,1,0,0,0,0\n1,0.01,0,0,1,0,0,0,0\n")),
            MotionError::in_metres);
  EXPECT_FALSE(error_in(k_header + "0,5,0,0,1,0,0,0,0\n1,5,0,0,1,0,0,0,1\n"))
      << "standing still is no fault";
}

TEST(MotionFile, NoTruncationOrOddByteCrashesTheReader) {
  Random random(drawn_seed("MotionFile.NoTruncationOrOddByteCrashesTheReader"));
  const std::string good =
      "# bur = round-1.0\n" + k_header + "0,0.5,-1e-3,0,1,0,0,0,0\n1,1,0,0,1,0,0,0,0.25\n";
  for (std::size_t n = 0; n < good.size(); ++n) (void)error_in(good.substr(0, n));
  for (int i = 0; i < 3000; ++i) {
    std::string bad = good;
    for (auto n = 1 + random.below(3); n > 0; --n)
      bad[random.below(bad.size())] = static_cast<char>(random.below(256));
    (void)error_in(bad);
  }
}

TEST(MotionFile, ButtonsAreZeroOrOneAndABurIsNamedOrNumbered) {
  const std::string header = "t_s,x_mm,y_mm,z_mm,qw,qx,qy,qz,pedal,b1,b2,bur\n",
                    second = "1,1,0,0,1,0,0,0,0,0,0,0\n";
  EXPECT_FALSE(error_in(header + "0,0,0,0,1,0,0,0,0,0,0,0\n" + second));
  for (const auto& [bad, code] : {std::pair{"7,0,0", MotionError::button},
                                  {"0,-1,0", MotionError::button},
                                  {"0.5,0,0", MotionError::button},
                                  {"0,0,-1", MotionError::bur},
                                  {"0,0,", MotionError::not_a_number},
                                  {"0,0,256", MotionError::bur},
                                  {"0,0,0.5", MotionError::bur}})
    expect_error(header + "0,0,0,0,1,0,0,0,0," + bad + "\n" + second, 2, code);
  EXPECT_EQ(code_of(error_in("# bur =\n" + k_header + "0,0,0,0,1,0,0,0,0\n1,1,0,0,1,0,0,0,0\n")),
            MotionError::setting)
      << "not silently the first bur";
}

TEST(MotionFile, PlaysLinearlyBetweenRowsAndHoldsTheEnds) {
  const Motion m = parse_motion(
      k_header + "5,0,0,0,1,0,0,0,0\n7,4,-2,1,1,0,0,0,1\n8,4,-2,1,1,0,0,0,0.5\n", "m.csv");
  const MotionSample half = m.at(0.5);
  EXPECT_LE(length(half.pose.tip_mm - Vec3{1, -0.5, 0.25}), 1e-12);
  EXPECT_NEAR(half.pedal, 0.25, 1e-12);
  EXPECT_NEAR(m.at(2.5).pedal, 0.75, 1e-12);
  EXPECT_EQ(m.at(-1).pose.tip_mm, (Vec3{0, 0, 0}));
  EXPECT_EQ(m.at(99).pose.tip_mm, (Vec3{4, -2, 1}));
  EXPECT_EQ(m.at(99).pedal, 0.5);
  EXPECT_EQ(m.at(2).pose.tip_mm, (Vec3{4, -2, 1})) << "a row itself is met exactly";
}

TEST(MotionFile, TurnsTheShorterWayRound) {
  // q and -q are one rotation: a quarter turn about x, written with the other sign, passes through
  // an eighth
  const double h = std::sqrt(0.5);
  const Motion m = parse_motion(k_header + "0,0,0,0,1,0,0,0,0\n1,1,0,0," + std::to_string(-h) +
                                    "," + std::to_string(-h) + ",0,0,0\n",
                                "m.csv");
  const Vec3 turned = rotation(m.at(0.5).pose.rotation) * Vec3{0, 1, 0};
  EXPECT_LE(length(turned - Vec3{0, std::cos(k_pi / 4), std::sin(k_pi / 4)}), 1e-6);
}

TEST(MotionFile, ButtonsAndBurHoldUntilTheNextRow) {
  const Motion m = parse_motion(
      "t_s,x_mm,y_mm,z_mm,qw,qx,qy,qz,pedal,b1,b2,bur\n0,0,0,0,1,0,0,0,0,1,0,3\n1,1,0,0,1,0,0,0,0,0,1,4\n",
      "m.csv");
  EXPECT_TRUE(m.at(0.999).button_1);
  EXPECT_EQ(m.at(0.999).bur, 3);
  EXPECT_FALSE(m.at(1.0).button_1);
  EXPECT_TRUE(m.at(1.0).button_2);
  EXPECT_EQ(m.at(1.0).bur, 4);
  EXPECT_EQ(parse_motion(k_header + "0,0,0,0,1,0,0,0,0\n1,1,0,0,1,0,0,0,0\n", "m.csv").at(0).bur,
            -1);
}

TEST(MotionFile, SaysTheStepOfTheEncoder) {
  const std::string rows = k_header + "0,0,0,0,1,0,0,0,0\n1,1,0,0,1,0,0,0,0\n";
  EXPECT_EQ(parse_motion("# position_quantum_mm = 0.055\n" + rows, "m.csv").position_quantum_mm,
            0.055);
  EXPECT_EQ(parse_motion(rows, "m.csv").position_quantum_mm, 0.0);
  EXPECT_EQ(motion_quantum_mm("# made by hand\n# position_quantum_mm = 0.01\n" + rows, "m.csv"),
            0.01);
  for (const char* wrong : {"-0.01", "2", "nan", "0.055 mm", ""})
    EXPECT_EQ(code_of(error_in(std::string("# position_quantum_mm = ") + wrong + "\n" + rows)),
              MotionError::setting)
        << wrong;
}

TEST(MotionFile, GivesTheInputsOfAnExamAgainToTheLastBit) {
  Random random(11);
  std::vector<TickInput> inputs;
  TickInput before;
  for (int i = 0; i < 5000; ++i) {
    const Quat q =
        normalized(Quat{random.normal(), random.normal(), random.normal(), random.normal()});
    const Vec3 tip{3.0 * random.normal(), 0.055 * std::floor(20 * random.normal()), -1e-6 * i};
    auto flags = static_cast<std::uint16_t>(k_stylus_fresh | k_pedal_fresh);
    if (i % 7 == 3) flags |= k_button_1;
    if (i % 11 == 5) flags |= k_button_2;
    before = make_tick_input({tip, q}, random.uniform(), flags, static_cast<std::uint8_t>(i / 1000),
                             before);
    inputs.push_back(before);
  }
  const Motion motion =
      parse_motion(motion_text(inputs, {-2.35, 0.25, 1.200001}, 0.055, "s.cavum"), "m.csv");
  EXPECT_EQ(motion.position_quantum_mm, 0.055);
  EXPECT_EQ(motion.first_tip_mm, (Vec3{-2.35, 0.25, 1.200001}));
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const MotionSample s = motion.at(static_cast<double>(i) * k_tick_s);
    std::uint16_t flags = k_stylus_fresh | k_pedal_fresh;
    if (s.button_1) flags |= k_button_1;
    if (s.button_2) flags |= k_button_2;
    ASSERT_EQ(make_tick_input(s.pose, s.pedal, flags, static_cast<std::uint8_t>(s.bur), {}),
              inputs[i])
        << i;
  }
}

TEST(MotionFile, RefusesAFirstTipThatIsNoPlace) {
  const std::string rows = k_header + "0,0,0,0,1,0,0,0,0\n1,1,0,0,1,0,0,0,0\n";
  for (const char* wrong : {"1 2", "1 2 3 4", "1 2 nan", "1 2 600", "", "a b c"})
    EXPECT_EQ(code_of(error_in(std::string("# first_tip_mm = ") + wrong + "\n" + rows)),
              MotionError::setting)
        << wrong;
}

TEST(MotionFile, CannotSayThatADeviceGaveNothing) {
  std::vector<TickInput> inputs(3, make_tick_input({}, 0.5, k_stylus_fresh | k_pedal_fresh, 0, {}));
  inputs[1].flags = k_pedal_fresh;
  EXPECT_EQ(code_of([&] { (void)motion_text(inputs, {}, 0.0, "s.cavum"); }),
            MotionError::no_reading);
}

}  // namespace
}  // namespace cavum
