#include "engine/lab/rig/grind_rig.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/physics/servo/servo.h"
#include "engine/tooth/make/make_block.h"

namespace cavum {
namespace {

constexpr double k_bench_leaf_mm = 0.05, k_over_bench_mm = 0.02;
constexpr double k_lowered_mm = 1e-3,
                 k_fastest_mm = 0.1;  // a tick: in air, and while the load comes on
constexpr double k_max_s = 1200.0;    // a weight that has not sunk in by then does not
constexpr double k_groove_mm =
    0.05;  // on its side: so shallow that pressure and load point the same way
constexpr double k_end_in_mm =
    0.1;  // on its end: so far beyond the height where the head is widest
constexpr double k_seconds_per_min = 60.0;

/// The bench: a block, a bur over it, and the way of its tip to the surface.
struct GrindBench {
  Tooth block;
  Quat rotation;
  Vec3 start_mm;
  double from_mm = 0;  ///< depth at which the rate is taken
};

GrindBench make_grind_bench(const std::string& tissue, const Bur& bur, bool side) {
  GrindBench b;
  const double r = bur.head_radius_mm;
  b.from_mm = side ? k_groove_mm : bur.widest_from_mm + k_end_in_mm;
  const double high = b.from_mm + k_grind_window_mm + 0.6;
  if (!side) {
    b.block = make_block({2 * r + 1.0, 2 * r + 1.0, high}, {{tissue, high}}, k_bench_leaf_mm);
    b.start_mm = {0, 0, k_over_bench_mm};
    return b;
  }
  const double wide = std::min(
      2.0,
      0.6 * bur.cutting_length_mm);  // narrower than the head is long: only the head lies on it
  b.block = make_block({2 * r + 1.0, wide, high}, {{tissue, high}}, k_bench_leaf_mm);
  b.rotation = rotation_between({0, 0, 1}, {0, 1, 0});
  b.start_mm = {0, -0.5 * bur.cutting_length_mm, r + k_over_bench_mm};
  return b;
}

double ground_away_mm3(const Octree& before, const Octree& now) {
  const auto a = before.count_leaves(), b = now.count_leaves();
  double leaves = 0;
  for (std::size_t i = 1; i < a.size(); ++i)
    leaves += static_cast<double>(a[i]) - static_cast<double>(b[i]);
  return leaves * before.leaf_volume_mm3();
}

}  // namespace

GrindRow grind(const ForceModel& force, const Bur& bur, const std::string& tissue, double load_n,
               const GrindOptions& options) {
  const GrindBench bench = make_grind_bench(tissue, bur, options.side);
  ServoConfig config;
  config.max_rpm = options.rpm;
  ForceModel undamped = force;  // a weight that comes on presses no harder than it weighs
  for (auto& [name, material] : undamped.materials) material.voigt.damping_n_s_per_mm = 0.0;
  const ServoModel model = make_servo_model(bench.block, {bur}, undamped, config);
  ServoState state = make_servo_state(model, bench.block, bench.start_mm);
  TickInput input;
  const auto tick = [&](Vec3 tip) {
    input = make_tick_input({tip, bench.rotation}, 1.0, k_stylus_fresh | k_pedal_fresh, 0, input);
    return step(model, state, input);
  };
  TickOutput out;
  for (int i = 0; i < 3 * k_ticks_per_second; ++i) out = tick(bench.start_mm);
  GrindRow row{.tissue = tissue, .load_n = load_n};
  double z = bench.start_mm.z, begin_s = -1, first_mm = 0, first_mm3 = -1, first_mm3_s = 0,
         last_mm3 = 0, last_mm3_s = 0, depth_mm = 0, t_s = 0;
  double rpm_sum = 0, torque_sum = 0;
  int counted = 0;
  while (t_s < k_max_s && !(begin_s >= 0 && depth_mm >= first_mm + k_grind_window_mm)) {
    const std::uint64_t edit = state.tooth.edit_hash();
    out = tick({bench.start_mm.x, bench.start_mm.y, z});
    t_s += k_tick_s;
    // A weight: the tip goes to where the force is the load, X = F/k, as far below the surface that
    // has receded by what is owed.
    if (!out.contact) {
      z -= k_lowered_mm;
      continue;
    }
    const double owed_mm = std::max(0.0, state.recession.pending_mm);
    depth_mm = bench.start_mm.z - k_over_bench_mm - out.proxy_mm.z + owed_mm;
    if (out.stiffness_n_per_mm > 0)
      z = std::max(z - k_fastest_mm, out.proxy_mm.z - owed_mm - load_n / out.stiffness_n_per_mm);
    if (depth_mm < bench.from_mm) continue;
    if (begin_s < 0) begin_s = t_s, first_mm = depth_mm;
    rpm_sum += out.rpm;
    torque_sum += state.handpiece.load_n_mm;
    ++counted;
    if (edit == state.tooth.edit_hash()) continue;
    last_mm3 = ground_away_mm3(
        bench.block.octree, state.tooth);  // only complete carves: between two, volume stands still
    last_mm3_s = t_s;
    if (first_mm3 < 0) first_mm3 = last_mm3, first_mm3_s = t_s;
  }
  row.sunk = begin_s >= 0 && last_mm3_s > first_mm3_s && depth_mm >= first_mm + k_grind_window_mm;
  row.rpm = counted > 0 ? rpm_sum / counted : out.rpm;
  row.torque_n_mm = counted > 0 ? torque_sum / counted : state.handpiece.load_n_mm;
  if (!row.sunk) return row;
  row.depth_mm_s = (depth_mm - first_mm) / (t_s - begin_s);
  row.mm3_per_min = k_seconds_per_min * (last_mm3 - first_mm3) / (last_mm3_s - first_mm3_s);
  return row;
}

GrindResult run_grind_rig(const ForceModel& force, const Bur& bur, const GrindOptions& options) {
  GrindResult result{.options = options, .model = force.name, .bur = bur.title, .rows = {}};
  for (const auto& [name, material] : force.materials) {
    if (!(material.tau_s > 0 || material.wear_mm3_per_n_m > 0)) continue;
    for (const double load_n : options.load_n)
      result.rows.push_back(grind(force, bur, name, load_n, options));
  }
  return result;
}

Lines to_text(const GrindResult& r) {
  Lines out;
  const Number rpm = as_unit(r.options.rpm, Unit::rpm, 0);
  out.add(r.options.side ? msg("{}, {} on its side, {} free", r.model, Term{r.bur}, rpm)
                         : msg("{}, {} on its end, {} free", r.model, Term{r.bur}, rpm));
  out.row({msg("tissue"), msg("load, N"), msg("rpm"), msg("torque, N mm"), msg("depth, mm/s"),
           msg("mm³/min")},
          2);
  for (const GrindRow& row : r.rows)
    out.row({msg("{}", Term{row.tissue}), msg("{}", as_number(row.load_n, 2)),
             msg("{}", as_number(row.rpm, 0)), msg("{}", as_number(row.torque_n_mm, 3)),
             row.sunk ? msg("{}", as_number(row.depth_mm_s, 4)) : msg("does not sink in"),
             row.sunk ? msg("{}", as_number(row.mm3_per_min, 2)) : Message()},
            2);
  return out;
}

nlohmann::json to_json(const GrindResult& r) {
  nlohmann::json rows = nlohmann::json::array();
  for (const GrindRow& row : r.rows)
    rows.push_back({{"tissue", row.tissue},
                    {"load_n", row.load_n},
                    {"rpm", row.rpm},
                    {"torque_n_mm", row.torque_n_mm},
                    {"sunk", row.sunk},
                    {"depth_mm_s", row.depth_mm_s},
                    {"mm3_per_min", row.mm3_per_min}});
  return {{"model", r.model},
          {"bur", r.bur},
          {"side", r.options.side},
          {"free_rpm", r.options.rpm},
          {"rows", rows}};
}

}  // namespace cavum
