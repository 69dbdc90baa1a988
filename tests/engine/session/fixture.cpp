#include "tests/engine/session/fixture.h"

#include <sqlite3.h>

#include <algorithm>
#include <cmath>

#include "engine/base/det_math.h"
#include "engine/base/file.h"

namespace cavum::test {
namespace {

/// The force model with hard tissue that recedes eight times faster.
std::string softened(std::string text) {
  const std::string was = "tau_s = 2.02", is = "tau_s = 0.25";
  for (auto at = text.find(was); at != std::string::npos; at = text.find(was, at))
    text.replace(at, was.size(), is);
  return text;
}

double box_distance(double x, double y, double z, double half_x, double half_y, double low_z,
                    double high_z) {
  return std::max({std::fabs(x) - half_x, std::fabs(y) - half_y, low_z - z, z - high_z});
}

}  // namespace

Tooth block_tooth() {
  Tooth tooth;
  TissueGrid grid;
  grid.allocate({52, 52, 48}, 0.05, {-1.3, -1.3, -2.2});
  for (int z = 0; z < grid.size.z; ++z)
    for (int y = 0; y < grid.size.y; ++y)
      for (int x = 0; x < grid.size.x; ++x) {
        const Vec3 c = grid.centre_mm({x, y, z});
        const double block = box_distance(c.x, c.y, c.z, 1.1, 1.1, -2.0, 0.0);
        const double pulp = box_distance(c.x, c.y, c.z, 0.8, 0.8, -1.0, -0.6);
        const auto i = grid.index({x, y, z});
        if (block < 0) grid.tissue[i] = pulp < 0 ? k_pulp : c.z > -0.3 ? k_enamel : k_dentin;
        grid.distance[i] = encode_distance(std::max(block, -pulp) / grid.leaf_mm);
      }
  grid.make_consistent(tooth.tissues);
  tooth.octree = Octree(grid, tooth.tissues);
  tooth.name = "test block";
  return tooth;
}

SessionSetup block_setup() {
  SessionSetup setup;
  setup.candidate = "candidate-7";
  setup.calibration = "exact";
  setup.scenario_toml = "title = \"drill the block\"\n";
  setup.force_model_toml =
      softened(read_text_file(testing_basics::data_path("materials/paper.toml")));
  setup.servo_toml = to_toml(ServoConfig{});
  setup.burs_toml = {read_text_file(testing_basics::data_path("burs/round-1.0.toml"))};
  setup.tooth = save_tooth(block_tooth());
  const TickInput first = motion_at(0);
  setup.first_tip_nm = first.tip_nm;
  setup.notes = {{"room", "4"}};
  setup.attachments = {{"zone.stl", Bytes{1, 2, 3, 0, 255}}};
  return setup;
}

TickInput motion_at(std::int64_t tick) {
  const double t = static_cast<double>(tick) * 1e-3;
  Pose pose;
  const double tremor = 0.01 * std::sin(2 * k_pi * 9.1 * t) + 0.004 * std::sin(2 * k_pi * 23.7 * t);
  pose.tip_mm.x = 0.35 * std::sin(2 * k_pi * t / 1.7) + tremor;
  pose.tip_mm.y = 0.25 * std::sin(2 * k_pi * t / 2.9) - 0.5 * tremor;
  const double depth = std::min(1.3, 0.45 * t);  // slowly through roof and pulp
  pose.tip_mm.z = 0.15 - depth + 0.5 * std::max(0.0, std::sin(2 * k_pi * t / 3.7) - 0.8) +
                  tremor;  // now and then out
  const double tilt = 0.1 * std::sin(2 * k_pi * t / 5.0);
  pose.rotation = normalized(Quat{1.0, tilt, 0.3 * tilt, 0.0});
  const double pedal = tick % 1700 < 1500 ? 0.9 : 0.0;
  return make_tick_input(pose, pedal, k_stylus_fresh | k_pedal_fresh, 0, {});
}

void drill(Simulation& simulation, Recorder& recorder, std::int64_t first, std::int64_t ticks) {
  for (std::int64_t tick = first; tick < first + ticks; ++tick) {
    const TickInput input = motion_at(tick);
    const TickRecord record = make_tick_record(step(simulation.model, simulation.state, input));
    recorder.append(input, record, simulation.state.removed, state_hash(simulation.state));
  }
}

std::string make_closed_session(const std::string& path, std::int64_t ticks) {
  const SessionSetup setup = block_setup();
  Simulation simulation = make_simulation(setup, "test");
  Recorder recorder = Recorder::create(path, setup);
  std::string result = R"({"verdict":"pass","score":{"points":83,"max":100}})";
  for (std::int64_t tick = 0; tick < ticks; tick += 700) {
    recorder.add_event(tick, StepCompleted{static_cast<std::int32_t>(tick / 700)});
    drill(simulation, recorder, tick, std::min<std::int64_t>(700, ticks - tick));
  }
  recorder.close(save_tooth(drilled_tooth(simulation)), result);
  return result;
}

void tamper(const std::string& path, const std::string& sql) {
  sqlite3* db = nullptr;
  char* why = nullptr;
  const bool done =
      sqlite3_open_v2(path.c_str(), &db, SQLITE_OPEN_READWRITE, nullptr) == SQLITE_OK &&
      sqlite3_exec(db, sql.c_str(), nullptr, nullptr, &why) == SQLITE_OK &&
      sqlite3_total_changes(db) > 0;
  const std::string reason = why != nullptr ? why : "nothing changed";
  sqlite3_free(why);
  sqlite3_close(db);
  if (!done) throw std::runtime_error("tampering failed: " + reason);
}

}  // namespace cavum::test
