// An Inverse3 in the hand and a pedal under the foot, as a user runs it: `cavum devices`, a whole
// `cavum exam --device inverse3` during which the service is begun again, and a program that is
// killed.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "engine/base/file.h"
#include "engine/device/hardware/inverse3_stylus.h"
#include "engine/device/hardware/station_pedal.h"
#include "engine/session/session_reader.h"
#include "engine/session/verify.h"
#include "engine/tooth/make/make_block.h"
#include "engine/tooth/tooth.h"
#include "tests/device/emulated_pedal.h"
#include "tests/device/inverse3_hands.h"
#include "tests/device/program.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

using namespace std::chrono_literals;

bool comes_true_in_an_exam(const std::function<bool()>& condition) {
  return testing_device::comes_true(condition, 100s);
}

class Inverse3Exam : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!testing_device::EmulatedPedal::possible())
      GTEST_SKIP() << "runs under umockdev-wrapper only: ctest does so";
    ::setenv("CAVUM_HOME", folder_.file("").c_str(), 1);
    ::setenv("CAVUM_DATA", (std::string(CAVUM_SOURCE_DIR) + "/data").c_str(), 1);
    StationStylus station = usual_station_stylus(inverse3_kind());
    station.settings["port"] = static_cast<double>(service_.port());
    write_text_file(folder_.file("stylus-inverse3.toml"), to_toml(station));
    hand({0, 0, 3});
  }
  /// Tooth frame; the usual placement.
  void hand(Vec3 tooth_mm) { service_.move_to((tooth_mm + Vec3{0, -120, 150}) / 1000.0); }
  void write_task(int limit_s) const {
    std::string scenario =
        read_text_file(std::string(CAVUM_SOURCE_DIR) + "/tests/replay/block_cavity.toml");
    scenario.replace(scenario.find("time_limit_s = 120"), 18,
                     "time_limit_s = " + std::to_string(limit_s));
    write_text_file(folder_.file("task.toml"), scenario);
    write_file(
        folder_.file("block.cvt"),
        save_tooth(make_block(
            {6, 6, 5}, {{"enamel", 1.0}, {"dentin", 1.5}, {"pulp", 1.0}, {"dentin", 1.5}}, 0.05)));
    write_text_file(
        folder_.file("pedal.toml"),
        to_toml({.vendor = 0x068e,
                 .product = 0x00f2,
                 .calibration = {
                     .axis = 0, .released = 0, .pressed = 255, .speaks_on_change = false}}));
  }
  [[nodiscard]] pid_t start_exam() const {
    const pid_t child = ::fork();
    if (child == 0) {
      const std::string printed = folder_.file("printed");
      if (std::freopen(printed.c_str(), "w", stdout) == nullptr ||
          std::freopen((printed + ".err").c_str(), "w", stderr) == nullptr)
        ::_exit(99);
      ::execl(CAVUM_BINARY, CAVUM_BINARY, "exam", folder_.file("task.toml").c_str(), "--candidate",
              "t", "--device", "inverse3", "--bur", "round-1.0", "--out",
              folder_.file("s.cavum").c_str(), "--json", nullptr);
      ::_exit(98);
    }
    return child;
  }
  [[nodiscard]] std::int64_t ticks() const {
    try {
      return SessionReader(folder_.file("s.cavum")).ticks();
    } catch (const Error&) {  // not begun yet
      return 0;
    }
  }
  [[nodiscard]] std::string said() const { return read_text_file(folder_.file("printed.err")); }
  /// Goes down into the block until `enough`, or 2.5 mm deep.
  void drill(const std::function<bool()>& enough) {
    for (double z = 1.5; z > -1.0 && !enough(); z -= 0.005) {
      hand({0.2 * std::sin(8 * z), 0, z});
      std::this_thread::sleep_for(1ms);
    }
  }

  testing_basics::Folder folder_;
  testing_device::EmulatedInverse3 service_;
};

/// Presses the pedal down for as long as it lives.
class Foot {
 public:
  explicit Foot(testing_device::EmulatedPedal& pedal)
      : thread_([this, &pedal] {
          for (; !stop_; std::this_thread::sleep_for(5ms)) pedal.report_axes(255, 0, 0);
        }) {}
  ~Foot() {
    stop_ = true;
    thread_.join();
  }

 private:
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

TEST_F(Inverse3Exam, IsListedAndTried) {
  const auto styluses =
      nlohmann::json::parse(testing_device::run("devices --json").out)["styluses"];
  const auto listed = std::find_if(styluses.begin(), styluses.end(),
                                   [](const auto& s) { return s["id"] == "inverse3"; });
  ASSERT_NE(listed, styluses.end());
  EXPECT_EQ((*listed)["there"], true);
  EXPECT_TRUE((*listed)["problem"].is_null());
  EXPECT_EQ((*listed)["ratings"]["reach_mm"], 100.0);
  const testing_device::Ran tried =
      testing_device::run("devices --test --stylus inverse3 --seconds 1 --no-push --json");
  ASSERT_EQ(tried.code, 0) << tried.out;
  EXPECT_GT(nlohmann::json::parse(tried.out)["rate_hz"], 400.0);
  service_.stop();
  const auto stopped = nlohmann::json::parse(testing_device::run("devices --json").out)["styluses"];
  EXPECT_TRUE(std::any_of(stopped.begin(), stopped.end(), [](const auto& s) {
    return s["id"] == "inverse3" && s["there"] == false;
  }));
}

TEST_F(Inverse3Exam, IsPlacedByFourMarksAndACrownAtTheEdgeOfItsReachIsNamed) {
  for (const double off_mm : {0.0, 90.0}) {
    const Vec3 crown_mm = Vec3{0, -120, 150} + Vec3{off_mm, 0, 0};  // the device's axes
    const std::string said = folder_.file("said");
    write_text_file(said, "");
    FILE* pipe = ::popen(
        (std::string(CAVUM_BINARY) + " devices --place --stylus inverse3 > " + said + " 2>&1")
            .c_str(),
        "w");
    ASSERT_NE(pipe, nullptr);
    const auto lines = [&] {
      const std::string words = read_text_file(said);
      return std::count(words.begin(), words.end(), '\n');
    };
    std::ptrdiff_t asked = 0;
    for (const Vec3 mark : {Vec3{0, 0, 0}, Vec3{20, 0, 0}, Vec3{0, 20, 0}, Vec3{0, 0, 20}}) {
      EXPECT_TRUE(comes_true_in_an_exam([&] { return lines() > asked; }))
          << "each mark is asked for in a line";
      asked = lines();
      service_.move_to((crown_mm + mark) / 1000.0);
      std::this_thread::sleep_for(50ms);  // some states later
      std::fputs("\n", pipe);
      std::fflush(pipe);
    }
    EXPECT_EQ(WEXITSTATUS(::pclose(pipe)), 0) << read_text_file(said);
    const StationStylus kept = load_station_stylus(inverse3_kind());
    EXPECT_LT(length(to_tooth(kept.placement, crown_mm).tip_mm), 1e-6);
    EXPECT_EQ(kept.number("port"), service_.port()) << "what the station had told it stays";
    EXPECT_EQ(read_text_file(said).find("100 mm") != std::string::npos, off_mm > 0)
        << "how far it is off, and its reach: " << read_text_file(said);
  }
}

TEST_F(Inverse3Exam, IsTakenWhileTheServiceIsBegunAgainGradedAndReplays) {
  constexpr int k_limit_s = 12;
  write_task(k_limit_s);
  testing_device::EmulatedPedal pedal;
  const pid_t child = start_exam();
  {
    const Foot foot(pedal);
    EXPECT_TRUE(comes_true_in_an_exam([&] { return ticks() >= 1000; })) << said();
    double felt_n = 0.0;
    drill([&] {
      felt_n = std::max(felt_n, service_.force_n().z);
      return false;
    });
    EXPECT_GT(felt_n, 0.05) << "the tooth was felt, upwards";
    const std::int64_t before = ticks();
    service_.stop();
    EXPECT_TRUE(comes_true_in_an_exam([&] { return ticks() >= before + 1500; }))
        << "the exam goes on without it";
    service_.start();
    EXPECT_TRUE(comes_true_in_an_exam([&] { return service_.lines() == 1; }));
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 0) << said();
  }
  EXPECT_EQ(length(service_.force_n()), 0.0) << "no force is left";
  const std::string out = folder_.file("s.cavum");
  const auto report = verify_session(out);
  EXPECT_TRUE(report.verified);
  EXPECT_EQ(report.ticks, k_limit_s * 1000) << "time is time, whatever the stylus does";
  const auto result = nlohmann::json::parse(read_text_file(folder_.file("printed")));
  EXPECT_EQ(result["servo"]["first_disagreement"], -1);
  EXPECT_GT(result["volumes"]["removed_mm3"], 0.05) << "something was cut";
  int gone = 0, back = 0;
  const SessionReader session(out);
  for (const auto& e : session.events()) {
    gone += e.as<StylusSilent>() != nullptr ? 1 : 0;
    back += e.as<StylusBack>() != nullptr ? 1 : 0;
  }
  EXPECT_GE(gone, 1);
  EXPECT_GE(back, 1);
  EXPECT_NE(said().find("inverse3"), std::string::npos)
      << "and the supervisor was told: " << said();
}

TEST_F(Inverse3Exam, AKilledProgramLeavesNoForce) {
  write_task(60);
  testing_device::EmulatedPedal pedal;
  const pid_t child = start_exam();
  const Foot foot(pedal);
  EXPECT_TRUE(comes_true_in_an_exam([&] { return ticks() >= 500; })) << said();
  drill([&] { return length(service_.force_n()) > 0.2; });
  EXPECT_GT(length(service_.force_n()), 0.0);
  ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(comes_true_in_an_exam([&] {
    return service_.lines() == 0 && length(service_.force_n()) == 0.0;
  })) << "the system closes its line, and the service lets go";
}

}  // namespace
}  // namespace cavum
