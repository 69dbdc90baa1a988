// The self-check on a free arm inside the emulated Falcon: encoders through its kinematics, motors
// through its gears, libusb between.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "engine/device/hardware/falcon_protocol.h"
#include "tests/device/emulated_falcon.h"
#include "tests/device/emulated_pedal.h"
#include "tests/device/learnt_checks.h"
#include "tests/device/moving_arm.h"
#include "tests/device/program.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

using nlohmann::json;
using testing_device::EmulatedFalcon;
using testing_device::MovingArm;

/// The force on the grip that these motors give where it stands: J^T F = torques, solved for F.
Vec3 force_of(const std::vector<std::int16_t>& motors, Vec3 at_mm) {
  if (motors.size() != 3) return {};
  FalconAngles angles{};
  std::array<Vec3, 3> j;
  if (!falcon_angles({}, at_mm, angles) || !falcon_jacobian({}, angles, at_mm, j)) return {};
  const FalconDrive drive;
  std::array<double, 3> t{};
  for (std::size_t i = 0; i < 3; ++i) t[i] = -1e3 * motors[i] * drive.gear * drive.nm_per_count;
  return (cross(j[1], j[2]) * t[0] + cross(j[2], j[0]) * t[1] + cross(j[0], j[1]) * t[2]) /
         dot(j[0], cross(j[1], j[2]));
}

TEST(FalconSelfCheck, FindsAWeakerMotor) {
  if (!testing_device::EmulatedPedal::possible())
    GTEST_SKIP() << "runs under umockdev-wrapper only: ctest does so";
  if (std::getenv("CAVUM_DEEP") == nullptr) GTEST_SKIP() << "takes two minutes: CAVUM_DEEP=1";
  const testing_basics::Folder folder;
  ::setenv("CAVUM_HOME", folder.file("").c_str(), 1);
  EmulatedFalcon falcon;
  MovingArm::Model model;
  model.mass_kg = {0.15, 0.15, 0.15};
  model.coulomb_n = {0.12, 0.12, 0.12};
  model.weight_n = {0, 0.08, 0};  // stands where it is left
  model.quantum_mm = 0.0;         // its encoders round
  model.rate_hz = 4000;
  const auto arm = [&] {
    return std::make_unique<MovingArm>(
        model, k_falcon_middle_mm + Vec3{4, -5, 6},
        [&falcon, heard = std::int64_t{0}, since = std::chrono::steady_clock::now()]() mutable {
          // motors that nobody speaks to let go, as the stylus does: a busy computer emulates the
          // kernel in jerks
          constexpr auto k_patience = std::chrono::milliseconds(20);
          const auto now = std::chrono::steady_clock::now();
          if (const std::int64_t frames = falcon.frames(); frames != heard) {
            heard = frames;
            since = now;
          }
          return now - since > k_patience ? Vec3{} : force_of(falcon.motors(), k_falcon_middle_mm);
        },
        [&falcon](Vec3 mm) { falcon.move_to(mm); });
  };
  auto moving = arm();
  const auto first = testing_device::run("devices --self-check --stylus falcon --json");
  ASSERT_EQ(first.code, 0) << first.out;
  const json j = json::parse(first.out);
  std::printf(
      "FalconSelfCheck: %.1f s, mass %.4f kg (± %.1f %%), friction %.3f N, %.0f Hz, ticks missed %.2f %%\n",
      j["figures"]["seconds"].get<double>(), j["figures"]["axes"]["x"]["mass_kg"].get<double>(),
      200 * j["figures"]["axes"]["x"]["mass_error"].get<double>(),
      j["figures"]["friction_n"].get<double>(), j["figures"]["rate_hz"].get<double>(),
      100 * j["figures"]["ticks_missed"].get<double>());
  EXPECT_LT(j["figures"]["seconds"], 60.0);
  testing_device::learn_like_the_last({"falcon", j["stylus"]["serial"]}, 12);
  moving.reset();
  model.gain = 0.9;
  moving = arm();
  const auto second = testing_device::run("devices --self-check --stylus falcon --json");
  EXPECT_EQ(second.code, 1) << second.out;
  const json changes = json::parse(second.out)["verdict"]["changes"];
  ASSERT_GE(changes.size(), 1U) << second.out;
  EXPECT_NEAR(changes[0]["change"], -0.1, 0.04) << second.out;
}

}  // namespace
}  // namespace cavum
