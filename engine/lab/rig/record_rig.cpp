#include "engine/lab/rig/record_rig.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "engine/base/independent_runs.h"
#include "engine/tooth/make/make_block.h"

namespace cavum {
namespace {

constexpr double k_cube_mm = 10.0, k_leaf_mm = 0.05, k_deepest_mm = 3.0;
constexpr double k_air_mm = 0.05;      // height from which the crosshead may follow the surface
constexpr double k_follow_mm_s = 0.5;  // at most
constexpr double k_held_n = 1e-3;
constexpr double k_upright = 0.7;  // of the contact normal along the feed
constexpr const char* k_tissue = "dentin";

std::vector<RecordRow> session_rows(const Motion& motion, const ServoModel& servo,
                                    const Tooth& cube, const RecordOptions& o, int session,
                                    Random random) {
  const Vec3 place{random.uniform(-2.0, 2.0), random.uniform(-2.0, 2.0), 0.0};
  const double dt = servo.config.tick_s;
  double surface = 0.0, offset = 0.0, removed = 0.0;
  double z = motion.at(0.0).pose.tip_mm.z;
  ServoState state = make_servo_state(servo, cube, {place.x, place.y, z});
  TickInput input;
  std::vector<RecordRow> rows;
  const auto every = std::max<std::int64_t>(1, std::llround(1.0 / (o.rate_hz * dt)));
  const auto ticks = static_cast<std::int64_t>(motion.duration_s() / dt);
  double before =
      z;  // a row ago: the speed is the mean over a row, as a crosshead's encoder gives it
  for (std::int64_t tick = 0; tick < ticks; ++tick) {
    const MotionSample sample = motion.at(static_cast<double>(tick + 1) * dt);
    const double height = sample.pose.tip_mm.z;
    if (height > k_air_mm)
      offset += std::clamp(surface - offset, -k_follow_mm_s * dt, k_follow_mm_s * dt);
    z = height + offset;
    input = make_tick_input({{place.x, place.y, z}, {}}, sample.pedal,
                            k_stylus_fresh | k_pedal_fresh, 0, input);
    const TickOutput out = step(servo, state, input);
    removed += out.removed_count * cube.octree.leaf_volume_mm3();
    // walls and rim of the hole that it cut touch the head too, without a force along the feed; its
    // bottom never rises
    const bool pressed = out.contact && out.normal.z > k_upright && out.penetration_mm > 0.0 &&
                         z + out.penetration_mm < surface + k_leaf_mm;
    if (pressed) surface = z + out.penetration_mm;
    if (tick % every != 0) continue;
    const bool held =
        out.contact && !pressed &&
        std::fabs(out.rendered_force_n.z) > k_held_n;  // by the rim: not along the feed, left out
    const double v = tick == 0 ? 0.0 : (before - z) / (static_cast<double>(every) * dt);
    if (!held)
      rows.push_back({session, static_cast<double>(tick) * dt,
                      pressed ? out.penetration_mm : std::min(0.0, surface - z),
                      out.rendered_force_n.z + o.noise_n * random.normal(), v, out.rpm, removed});
    before = z;
  }
  return rows;
}

}  // namespace

RecordResult run_record_rig(const Motion& motion, const ForceModel& force, const Bur& bur,
                            const RecordOptions& options) {
  const auto material = force.materials.find(k_tissue);
  if (material == force.materials.end())
    throw Error(msg("force model '{}'", force.name), msg("has no material '{}'", k_tissue),
                msg("add [materials.{}]", k_tissue));
  for (const auto& s : motion.samples)
    if (s.pose.tip_mm.z < -k_deepest_mm)
      throw Error(msg("motion"),
                  msg("goes {} below the surface", as_mm(-s.pose.tip_mm.z, k_as_needed)),
                  msg("stay above 3 mm: z is the height over the cube"));
  const Tooth cube = make_cube(k_cube_mm, k_tissue, k_leaf_mm);
  const ServoModel servo = make_servo_model(cube, {bur}, force, {});
  RecordResult result;
  result.k_n_per_mm = material->second.voigt.stiffness_n_per_mm;
  result.c_n_s_per_mm = material->second.voigt.damping_n_s_per_mm;
  result.force_limit_n = servo.config.limits.peak_n;
  std::vector<std::vector<RecordRow>> sessions(static_cast<std::size_t>(options.sessions));
  independent_runs(sessions.size(), [&](std::size_t s) {
    sessions[s] = session_rows(motion, servo, cube, options, static_cast<int>(s) + 1,
                               Random(Random(options.seed + 7919 * s).next()));
  });
  double worn = 0.0;  // the bur stays: what it removed goes on from session to session
  for (auto& rows : sessions) {
    for (auto& row : rows) {
      row.removed_mm3 += worn;
      result.rows.push_back(row);
    }
    worn = rows.empty() ? worn : rows.back().removed_mm3;
  }
  return result;
}

std::string record_csv(const RecordResult& r) {
  std::string out = "session,t_s,x_mm,f_n,v_mm_s,spindle_rpm,removed_mm3\n";
  for (const auto& row : r.rows)
    out += fmt::format("{},{:.3f},{:.5f},{:.4f},{:.4f},{:.0f},{:.3f}\n", row.session, row.t_s,
                       row.x_mm, row.f_n, row.v_mm_s, row.rpm, row.removed_mm3);
  return out;
}

std::string record_rig_toml(const RecordResult& r) {
  return fmt::format(
      "# Virtual testing machine (cavum rig record): cubes of dentin, load cell under the cube.\n"
      "# The surface recedes while it is cut: x_mm is the penetration into what is left, v_mm_s the way of the tip.\n"
      "k_n_per_mm = {:.12g}\nc_n_s_per_mm = {:.12g}\nforce_quantum_n = 0.0001\nforce_limit_n = {:.12g}\n",
      r.k_n_per_mm, r.c_n_s_per_mm, r.force_limit_n);
}

}  // namespace cavum
