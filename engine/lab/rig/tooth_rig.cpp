#include "engine/lab/rig/tooth_rig.h"

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "engine/base/independent_runs.h"
#include "engine/lab/rig/rig_error.h"

namespace cavum {
namespace {

constexpr double k_approach_mm =
    0.3;  // before contact: long enough for the handpiece to reach its speed
constexpr double k_beyond_mm = 3.0;  // past the pulp's roof: then it is given up
constexpr double k_chamber_mm =
    1.0;  // pulp at least this high is a chamber, less a canal seen across
constexpr double k_sample_s = 0.01;      // 100 Hz
constexpr double k_around_pulp_s = 4.0;  // shown before the fall
constexpr double k_mean_s = 0.5, k_settled_s = 2.0;
constexpr double k_held = 2.0;  // times V·τ

/// What a vertical line through the tooth meets, from above.
struct Column {
  bool over_pulp = false;
  double top_mm = 0, roof_mm = 0,
         height_mm = 0;  ///< z of the surface; z of the pulp's roof; height of the pulp
};

Column column(const Octree& tooth, std::int32_t x, std::int32_t y) {
  Column c;
  const auto z_mm = [&](std::int32_t z) { return tooth.origin_mm().z + (z + 1) * tooth.leaf_mm(); };
  std::int32_t z = tooth.size().z - 1;
  while (z >= 0 && !tooth.is_solid(tooth.tissue({x, y, z}))) --z;
  if (z < 0) return c;
  c.top_mm = z_mm(z);
  while (z >= 0 && tooth.is_solid(tooth.tissue({x, y, z}))) --z;
  if (z < 0 || tooth.tissue({x, y, z}) != k_pulp) return c;
  c.roof_mm = z_mm(z);
  c.over_pulp = true;
  for (; z >= 0 && tooth.tissue({x, y, z}) == k_pulp; --z) c.height_mm += tooth.leaf_mm();
  return c;
}

Column column_at(const Octree& tooth, double x_mm, double y_mm) {
  const IVec3 leaf = tooth.leaf_at({x_mm, y_mm, tooth.origin_mm().z});
  return column(tooth, leaf.x, leaf.y);
}

/// Middle of all places over a pulp chamber; of those, the one nearest to it.
std::pair<double, double> middle_of_roof(const Octree& tooth) {
  std::vector<Vec3> places;  // x, y, height of the pulp
  double highest = 0.0;
  for (std::int32_t y = 0; y < tooth.size().y; ++y)
    for (std::int32_t x = 0; x < tooth.size().x; ++x) {
      const Column c = column(tooth, x, y);
      if (!c.over_pulp) continue;
      const Vec3 at = tooth.centre_mm({x, y, 0});
      places.push_back({at.x, at.y, c.height_mm});
      highest = std::max(highest, c.height_mm);
    }
  const double least = std::min(k_chamber_mm, 0.5 * highest);
  std::erase_if(places, [&](Vec3 p) { return p.z < least; });
  if (places.empty())
    throw Error(RigError::no_pulp, msg("tooth"), msg("has no pulp under solid tissue"),
                msg("take another tooth"));
  Vec3 sum;
  for (const Vec3 p : places) sum += p / static_cast<double>(places.size());
  const auto far = [&](Vec3 p) {
    return (p.x - sum.x) * (p.x - sum.x) + (p.y - sum.y) * (p.y - sum.y);
  };
  const Vec3 best = *std::min_element(places.begin(), places.end(),
                                      [&](Vec3 a, Vec3 b) { return far(a) < far(b); });
  return {best.x, best.y};
}

/// The first tissue at or below a place.
std::uint8_t tissue_below(const Octree& tooth, Vec3 at_mm) {
  for (IVec3 leaf = tooth.leaf_at(at_mm); leaf.z >= 0; --leaf.z)
    if (const std::uint8_t t = tooth.tissue(leaf); t != k_air) return t;
  return k_air;
}

/// Surface under the whole head, so that the tip starts in the air.
double highest_under_mm(const Octree& tooth, double x_mm, double y_mm, double radius_mm) {
  double top = -1e9;
  const int n = static_cast<int>(std::ceil(radius_mm / tooth.leaf_mm()));
  const IVec3 at = tooth.leaf_at({x_mm, y_mm, tooth.origin_mm().z});
  for (int dy = -n; dy <= n; ++dy)
    for (int dx = -n; dx <= n; ++dx) {
      const IVec3 leaf{at.x + dx, at.y + dy, 0};
      if (leaf.x < 0 || leaf.y < 0 || leaf.x >= tooth.size().x || leaf.y >= tooth.size().y)
        continue;
      std::int32_t z = tooth.size().z - 1;
      while (z >= 0 && !tooth.is_solid(tooth.tissue({leaf.x, leaf.y, z}))) --z;
      if (z >= 0) top = std::max(top, tooth.origin_mm().z + (z + 1) * tooth.leaf_mm());
    }
  return top;
}

double mean_between(const ToothRun& run, double from_s, double to_s) {
  double sum = 0.0;
  int n = 0;
  for (const auto& s : run.samples)
    if (s.t_s >= from_s && s.t_s < to_s) sum += s.f_n, ++n;
  return n > 0 ? sum / n : 0.0;
}

/// Before, after, and how long the fall took; the force is smoothed over a quarter of a second,
/// which the encoder's steps last.
void measure_fall(ToothRun& run) {
  run.before_n =
      mean_between(run, run.pulp_s - 2 * k_mean_s,
                   run.pulp_s - k_mean_s);  // the head's rim feels the pulp before the tip does
  run.after_n = mean_between(run, run.pulp_s + k_settled_s, run.pulp_s + k_settled_s + k_mean_s);
  constexpr double k_half_s = 0.125;
  const double fall = run.before_n - run.after_n;
  double start = run.pulp_s;
  for (const auto& s : run.samples) {
    if (s.t_s < run.pulp_s - k_mean_s) continue;
    const double smooth = mean_between(run, s.t_s - k_half_s, s.t_s + k_half_s);
    if (smooth > run.before_n - 0.1 * fall) start = s.t_s;
    if (smooth < run.before_n - 0.9 * fall) {
      run.fall_s = s.t_s - start;
      return;
    }
  }
}

void mean_by_tissue(const Tooth& tooth, ToothRun& run) {
  for (const auto& s : run.samples) {
    const std::string name = tooth.tissue_name(s.tissue);
    if (std::none_of(run.tissue_mean_n.begin(), run.tissue_mean_n.end(),
                     [&](const auto& t) { return t.first == name; })) {
      double sum = 0.0;
      int n = 0;
      for (const auto& other : run.samples)
        if (other.tissue == s.tissue) sum += other.f_n, ++n;
      run.tissue_mean_n.emplace_back(name, sum / n);
    }
  }
}

ToothRun run_once(const ServoModel& servo, const Tooth& tooth, const ToothRigOptions& o,
                  std::pair<double, double> middle, std::uint64_t seed) {
  Random random(seed);
  ToothRun run;
  Column c;
  for (int tries = 0;; ++tries) {  // uniform in the disc, over pulp
    const double dx = random.uniform(-o.spread_mm, o.spread_mm),
                 dy = random.uniform(-o.spread_mm, o.spread_mm);
    run.x_mm = middle.first + dx;
    run.y_mm = middle.second + dy;
    c = column_at(tooth.octree, run.x_mm, run.y_mm);
    if (dx * dx + dy * dy <= o.spread_mm * o.spread_mm && c.over_pulp) break;
    if (tries > 2000)
      throw Error(RigError::no_pulp, msg("tooth"),
                  msg("has no pulp under solid tissue around the chosen place"),
                  msg("name another with --at"));
  }
  const double start_mm =
      highest_under_mm(tooth.octree, run.x_mm, run.y_mm, servo.tray[0].bur.head_radius_mm) +
      k_approach_mm;
  TestingMachine machine(servo, tooth, {run.x_mm, run.y_mm, start_mm}, o.machine, random);
  const double dt = servo.config.tick_s;
  double slowest_s = 0.0;
  for (const auto& t : tooth.tissues)
    if (const auto m = servo.force.materials.find(t.name); m != servo.force.materials.end())
      slowest_s = std::max(slowest_s, m->second.tau_s);
  const double steady_mm = o.machine.speed_mm_s * slowest_s;
  const auto most =
      static_cast<std::int64_t>((start_mm - c.roof_mm + k_beyond_mm) / (o.machine.speed_mm_s * dt));
  const int every = static_cast<int>(k_sample_s / dt + 0.5);
  bool touched = false;
  std::int64_t since = 0;
  for (std::int64_t i = 0; i < most; ++i) {
    const MachineReading& r = machine.tick();
    run.notices |= r.servo.notices;
    if (!touched && r.servo.contact) {
      touched = true;
      run.first_tissue_s = r.t_s;
    }
    if (!touched) continue;
    const double t = r.t_s - run.first_tissue_s;
    const std::uint8_t tissue =
        tissue_below(tooth.octree, r.servo.proxy_mm - Vec3{0, 0, 0.5 * tooth.octree.leaf_mm()});
    run.held = run.held || r.servo.penetration_mm > k_held * steady_mm;
    if (!run.reached_pulp && tissue == k_pulp) {
      run.reached_pulp = true;
      run.pulp_s = t;
    }
    if (since++ % every == 0) run.samples.push_back({t, r.force_n, tissue});
    if (run.reached_pulp && t > run.pulp_s + o.after_s) break;
  }
  if (run.reached_pulp) measure_fall(run);
  mean_by_tissue(tooth, run);
  return run;
}

/// Means over the runs in steps of 0.05 s, where at least half of the runs have a reading.
std::vector<BandPoint> band(const std::vector<ToothRun>& runs, bool at_pulp, double from_s,
                            double to_s) {
  constexpr double k_step_s = 0.05;
  std::vector<std::vector<double>> bins(static_cast<std::size_t>((to_s - from_s) / k_step_s));
  for (const auto& run : runs) {
    std::vector<std::pair<double, int>> sums(bins.size());
    for (const auto& s : run.samples) {
      const double at = (s.t_s - (at_pulp ? run.pulp_s : 0.0) - from_s) / k_step_s;
      if (at < 0 || at >= static_cast<double>(bins.size())) continue;
      auto& bin = sums[static_cast<std::size_t>(at)];
      bin.first += s.f_n;
      ++bin.second;
    }
    for (std::size_t i = 0; i < bins.size(); ++i)
      if (sums[i].second > 0) bins[i].push_back(sums[i].first / sums[i].second);
  }
  std::vector<BandPoint> points;
  for (std::size_t i = 0; i < bins.size(); ++i)
    if (!bins[i].empty() && 2 * bins[i].size() >= runs.size())
      points.push_back({from_s + (static_cast<double>(i) + 0.5) * k_step_s, mean_sd(bins[i]),
                        static_cast<int>(bins[i].size())});
  return points;
}

std::vector<ToothLayer> layers_of(const Tooth& tooth, const std::vector<ToothRun>& runs) {
  std::vector<ToothLayer> layers;
  for (const auto& run : runs)
    for (const auto& [name, force] : run.tissue_mean_n)
      if (std::none_of(layers.begin(), layers.end(),
                       [&, n = name](const ToothLayer& l) { return l.tissue == n; }))
        layers.push_back({name, {}, {}, {}});
  for (auto& layer : layers) {
    std::vector<double> from, to, force;
    for (const auto& run : runs) {
      const auto is = [&](const ToothSample& s) {
        return tooth.tissue_name(s.tissue) == layer.tissue;
      };
      const auto first = std::find_if(run.samples.begin(), run.samples.end(), is);
      if (first == run.samples.end()) continue;
      from.push_back(first->t_s);
      to.push_back(std::find_if(run.samples.rbegin(), run.samples.rend(), is)->t_s);
      for (const auto& t : run.tissue_mean_n)
        if (t.first == layer.tissue) force.push_back(t.second);
    }
    layer.from_s = mean_sd(from);
    layer.to_s = mean_sd(to);
    layer.force_n = mean_sd(force);
  }
  return layers;
}

}  // namespace

ToothRigResult run_tooth_rig(const Tooth& tooth, const ForceModel& force, const Bur& bur,
                             const ToothRigOptions& options) {
  require_penetration(force);
  ToothRigResult result;
  result.options = options;
  result.tooth = tooth.name;
  result.model = force.name;
  result.bur = bur.title;
  const ServoModel servo = machine_servo(tooth, bur, force, options.machine.omni);
  const auto middle = options.at_mm ? *options.at_mm : middle_of_roof(tooth.octree);
  result.options.at_mm = middle;
  result.runs.resize(static_cast<std::size_t>(options.runs));
  independent_runs(result.runs.size(), [&](std::size_t i) {
    result.runs[i] =
        run_once(servo, tooth, options, middle, Random(options.seed + 7919 * i).next());
  });
  std::vector<double> pulp, before, after, fall;
  std::vector<ToothRun> counted;
  double longest = 0.0;
  for (const auto& run : result.runs) {
    if (!run.reached_pulp || run.held) continue;
    longest = std::max(longest, run.samples.back().t_s);
    counted.push_back(run);
    pulp.push_back(run.pulp_s);
    before.push_back(run.before_n);
    after.push_back(run.after_n);
    fall.push_back(run.fall_s);
  }
  result.counted = static_cast<int>(counted.size());
  result.pulp_s = mean_sd(pulp);
  result.before_n = mean_sd(before);
  result.after_n = mean_sd(after);
  result.fall_s = mean_sd(fall);
  result.from_contact = band(counted, false, 0.0, longest);
  result.around_pulp = band(counted, true, -k_around_pulp_s, options.after_s);
  result.layers = layers_of(tooth, counted);
  return result;
}

}  // namespace cavum
