#include "engine/rig/servo_rig.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numeric>

#include "engine/session/session_reader.h"
#include "engine/session/verify.h"
#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

TEST(ServoRig, DrillsInRealTimeCountsEveryTickAndItsSessionVerifies) {
  for (const double tick_s : {0.001, 0.00025}) {
    const Folder folder;
    ::setenv("CAVUM_HOME", folder.file("station").c_str(), 1);
    const std::string path = folder.file("rig.cavum");
    const SessionSetup setup = servo_rig_setup(point_text("round-1.0"), read_text_file(data_path("materials/consistent.toml")), tick_s);
    ServoRigOptions options;
    options.seconds = 2.5;
    const ServoRigResult r = run_servo_rig(setup, path, options);
    std::printf("%s", to_text(r).c_str());

    const auto periods = static_cast<std::int64_t>(options.seconds / tick_s + 0.5);
    EXPECT_EQ(r.servo.ticks, periods);
    EXPECT_EQ(r.writer.ticks, r.servo.ticks);
    EXPECT_EQ(r.writer.error, "");
    EXPECT_NEAR(r.seconds, options.seconds, 0.5 + static_cast<double>(r.servo.skipped_late) * tick_s);
    EXPECT_EQ(std::accumulate(r.servo.lateness.counts.begin(), r.servo.lateness.counts.end(), std::int64_t{0}), r.servo.ticks);
    EXPECT_GT(r.mean_force_n, 0.1);
    EXPECT_LT(r.peak_force_n, 3.3 + 1e-9);
    EXPECT_GT(r.removed_leaves, 100);

    const nlohmann::json j = to_json(r);
    EXPECT_EQ(j["ticks"], r.servo.ticks);
    EXPECT_EQ(j["overruns"], r.servo.overruns);
    EXPECT_EQ(j["lateness"]["histogram"].size(), Lateness::k_edges_us.size() + 1);
    const SessionReader session(path);
    EXPECT_EQ(nlohmann::json::parse(session.result_json())["overruns"], r.servo.overruns);
    std::int64_t told = 0;
    for (const auto& e : session.event_rows())
      if (e.event.kind == "overruns") told += nlohmann::json::parse(e.event.detail_json)["count"].get<std::int64_t>();
    EXPECT_EQ(told, r.servo.overruns);
    const VerifyReport report = verify_session(path);
    EXPECT_TRUE(report.verified) << (report.findings.empty() ? "" : report.findings.front());
    EXPECT_EQ(report.ticks, periods);
  }
}

}  // namespace
}  // namespace cavum
