#include "engine/lab/rig/servo_rig.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/base/det_math.h"
#include "engine/base/system_error.h"
#include "engine/physics/servo/real_time_json.h"
#include "engine/session/simulation.h"
#include "engine/tooth/make/make_block.h"

namespace cavum {
HandIntent drilling_hand(double t_s) {
  constexpr double k_radius_mm = 1.0, k_turn_s = 8.0, k_start_mm = 0.3, k_press_mm = 1.2,
                   k_feed_mm_s = 0.06;
  const SinCos turn = det_sincos(2 * k_pi * t_s / k_turn_s);
  const double in_turn = t_s / k_turn_s - std::floor(t_s / k_turn_s);
  const double lift_mm = std::max(0.0, 2.0 - 40.0 * std::fabs(in_turn - 0.95));
  const double depth_mm = std::min(2.0 * t_s, k_start_mm + k_press_mm + k_feed_mm_s * t_s);
  return {{k_radius_mm * turn.cos, k_radius_mm * turn.sin, k_start_mm - depth_mm + lift_mm},
          t_s > 0.1 ? 1.0 : 0.0};
}

SessionSetup servo_rig_setup(const std::string& bur_toml, const std::string& force_model_toml,
                             double tick_s) {
  SessionSetup setup;
  setup.candidate = "rig";
  setup.calibration = "exact";
  setup.source = {SourceKind::program, "servo rig"};
  setup.scenario_toml = "title = \"servo rig\"\n";
  setup.force_model_toml = force_model_toml;
  ServoConfig config;
  config.tick_s = tick_s;
  config.position_quantum_mm = OmniModel{}.quantum_mm;
  setup.servo_toml = to_toml(config);
  setup.burs_toml = {bur_toml};
  setup.tooth = save_tooth(make_block({10, 10, 6}, {{"enamel", 0.5}, {"dentin", 5.5}}, 0.05));
  const Vec3 start = drilling_hand(0.0).tip_mm;
  setup.first_tip_nm = make_tick_input({start, {}}, 0, k_stylus_fresh, 0, {}).tip_nm;
  return setup;
}

ServoRigResult run_servo_rig(const SessionSetup& setup, const std::string& path,
                             const ServoRigOptions& options) {
  Simulation simulation = make_simulation(setup, path);
  ServoRigResult result;
  result.tick_s = simulation.model.config.tick_s;
  const std::int64_t periods = std::llround(options.seconds / result.tick_s);
  RealTimeOptions real_time = options.real_time;
  if (real_time.max_ticks == 0) real_time.max_ticks = periods;

  Recorder recorder = Recorder::create(path, setup);
  TickStream stream(static_cast<std::size_t>(30.0 / result.tick_s));
  SimulatedStylus stylus({}, {}, result.tick_s, drilling_hand);
  const TickInput first = make_tick_input({setup.first_tip_mm(), {}}, 0, k_stylus_fresh, 0, {});
  RealTimeServo servo(simulation.model, simulation.state, stylus, stream, first, real_time);
  SessionWriter writer(stream, recorder, result.tick_s,
                       [&](const ServoTick& tick, std::span<const RemovedLeaf> removed) {
                         result.removed_leaves += static_cast<std::int64_t>(removed.size());
                         if (!tick.output.contact) return true;
                         const double force_n = length(tick.output.rendered_force_n);
                         ++result.contact_ticks;
                         result.mean_force_n += force_n;
                         result.peak_force_n = std::max(result.peak_force_n, force_n);
                         return true;
                       });
  const std::int64_t start_ns = read_clocks().monotonic_ns;
  servo.start();
  writer.start();
  result.servo = servo.join();
  result.seconds = static_cast<double>(read_clocks().monotonic_ns - start_ns) * 1e-9;
  result.writer = writer.finish();
  if (result.contact_ticks > 0) result.mean_force_n /= static_cast<double>(result.contact_ticks);
  result.slowest_write_s = recorder.slowest_write_s();
  recorder.close(save_tooth(drilled_tooth(simulation)), to_json(result).dump());
  return result;
}

nlohmann::json to_json(const ServoRigResult& r) {
  nlohmann::json j = to_json(r.servo);
  j.update({{"on_time", r.on_time()},
            {"tick_s", r.tick_s},
            {"seconds", r.seconds},
            {"force",
             {{"mean_n", r.mean_force_n},
              {"peak_n", r.peak_force_n},
              {"contact_ticks", r.contact_ticks}}},
            {"removed_leaves", r.removed_leaves},
            {"recording",
             {{"ticks", r.writer.ticks},
              {"most_waiting", r.writer.most_waiting},
              {"slowest_write_s", r.slowest_write_s},
              {"error", r.writer.error}}}});
  return j;
}

Lines to_text(const ServoRigResult& r) {
  const auto reason = [](const SystemGrant& g) {
    return g.asked ? system_words(g.error) : msg("not asked for");
  };
  const RealTimeReport& s = r.servo;
  const Number tick = as_unit(r.tick_s * 1e3, Unit::ms), seconds = as_s(r.seconds, 2);
  Lines out;
  out.add(r.on_time()
              ? msgn("{} tick of {} in {}: on time", "{} ticks of {} in {}: on time", s.ticks,
                     s.ticks, tick, seconds)
              : msgn("{} tick of {} in {}: NOT always on time",
                     "{} ticks of {} in {}: NOT always on time", s.ticks, s.ticks, tick, seconds));
  out.add(s.fifo.granted() ? msg("SCHED_FIFO: granted")
                           : msg("SCHED_FIFO: refused ({})", reason(s.fifo)),
          2);
  out.add(
      s.memory.granted() ? msg("memory: locked") : msg("memory: not locked ({})", reason(s.memory)),
      2);
  out.row({msg("overruns (more than a period late)"), msg("{}", s.overruns)}, 2);
  out.row({msg("ticks made up for"), msg("{}", s.made_up)}, 2);
  out.row({msg("periods skipped late"), msg("{}", s.skipped_late)}, 2);
  out.row({msg("periods skipped without room"), msg("{}", s.skipped_full)}, 2);
  out.row({msg("times the guard cut the force"), msg("{}", s.guard_cuts)}, 2);
  out.row({msg("µs"), msg("mean"), msg("99 % below"), msg("worst")}, 2);
  const auto times = [&](const Message& what, const Lateness& l) {
    out.row({what, msg("{}", as_number(l.mean_us(), 1)),
             msg("{}", as_number(l.quantile_us(0.99), 0)), msg("{}", as_number(l.worst_us(), 0))},
            2);
  };
  times(msg("lateness of a tick"), s.lateness);
  times(msg("work of a tick"), s.work);
  out.add(msgn("force in contact: mean {}, peak {}; {} leaf removed",
               "force in contact: mean {}, peak {}; {} leaves removed", r.removed_leaves,
               as_n(r.mean_force_n, 2), as_n(r.peak_force_n, 2), r.removed_leaves),
          2);
  out.add(
      msgn("recorded {} tick, at most {} waiting, slowest write {}",
           "recorded {} ticks, at most {} waiting, slowest write {}", r.writer.ticks,
           r.writer.ticks, r.writer.most_waiting, as_unit(r.slowest_write_s * 1e3, Unit::ms, 1)),
      2);
  if (!s.failure.empty()) out.add(msg("device: {}", s.failure), 2);
  if (!r.writer.error.empty()) out.add(msg("recording: {}", r.writer.error), 2);
  out.gap();
  out.row({msg("late by up to, µs"), msg("ticks"), {}}, 2);
  for (std::size_t i = 0; i < s.lateness.counts.size(); ++i) {
    const auto n = s.lateness.counts[i];
    if (n == 0) continue;
    const double share =
        static_cast<double>(n) / static_cast<double>(std::max<std::int64_t>(1, s.ticks));
    const std::string bar(static_cast<std::size_t>(std::ceil(40 * share)), '#');
    out.row({i < Lateness::k_edges_us.size() ? msg("{}", Lateness::k_edges_us[i]) : msg("later"),
             msg("{}", n), Name{bar}},
            2);
  }
  return out;
}

}  // namespace cavum
