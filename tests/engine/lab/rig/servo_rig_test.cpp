#include "engine/lab/rig/servo_rig.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numeric>

#include "engine/session/session_reader.h"
#include "engine/session/simulation.h"
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
    const SessionSetup setup = servo_rig_setup(
        bur_text("round-1.0"), read_text_file(data_path("materials/consistent.toml")), tick_s);
    ServoRigOptions options;
    options.seconds = 2.5;
    const ServoRigResult r = run_servo_rig(setup, path, options);
    std::printf("%s", english_text(to_text(r)).c_str());

    const auto periods = static_cast<std::int64_t>(options.seconds / tick_s + 0.5);
    EXPECT_EQ(r.servo.ticks, periods);
    EXPECT_EQ(r.writer.ticks, r.servo.ticks);
    EXPECT_EQ(r.writer.error, Message());
    EXPECT_GT(r.seconds, 0.99 * options.seconds)
        << "no faster than the clock; a busy machine may take its time, and the histogram tells";
    EXPECT_EQ(std::accumulate(r.servo.lateness.counts.begin(), r.servo.lateness.counts.end(),
                              std::int64_t{0}),
              r.servo.ticks);
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
      if (const auto* overruns = e.as<Overruns>()) told += overruns->count;
    EXPECT_EQ(told, r.servo.overruns);
    const VerifyReport report = verify_session(path);
    EXPECT_TRUE(report.verified) << testing_basics::text_of(report.findings);
    EXPECT_EQ(report.ticks, periods);
  }
}

// The neck leans on the rim of the hole here and the head hangs on crests that lie between the
// samples of the neck: the proxy goes forth and back over them. That once took 4800 places looked
// up in every tick for seconds, and the force dropped out on the way. What is looked up is nearly
// all that contact costs, and no clock disturbs it.
TEST(ServoRig, ContactOfAHandHasABoundInEveryTickAndItsForceNeverDropsOut) {
  for (const double tick_s : {0.001, 0.00025}) {
    const SessionSetup setup = servo_rig_setup(
        bur_text("round-1.0"), read_text_file(data_path("materials/consistent.toml")), tick_s);
    Simulation simulation = make_simulation(setup, "test");
    ServoState& state = simulation.state;
    SimulatedStylus stylus({}, {}, tick_s, drilling_hand);
    TickInput input = make_tick_input({setup.first_tip_mm(), {}}, 0, k_stylus_fresh, 0, {});
    const auto ticks = static_cast<std::size_t>(25.0 / tick_s),
               window = static_cast<std::size_t>(0.1 / tick_s);
    std::vector<int> looked_up;
    int most = 0;
    long in_window = 0, most_in_window = 0;
    double steepest_n = 0.0, last_n = 0.0;
    bool was_touching = false;
    for (std::size_t i = 0; i < ticks; ++i) {
      const DeviceReading r = stylus.read(tick_s);
      input = make_tick_input(r.pose, r.pedal, r.flags, r.bur, input);
      const TickOutput out = step(simulation.model, state, input);
      stylus.send_force(out.rendered_force_n);
      looked_up.push_back(state.scratch.looked_up);
      most = std::max(most, looked_up.back());
      in_window += looked_up.back() - (i >= window ? looked_up[i - window] : 0);
      most_in_window = std::max(most_in_window, in_window);
      const double force_n = length(out.rendered_force_n);
      if (out.contact && was_touching)
        steepest_n = std::max(steepest_n, std::fabs(force_n - last_n));
      last_n = force_n;
      was_touching = out.contact;
    }
    const double mean = static_cast<double>(most_in_window) / static_cast<double>(window);
    std::printf(
        "ticks of %g ms: at most %d places looked up in a tick, %.0f in the mean of the worst tenth of a second; force at most %.3f N a tick\n",
        tick_s * 1e3, most, mean, steepest_n);
    EXPECT_LE(most, 2200) << "in a tick of " << tick_s;
    EXPECT_LE(steepest_n, 0.15) << "ticks of " << tick_s;
  }
}

}  // namespace
}  // namespace cavum
