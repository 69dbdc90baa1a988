// The self-check as a user runs it, on a free arm behind the service of an Inverse3: learnt, a
// stiffer joint found, decided on, and sealed into an exam.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "engine/base/file.h"
#include "engine/device/hardware/station_pedal.h"
#include "engine/device/selfcheck/check_note.h"
#include "engine/session/session_reader.h"
#include "engine/tooth/make/make_block.h"
#include "engine/tooth/tooth.h"
#include "tests/device/emulated_pedal.h"
#include "tests/device/inverse3_hands.h"
#include "tests/device/learnt_checks.h"
#include "tests/device/moving_arm.h"
#include "tests/device/program.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

using nlohmann::json;
using testing_device::MovingArm;
using testing_device::Ran;
using testing_device::run;

constexpr Vec3 k_inverse3_middle_mm{0, -120, 150};

class Inverse3SelfCheck : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!testing_device::EmulatedPedal::possible())
      GTEST_SKIP() << "runs under umockdev-wrapper only: ctest does so";
    ::setenv("CAVUM_HOME", folder_.file("").c_str(), 1);
    ::setenv("CAVUM_DATA", (std::string(CAVUM_SOURCE_DIR) + "/data").c_str(), 1);
    StationStylus station = usual_station_stylus(inverse3_kind());
    station.settings["port"] = static_cast<double>(service_.port());
    write_text_file(folder_.file("stylus-inverse3.toml"), to_toml(station));
  }
  static MovingArm::Model free_arm() {
    MovingArm::Model m;
    m.mass_kg = {0.2, 0.25, 0.3};
    m.coulomb_n = {0.08, 0.1, 0.12};
    m.weight_n = {0, 0, 0.1};
    m.quantum_mm = 0.01;
    m.rate_hz = 4000;  // of the arm in its device; the service exchanges at its own
    return m;
  }
  [[nodiscard]] std::unique_ptr<MovingArm> arm(const MovingArm::Model& model) {
    auto moving = std::make_unique<MovingArm>(
        model, k_inverse3_middle_mm + Vec3{5, 4, -6}, [this] { return service_.force_n(); },
        [this](Vec3 mm) { service_.move_to(mm / 1000.0); });
    service_.before_each_command([arm = moving.get()] { arm->catch_up(); });
    return moving;
  }
  void let_go(std::unique_ptr<MovingArm>& moving) {
    service_.before_each_command({});
    moving.reset();
  }

  testing_basics::Folder folder_;
  testing_device::EmulatedInverse3 service_;
};

TEST_F(Inverse3SelfCheck, FindsAStifferJointAndTheSessionSaysWhatWasDecided) {
  const CheckedStylus stylus{"inverse3", "049D"};
  auto moving = arm(free_arm());
  const Ran first = run("devices --self-check --stylus inverse3 --station-name 'Seat 3' --json");
  ASSERT_EQ(first.code, 0) << first.out;
  const json j = json::parse(first.out);
  EXPECT_EQ(j["station"], "Seat 3");
  EXPECT_EQ(j["stylus"]["serial"], "049D");
  EXPECT_EQ(j["verdict"]["outcome"], "learning");
  EXPECT_NEAR(j["figures"]["friction_n"], 0.12, 0.05) << "of joints askew to the axes";
  EXPECT_LT(j["figures"]["seconds"], 60.0);
  std::printf(
      "Inverse3SelfCheck: %.1f s, mass %.4f kg (± %.1f %%), friction %.3f N, %.0f Hz, ticks missed %.2f %%\n",
      j["figures"]["seconds"].get<double>(), j["figures"]["axes"]["x"]["mass_kg"].get<double>(),
      200 * j["figures"]["axes"]["x"]["mass_error"].get<double>(),
      j["figures"]["friction_n"].get<double>(), j["figures"]["rate_hz"].get<double>(),
      100 * j["figures"]["ticks_missed"].get<double>());
  testing_device::learn_like_the_last(stylus, 12);

  MovingArm::Model stiffer = free_arm();
  for (double& c : stiffer.coulomb_n) c += 0.1;
  let_go(moving);
  moving = arm(stiffer);
  const Ran second = run("devices --self-check --stylus inverse3");
  EXPECT_EQ(second.code, 1) << second.out;
  EXPECT_NE(second.out.find("Seat 3"), std::string::npos);
  EXPECT_NE(second.out.find("+0.1"), std::string::npos) << second.out;
  let_go(moving);

  write_file(
      folder_.file("block.cvt"),
      save_tooth(make_block(
          {6, 6, 5}, {{"enamel", 1.0}, {"dentin", 1.5}, {"pulp", 1.0}, {"dentin", 1.5}}, 0.05)));
  std::string scenario =
      read_text_file(std::string(CAVUM_SOURCE_DIR) + "/tests/replay/block_cavity.toml");
  scenario.replace(scenario.find("time_limit_s = 120"), 18, "time_limit_s = 2");
  write_text_file(folder_.file("task.toml"), scenario);
  write_text_file(
      folder_.file("pedal.toml"),
      to_toml(
          {.vendor = 0x068e,
           .product = 0x00f2,
           .calibration = {.axis = 0, .released = 0, .pressed = 255, .speaks_on_change = false}}));
  const auto exam = [&](const std::string& name) {
    const Ran sat =
        run("exam " + folder_.file("task.toml") +
            " --candidate t --device inverse3 --bur round-1.0 --out " + folder_.file(name));
    EXPECT_EQ(sat.code, 0) << sat.out;
    return run("verify " + folder_.file(name));
  };
  const Ran undecided = exam("undecided.cavum");
  EXPECT_EQ(undecided.code, 1);
  EXPECT_NE(undecided.out.find("Seat 3"), std::string::npos) << undecided.out;
  EXPECT_EQ(
      run("devices --self-check --stylus inverse3 --override-check 'the last free seat'").code, 0);
  const Ran decided = exam("decided.cavum");
  EXPECT_EQ(decided.code, 0) << decided.out;
  EXPECT_NE(decided.out.find("Seat 3"), std::string::npos) << decided.out;
  EXPECT_NE(decided.out.find("the last free seat"), std::string::npos) << decided.out;
  const std::string note =
      SessionReader(folder_.file("decided.cavum")).fact(std::string("note.") + k_self_check_note);
  EXPECT_EQ(read_session_check(note, "note").check.verdict.compared, 12U);

  const std::string report = folder_.file("r.html");
  EXPECT_EQ(run("report " + folder_.file("decided.cavum") + " --out " + report +
                " --for instructor --no-replay")
                .code,
            0);
  EXPECT_NE(read_text_file(report, k_largest_file).find("Seat 3"), std::string::npos);
}

}  // namespace
}  // namespace cavum
