// Frames of the Falcon against a table written by hand, and streams that are cut and damaged.
#include "engine/device/hardware/falcon_protocol.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

std::string text(const FalconFrame& frame) { return {frame.begin(), frame.end()}; }

/// Not the code's way: digits of hexadecimal numbers, turned round.
FalconFrame answer_frame(const std::array<int, 3>& encoders, int homed, int buttons) {
  FalconFrame f{};
  f[0] = '<';
  std::size_t at = 1;
  for (const int encoder : encoders) {
    char hex[8];
    std::snprintf(hex, sizeof hex, "%04x", static_cast<unsigned>(encoder) & 0xffffu);
    for (int i = 3; i >= 0; --i)
      f[at++] = static_cast<std::uint8_t>('A' + (hex[i] <= '9' ? hex[i] - '0' : hex[i] - 'a' + 10));
  }
  f[13] = static_cast<std::uint8_t>(0x41 + homed * 16 + buttons);
  f[14] = 'A';
  f[15] = '>';
  return f;
}

TEST(FalconProtocol, CommandsAreBitExact) {
  // each nibble is a letter from A = 0 to P = 15, lowest first; 4096 = 0x1000, -4096 = 0xf000, -1 =
  // 0xffff, 1234 = 0x04d2
  const std::vector<std::pair<FalconCommand, std::string>> table{
      {{.motors = {0, 0, 0}, .lights = 0, .homing = false}, "<AAAAAAAAAAAAAA>"},
      {{.motors = {1, 2, 3}, .lights = 0, .homing = true}, "<BAAACAAADAAABA>"},
      {{.motors = {4096, -4096, -1}, .lights = k_falcon_green, .homing = false},
       "<AAABAAAPPPPPCA>"},
      {{.motors = {1234, -1234, 256}, .lights = k_falcon_red, .homing = true}, "<CNEAOCLPAABAJA>"},
      {{.motors = {-2, 16, 4095},
        .lights = k_falcon_red | k_falcon_blue | k_falcon_green,
        .homing = false},
       "<OPPPABAAPPPAOA>"},
  };
  for (const auto& [command, wanted] : table) EXPECT_EQ(text(falcon_frame(command)), wanted);
}

TEST(FalconProtocol, AnswersAreReadHoweverTheyAreCut) {
  std::mt19937_64 random(testing_basics::drawn_seed("FalconProtocol"));
  for (int round = 0; round < 200; ++round) {
    FalconParser parser;
    FalconAnswer wanted, got;
    std::vector<std::uint8_t> stream(random() % 20, 0x55);  // the end of something unknown
    for (int i = 0; i < 5; ++i) {
      std::array<int, 3> encoders{};
      for (std::size_t n = 0; n < 3; ++n)
        encoders[n] = wanted.encoders[n] = static_cast<std::int16_t>(random());
      wanted.homed = static_cast<std::uint8_t>(random() % 8);
      wanted.buttons = static_cast<std::uint8_t>(random() % 16);
      const FalconFrame f = answer_frame(encoders, wanted.homed, wanted.buttons);
      stream.insert(stream.end(), f.begin(), f.end());
    }
    bool found = false;
    for (std::size_t at = 0; at < stream.size();) {
      const std::size_t piece = std::min<std::size_t>(1 + random() % 20, stream.size() - at);
      found = parser.take(std::span(stream).subspan(at, piece), got) || found;
      at += piece;
    }
    EXPECT_TRUE(found);
    EXPECT_EQ(got, wanted);
    EXPECT_EQ(parser.damaged(), 0);
  }
}

TEST(FalconProtocol, DamagedFramesAreGivenUpAndCounted) {
  std::mt19937_64 random(testing_basics::drawn_seed("FalconProtocol"));
  const FalconFrame good = answer_frame({100, -100, 7}, 7, 1);
  for (int round = 0; round < 2000; ++round) {
    FalconFrame wrong = good;
    constexpr std::size_t k_empty = 14;  // nobody knows what it may hold
    const std::size_t at = random() % 16;
    if (at == k_empty) continue;
    do wrong[at] = static_cast<std::uint8_t>(random());
    while (wrong[at] >= 0x41 &&
           wrong[at] <= 0xc0);  // what no frame has inside; other changes are only another frame
    if (wrong == good) continue;
    FalconParser parser;
    FalconAnswer answer;
    EXPECT_FALSE(parser.take(wrong, answer));
    EXPECT_TRUE(parser.take(good, answer)) << "the next one is heard again";
    EXPECT_EQ(answer.encoders[0], 100);
    EXPECT_TRUE(at == 0 || parser.damaged() >= 1);
  }
}

TEST(FalconProtocol, TorquesBecomeCountsAndKeepTheirDirection) {
  const FalconDrive drive;
  bool cut = true;
  // 100 N·mm at the arm are 13.1234 N·mm at the motor, 661.62 counts of 0.019835 N·mm
  EXPECT_EQ(falcon_counts(drive, {100, -100, 0}, cut), (std::array<std::int16_t, 3>{-662, 662, 0}));
  EXPECT_FALSE(cut);
  EXPECT_EQ(falcon_counts(drive, {2000, -1000, 500}, cut),
            (std::array<std::int16_t, 3>{-4096, 2048, -1024}));
  EXPECT_TRUE(cut);
  EXPECT_EQ(falcon_counts(drive, {std::nan(""), 1, 1}, cut),
            (std::array<std::int16_t, 3>{0, 0, 0}));
  const auto angles = falcon_arm_angles(drive, {0, 1280, -640});
  EXPECT_NEAR(angles[0] * 180 / k_pi, 35.0, 1e-12);
  EXPECT_NEAR(angles[1] * 180 / k_pi, 35.0 + 360 / 7.62, 1e-9);
  EXPECT_NEAR(angles[2] * 180 / k_pi, 35.0 - 180 / 7.62, 1e-9);
}

TEST(FalconProtocol, AnEncoderStepMovesTheGripByLessThanTheQuantum) {
  const FalconGeometry g;
  const FalconDrive drive;
  const double step_rad = 2 * k_pi / (drive.encoder_steps * drive.gear);
  double most = 0.0, sum = 0.0;
  int places = 0;
  for (double x = -40; x <= 40; x += 10)
    for (double y = -40; y <= 40; y += 10)
      for (double z = -40; z <= 40; z += 10) {
        if (x * x + y * y + z * z > 1600) continue;
        FalconAngles angles{};
        std::array<Vec3, 3> columns;
        const Vec3 p = k_falcon_middle_mm + Vec3{x, y, z};
        if (!falcon_angles(g, p, angles) || !falcon_jacobian(g, angles, p, columns)) continue;
        for (const Vec3& c : columns) {
          most = std::max(most, length(c) * step_rad);
          sum += length(c) * step_rad / 3;
        }
        ++places;
      }
  std::printf("way of the grip per encoder step: mean %.4f mm, largest %.4f mm, %d places\n",
              sum / places, most, places);
  EXPECT_GT(places, 200);
  EXPECT_LT(most, k_falcon_quantum_mm);
  EXPECT_GT(most, 0.8 * k_falcon_quantum_mm);
}

}  // namespace
}  // namespace cavum
