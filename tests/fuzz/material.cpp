#include "tests/fuzz/material.h"

#include <stdlib.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "engine/base/file.h"
#include "engine/physics/servo/servo.h"
#include "engine/session/recorder.h"
#include "engine/session/simulation.h"
#include "grading/records/ledger.h"

namespace cavum::fuzz {
namespace {

/// CAVUM_HOME points into the folder, so that the station's key is one of its own.
class WorkFolder {
 public:
  WorkFolder() {
    const auto base = std::filesystem::is_directory("/dev/shm")
                          ? std::filesystem::path("/dev/shm")
                          : std::filesystem::temp_directory_path();
    std::string name = (base / "cavum-fuzz-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
      throw Error(name, msg("cannot be made"), msg("make room there"));
    path_ = name;
    ::setenv("CAVUM_HOME", name.c_str(), 1);
  }
  ~WorkFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

TickInput motion_at(std::int64_t tick) {
  Pose pose;
  const double t = static_cast<double>(tick) * 1e-3;
  pose.tip_mm = {t, -0.5 * t, 0.05 - 9.0 * t};  // fast: the session has few ticks
  pose.rotation = normalized(Quat{1.0, 0.05 * t, 0.0, 0.0});
  return make_tick_input(pose, tick % 15 < 13 ? 0.9 : 0.0, k_stylus_fresh | k_pedal_fresh, 0, {});
}

Bytes record_session() {
  const std::string path = work_folder() + "/small.cavum";
  const SessionSetup setup = small_setup();
  {
    Simulation simulation = make_simulation(setup, "fuzz");
    Recorder recorder = Recorder::create(path, setup);
    recorder.add_event(0, StepStarted{});
    for (std::int64_t tick = 0; tick < 30; ++tick) {
      const TickInput input = motion_at(tick);
      const TickRecord record = make_tick_record(step(simulation.model, simulation.state, input));
      recorder.append(input, record, simulation.state.removed, state_hash(simulation.state));
      if (tick == 15) {
        recorder.add_event(
            tick, RecordingGap{1, 2, 1.5, "x", "", {MotionSource{SourceKind::device, "none"}}});
        recorder.flush();
      }
    }
    for (const Event& e : {Event(Perforated{}), Event(ServoLateness{}), Event(TimeUp{})})
      recorder.add_event(29, e);
    recorder.close(save_tooth(drilled_tooth(simulation)), small_result());
  }
  return read_file(path);
}

}  // namespace

const std::string& work_folder() {
  static const WorkFolder k_folder;
  return k_folder.path();
}

std::string data_text(const std::string& name) {
  return read_text_file(std::string(CAVUM_SOURCE_DIR) + "/data/" + name);
}

Tooth small_tooth() {
  Tooth tooth;
  tooth.name = "small";
  tooth.tissues = standard_tissues();
  TissueGrid grid;
  grid.allocate({16, 16, 16}, 0.1, {-0.8, -0.8, -1.2});
  for (int z = 0; z < 16; ++z)
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) {
        const Vec3 c = grid.centre_mm({x, y, z});
        const double outside =
            std::max({std::fabs(c.x) - 0.4, std::fabs(c.y) - 0.4, c.z, -0.8 - c.z});
        const double pulp =
            std::max({std::fabs(c.x) - 0.2, std::fabs(c.y) - 0.2, c.z + 0.4, -0.6 - c.z});
        const auto i = grid.index({x, y, z});
        if (outside < 0) grid.tissue[i] = pulp < 0 ? k_pulp : c.z > -0.2 ? k_enamel : k_dentin;
        grid.distance[i] = encode_distance(std::max(outside, -pulp) / grid.leaf_mm);
      }
  grid.make_consistent(tooth.tissues);
  tooth.octree = Octree(grid, tooth.tissues);
  return tooth;
}

SessionSetup small_setup() {
  static_cast<void>(work_folder());
  SessionSetup setup;
  setup.candidate = records::parse_ticket(small_ticket(), "", "ticket").candidate;
  setup.scenario_toml = "title = \"drill\"\n";
  setup.force_model_toml = data_text("materials/paper.toml");
  setup.servo_toml = to_toml(ServoConfig{});
  setup.burs_toml = {data_text("burs/round-1.0.toml")};
  setup.tooth = save_tooth(small_tooth());
  setup.first_tip_nm = motion_at(0).tip_nm;
  setup.notes = {{"room", "4"}, {records::k_ticket_note, small_ticket()}};
  return setup;
}

const Bytes& small_session() {
  static const Bytes k_bytes = record_session();
  return k_bytes;
}

const SigningKey& station_key() {
  static const SigningKey k_key =
      (static_cast<void>(work_folder()), load_station_key(station_key_path()));
  return k_key;
}

const SigningKey& school_key() {
  static const SigningKey k_key = records::load_school_key(work_folder() + "/school.key", true);
  return k_key;
}

const records::SignedTicket& signed_ticket() {
  static const records::SignedTicket k_ticket = [] {
    records::Ticket t;
    t.ledger = std::string(32, '1');
    t.exam = "drill";
    t.candidate = "C-7K3M-92PQ-XD4V";
    t.nonce = std::string(32, '2');
    t.not_before_utc_ns = 0;
    t.not_after_utc_ns = 7'258'118'400'000'000'000;
    t.artifacts = {{"scenario.toml", std::string(64, '3')}};
    t.grant = {{"extra_time_percent", "25"}};
    t.public_key = to_hex(school_key().public_key);
    return records::sign_ticket(t, school_key());
  }();
  return k_ticket;
}
const std::string& small_ticket() { return signed_ticket().text; }

const records::LedgerContent& school_ledger() {
  static const records::LedgerContent k_content = [] {
    const std::string folder = work_folder() + "/ledger";
    records::Ledger::create(folder, "School", school_key());
    records::Ledger ledger(folder, school_key());
    ledger.append([](const records::LedgerContent&) {
      return records::TicketEntry{signed_ticket().ticket, signed_ticket().signature, {}};
    });
    return ledger.content();
  }();
  return k_content;
}

std::string small_result() {
  return R"({"criteria":[{"id":"depth","max":10.0,"metric":"floor_depth_mm","points":8.5,"reason":"0.2 mm too deep","unit":"mm","value":0.2},)"
         R"({"id":"time","max":5.0,"metric":"time_s","points":5.0,"reason":"","unit":"s","value":null}],"score":{"max":15.0,"points":13.5},"verdict":"pass"})";
}

void read_all_ticks(const SessionReader& session) {
  for (std::size_t i = 0; i < session.chunks().size(); ++i) {
    try {
      static_cast<void>(session.motion(i));
    } catch (const Error&) {  // the seconds after it are read all the same
    }
  }
  session.require_readable();
  static_cast<void>(session.removed());
}

}  // namespace cavum::fuzz
