// A whole exam with a Falcon in the hand and a pedal under the foot, as a user runs it: `cavum exam
// --device falcon`, both devices emulated, the stylus unplugged for a while.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <thread>

#include "engine/base/file.h"
#include "engine/device/hardware/station_pedal.h"
#include "engine/session/session_reader.h"
#include "engine/session/verify.h"
#include "engine/tooth/make/make_block.h"
#include "engine/tooth/tooth.h"
#include "tests/device/emulated_falcon.h"
#include "tests/device/emulated_pedal.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

using namespace std::chrono_literals;

TEST(FalconExam, IsTakenUnpluggedPluggedInGradedAndReplays) {
  if (!testing_device::EmulatedPedal::possible())
    GTEST_SKIP() << "runs under umockdev-wrapper only: ctest does so";
  const testing_basics::Folder folder;
  ::setenv("CAVUM_HOME", folder.file("").c_str(), 1);
  ::setenv("CAVUM_DATA", (std::string(CAVUM_SOURCE_DIR) + "/data").c_str(), 1);
  std::string scenario =
      read_text_file(std::string(CAVUM_SOURCE_DIR) + "/tests/replay/block_cavity.toml");
  constexpr int k_limit_s = 20;
  scenario.replace(scenario.find("time_limit_s = 120"), 18,
                   "time_limit_s = " + std::to_string(k_limit_s));
  write_text_file(folder.file("task.toml"), scenario);
  write_file(
      folder.file("block.cvt"),
      save_tooth(make_block(
          {6, 6, 5}, {{"enamel", 1.0}, {"dentin", 1.5}, {"pulp", 1.0}, {"dentin", 1.5}}, 0.05)));
  write_text_file(
      folder.file("pedal.toml"),
      to_toml(
          {.vendor = 0x068e,
           .product = 0x00f2,
           .calibration = {.axis = 0, .released = 0, .pressed = 255, .speaks_on_change = false}}));

  testing_device::EmulatedPedal pedal;
  testing_device::EmulatedFalcon falcon(true, true, pedal.bed());
  const auto hand = [&](Vec3 tooth_mm) {
    falcon.move_to(k_falcon_middle_mm + Vec3{tooth_mm.x, tooth_mm.z, -tooth_mm.y});
  };
  hand({0, 0, 3});

  const std::string out = folder.file("s.cavum"), printed = folder.file("printed");
  const pid_t child = ::fork();
  if (child == 0) {
    if (std::freopen(printed.c_str(), "w", stdout) == nullptr ||
        std::freopen((printed + ".err").c_str(), "w", stderr) == nullptr)
      ::_exit(99);
    ::execl(CAVUM_BINARY, CAVUM_BINARY, "exam", folder.file("task.toml").c_str(), "--candidate",
            "t", "--device", "falcon", "--bur", "round-1.0", "--out", out.c_str(), "--json",
            nullptr);
    ::_exit(98);
  }
  std::atomic<bool> stop{false};
  std::thread foot([&] {
    while (!stop) {
      pedal.report_axes(255, 0, 0);
      std::this_thread::sleep_for(5ms);
    }
  });
  const auto ticks = [&] {
    try {
      return SessionReader(out).ticks();
    } catch (const Error&) {  // not begun yet
      return std::int64_t{0};
    }
  };
  const auto comes_true = [](const auto& condition) {
    for (int i = 0; i < 20000 && !condition(); ++i) std::this_thread::sleep_for(5ms);
    return condition();
  };
  EXPECT_TRUE(comes_true([&] { return ticks() >= 1000; })) << read_text_file(printed + ".err");
  bool pushed = false;
  for (double z = 1.5; z > -1.0; z -= 0.005) {
    hand({0.2 * std::sin(8 * z), 0, z});
    std::this_thread::sleep_for(1ms);
    for (const std::int16_t m : falcon.motors()) pushed = pushed || m != 0;
  }
  EXPECT_TRUE(pushed) << "the tooth was felt";
  const std::int64_t before = ticks();
  falcon.unplug();
  EXPECT_TRUE(comes_true([&] { return ticks() >= before + 2000; }))
      << "the exam goes on without it";
  falcon.plug_in();
  int status = 0;
  ::waitpid(child, &status, 0);
  stop = true;
  foot.join();
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0) << read_text_file(printed + ".err");

  const auto report = verify_session(out);
  EXPECT_TRUE(report.verified);
  EXPECT_EQ(report.ticks, k_limit_s * 1000) << "time is time, whatever the stylus does";
  const auto result = nlohmann::json::parse(read_text_file(printed));
  EXPECT_EQ(result["servo"]["first_disagreement"], -1);
  EXPECT_GT(result["volumes"]["removed_mm3"], 0.05) << "something was cut";
  const SessionReader session(out);
  int gone = 0, back = 0;
  for (const auto& e : session.events()) {
    gone += e.as<StylusSilent>() != nullptr && e.tick >= before ? 1 : 0;
    back += e.as<StylusBack>() != nullptr && e.tick >= before ? 1 : 0;
  }
  EXPECT_GE(gone, 1);
  EXPECT_GE(back, 1);
  const auto notes = session.setup().notes;
  const auto has = [&notes](const std::string& key) {
    return std::any_of(notes.begin(), notes.end(),
                       [&key](const auto& n) { return n.first == key; });
  };
  EXPECT_TRUE(has("stylus_calibration") && has("pedal_calibration"));
  EXPECT_EQ(session.inputs().back().bur, 1) << "round-1.0 is the second of the tray";
  EXPECT_NE(read_text_file(printed + ".err").find("falcon"), std::string::npos)
      << "and the supervisor was told";
}

}  // namespace
}  // namespace cavum
