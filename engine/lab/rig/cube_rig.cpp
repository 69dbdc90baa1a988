#include "engine/lab/rig/cube_rig.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "engine/base/independent_runs.h"
#include "engine/tooth/make/make_block.h"

namespace cavum {
namespace {

constexpr double k_cube_mm = 10.0, k_leaf_mm = 0.05;
constexpr double k_air_mm =
    0.3;  // before contact: long enough for the handpiece to reach its speed
constexpr double k_window_s = 2.0;        // the steady force is a mean over the end of a run
constexpr double k_time_constants = 6.0;  // after five the force is within 1 % of its end
constexpr double k_steady = 0.1;          // a cut whose X is further than this from V·τ is none
constexpr int k_record_every = 10;        // ticks: 100 Hz
constexpr const char* k_tissue = "dentin";

struct Job {
  std::size_t set = 0, row = 0, run = 0;
};

/// The same for every model, so that two models are tried at the same places; of its own for every
/// k and run.
std::uint64_t seed_of(const CubeOptions& o, double k_n_per_mm, std::size_t run) {
  const auto k = static_cast<std::uint64_t>(k_n_per_mm * 1e6 + 0.5);
  return Random(o.seed + Random(k).next() + 7919 * run).next();
}

CubeRun run_once(const ServoModel& servo, const Tooth& cube, const CubeOptions& o,
                 const CubeRow& row, double tau_s, std::size_t number, bool recorded) {
  Random random(seed_of(o, row.k_n_per_mm, number));
  constexpr double k_off_centre_mm = 1.0;
  const Vec3 start{random.uniform(-k_off_centre_mm, k_off_centre_mm),
                   random.uniform(-k_off_centre_mm, k_off_centre_mm),
                   k_air_mm + random.uniform(0.0, 0.1)};
  TestingMachine machine(servo, cube, start, o.machine, random);
  const auto ticks =
      static_cast<int>((start.z / o.machine.speed_mm_s + row.seconds) / servo.config.tick_s);
  const int window = std::min(ticks, static_cast<int>(k_window_s / servo.config.tick_s));
  CubeRun run;
  run.start_mm = start;
  run.friction_n =
      o.machine.omni.coulomb_n + o.machine.omni.viscous_n_s_per_mm * o.machine.speed_mm_s;
  double removed = 0.0;
  std::vector<double> force, time, ones(static_cast<std::size_t>(window), 1.0);
  for (int i = 0; i < ticks; ++i) {
    const MachineReading& r = machine.tick();
    removed += r.servo.removed_count * cube.octree.leaf_volume_mm3();
    run.notices |= r.servo.notices;
    if (i >= ticks - window) {
      force.push_back(r.force_n);
      time.push_back(r.t_s);
      run.penetration_mm += r.servo.penetration_mm / window;
    }
    if (recorded && i % k_record_every == 0)
      run.recording.push_back({r.t_s, r.servo.contact ? r.servo.penetration_mm : -r.crosshead_mm,
                               o.machine.speed_mm_s, r.force_n, r.servo.rpm, removed});
  }
  run.mean_n = mean_sd(force).mean;
  run.steady = std::fabs(run.penetration_mm / (o.machine.speed_mm_s * tau_s) - 1.0) <= k_steady;
  const std::vector<double> columns[] = {time, ones};
  run.trend_n_per_s = fit_columns(columns, force).value[0];
  return run;
}

void summarise(CubeRow& row) {
  std::vector<double> with, without, x;
  for (const CubeRun& r : row.runs) {
    row.notices |= r.notices;
    if (!r.steady) {
      ++row.left_out;
      continue;
    }
    with.push_back(r.mean_n);
    without.push_back(r.mean_n - r.friction_n);
    x.push_back(r.penetration_mm);
    row.trend_n_per_s = std::max(row.trend_n_per_s, std::fabs(r.trend_n_per_s));
  }
  row.with = mean_sd(with);
  row.without = mean_sd(without);
  row.penetration = mean_sd(x);
}

CubeFit fit(const std::vector<CubeRow>& rows, bool friction) {
  std::vector<std::vector<double>> columns(3);
  std::vector<double> y;
  for (const CubeRow& row : rows)
    for (const CubeRun& r : row.runs) {
      if (!r.steady) continue;
      columns[0].push_back(row.k_n_per_mm);
      columns[1].push_back(1.0);
      columns[2].push_back(std::sqrt(row.k_n_per_mm));
      y.push_back(r.mean_n - (friction ? 0.0 : r.friction_n));
    }
  CubeFit out;
  out.line = fit_columns(std::span(columns).first(2), y);
  out.with_root = fit_columns(columns, y);
  for (const CubeRow& row : rows)
    if (row.left_out < static_cast<int>(row.runs.size()))
      out.bend_n =
          std::max(out.bend_n, std::fabs((friction ? row.with : row.without).mean -
                                         out.line.value[0] * row.k_n_per_mm - out.line.value[1]));
  return out;
}

}  // namespace

CubeResult run_cube_rig(const std::vector<CubeModel>& models, const Bur& bur,
                        const CubeOptions& options) {
  CubeResult result;
  result.options = options;
  const Tooth cube = make_cube(k_cube_mm, k_tissue, k_leaf_mm);
  std::vector<std::vector<ServoModel>> servos;
  std::vector<Job> jobs;
  for (const CubeModel& m : models) {
    require_penetration(m.force);
    CubeSet set;
    set.name = m.name;
    servos.emplace_back();
    for (const double k : options.k_n_per_mm) {
      const ForceModel force = with_stiffness(m.force, k_tissue, k);
      const Material& material = force.materials.find(k_tissue)->second;
      const Material& own = m.force.materials.find(k_tissue)->second;
      set.damping_ratio = own.voigt.damping_n_s_per_mm / std::sqrt(own.voigt.stiffness_n_per_mm);
      set.tau_s = material.tau_s;
      servos.back().push_back(machine_servo(cube, bur, force, options.machine.omni));
      CubeRow row;
      row.k_n_per_mm = k;
      row.c_n_s_per_mm = material.voigt.damping_n_s_per_mm;
      const double branch_s =
          force.rendering.kvc_n_per_mm > 0 ? row.c_n_s_per_mm / force.rendering.kvc_n_per_mm : 0.0;
      row.seconds = k_time_constants * std::max(material.tau_s, branch_s);
      row.depth_mm = row.seconds * options.machine.speed_mm_s;
      if (row.depth_mm > k_cube_mm)
        throw Error(msg("force model '{}'", m.name),
                    msg("needs {} of feed until the force is steady, the cube has 10",
                        as_mm(row.depth_mm, k_as_needed)),
                    msg("lower tau_s or c_n_s_per_mm"));
      row.expected_n = (k * material.tau_s + row.c_n_s_per_mm) * options.machine.speed_mm_s;
      row.runs.resize(static_cast<std::size_t>(options.runs));
      for (std::size_t i = 0; i < row.runs.size(); ++i)
        jobs.push_back({result.sets.size(), set.rows.size(), i});
      set.rows.push_back(std::move(row));
    }
    result.sets.push_back(std::move(set));
  }
  independent_runs(jobs.size(), [&](std::size_t j) {
    const Job& job = jobs[j];
    CubeRow& row = result.sets[job.set].rows[job.row];
    const bool recorded =
        job.set == 0 && std::fabs(row.k_n_per_mm - options.recorded_k_n_per_mm) < 1e-9;
    row.runs[job.run] = run_once(servos[job.set][job.row], cube, options, row,
                                 result.sets[job.set].tau_s, job.run, recorded);
  });
  for (CubeSet& set : result.sets) {
    for (CubeRow& row : set.rows) summarise(row);
    set.with = fit(set.rows, true);
    set.without = fit(set.rows, false);
  }
  return result;
}

}  // namespace cavum
