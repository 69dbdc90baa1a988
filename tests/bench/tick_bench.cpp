// How long a tick takes: contact, force and cutting in steady drilling, out of contact, for every
// bur and leaf, beside what open drilling simulators do (a dense scan of the tool's bounding box)
// in the same run.
//
// Each drilling is repeated five times. The first row holds all ticks as they were timed; "least of
// 5" holds for each tick the least of its five times. The step is deterministic: tick n does the
// same work each time, so what is above the least was done by something else on the machine. How
// often and how long that stops a thread which does nothing but ask for the time is printed first.
//   tick_bench [TICKS [TOOTH.cvt]]   times; with a tooth file also on that tooth
//   tick_bench count LEAF [SET]      drills 2000 ticks in a block, for valgrind --tool=callgrind
//   --toggle-collect='cavum::step*'
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <optional>

#include "engine/base/error.h"
#include "engine/tooth/make/make_block.h"
#include "tests/bench/thread_clock.h"
#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;
/// What asking itself adds to each figure, us.
double clock_cost_us() {
  double least = 1e9;
  for (int i = 0; i < 1000; ++i) {
    const double begin = thread_us();
    least = std::min(least, thread_us() - begin);
  }
  return least;
}

/// How often and how long the machine holds up a thread that only asks for its processor time.
void print_stalls() {
  constexpr double k_watched_us = 5e5, k_stall_us = 10.0;
  std::vector<double> stalls;
  const double begin = thread_us();
  for (double last = begin; last - begin < k_watched_us;) {
    const double now = thread_us();
    if (now - last > k_stall_us) stalls.push_back(now - last);
    last = now;
  }
  std::sort(stalls.begin(), stalls.end());
  std::printf(
      "the machine holds up a thread that does nothing %.0f times in a second of processor time",
      1e6 / k_watched_us * static_cast<double>(stalls.size()));
  if (!stalls.empty())
    std::printf(", for %.0f us in the median and %.0f at most", stalls[stalls.size() / 2],
                stalls.back());
  std::printf("\n");
}

struct Quantiles {
  double median_us, p99_us, p999_us, worst_us, mean_us;
};
Quantiles quantiles(std::vector<double> us) {
  std::sort(us.begin(), us.end());
  const auto at = [&](double q) {
    return us[std::min(us.size() - 1,
                       static_cast<std::size_t>(q * static_cast<double>(us.size())))];
  };
  double sum = 0;
  for (const double v : us) sum += v;
  return {at(0.5), at(0.99), at(0.999), us.back(), sum / static_cast<double>(us.size())};
}

/// Drills straight down at 0.25 mm/s from `top`, timing each tick from the third second on.
std::vector<double> drill(const Tooth& tooth, const Bur& bur, Vec3 top, int ticks,
                          const char* set = "consistent") {
  const Vec3 start = top + Vec3{0, 0, 0.05};
  Rig rig(tooth, {bur}, shipped_model(set), start);
  rig.spin_up(start);
  double z = start.z;
  std::vector<double> us;
  const int warm = 2600;
  for (int i = 0; i < warm + ticks; ++i) {
    z -= 0.25e-3;
    rig.input = make_tick_input({{start.x, start.y, z}, {}}, 1.0, k_stylus_fresh | k_pedal_fresh, 0,
                                rig.input);
    const double begin = thread_us();
    (void)step(rig.model, rig.state, rig.input);
    if (i >= warm) us.push_back(thread_us() - begin);
  }
  return us;
}

/// Slides to and fro over a block at `speed_mm_s`, 0.3 mm deeper each second, at ticks of 0.25 ms;
/// `sways` as in a hand, by 0.001 rad from tick to tick.
std::vector<double> slide(const Tooth& tooth, const Bur& bur, double speed_mm_s, bool sways,
                          int ticks) {
  constexpr double k_tick = 0.25e-3, k_half_mm = 1.2;
  const Vec3 start{-k_half_mm, 0, 0.05};
  Rig rig(tooth, {bur}, shipped_model("consistent"), start, k_tick);
  rig.spin_up(start);
  Random random(1);
  std::vector<double> us;
  for (int i = 0; i < ticks; ++i) {
    const double t = i * k_tick, way = std::fmod(speed_mm_s * t, 4 * k_half_mm);
    const Vec3 at{way < 2 * k_half_mm ? way - k_half_mm : 3 * k_half_mm - way, 0,
                  start.z - 0.3 * t};
    const Quat turned =
        sways ? normalized(Quat{1, random.uniform(-0.001, 0.001), random.uniform(-0.001, 0.001), 0})
              : Quat{};
    rig.input = make_tick_input({at, turned}, 1.0, k_stylus_fresh | k_pedal_fresh, 0, rig.input);
    const double begin = thread_us();
    (void)step(rig.model, rig.state, rig.input);
    us.push_back(thread_us() - begin);
  }
  return us;
}

constexpr int k_repeats = 5;
/// All ticks of equal motions, and the least time of each tick.
struct Repeated {
  std::vector<double> all_us, least_us;
};
Repeated repeatedly(const std::function<std::vector<double>()>& motion) {
  Repeated r;
  for (int i = 0; i < k_repeats; ++i) {
    const auto us = motion();
    r.all_us.insert(r.all_us.end(), us.begin(), us.end());
    if (i == 0) r.least_us = us;
    for (std::size_t k = 0; k < us.size(); ++k) r.least_us[k] = std::min(r.least_us[k], us[k]);
  }
  return r;
}
Repeated drill_repeatedly(const Tooth& tooth, const Bur& bur, Vec3 top, int ticks) {
  return repeatedly([&] { return drill(tooth, bur, top, ticks); });
}

std::vector<double> in_air(const Tooth& tooth, const Bur& bur, double top_mm, int ticks) {
  const Vec3 start{0, 0, top_mm + 8};
  Rig rig(tooth, {bur}, shipped_model("consistent"), start);
  std::vector<double> us;
  for (int i = 0; i < ticks; ++i) {
    rig.input = make_tick_input({{0.002 * (i % 1000), 0, start.z}, {}}, 1.0,
                                k_stylus_fresh | k_pedal_fresh, 0, rig.input);
    const double begin = thread_us();
    (void)step(rig.model, rig.state, rig.input);
    us.push_back(thread_us() - begin);
  }
  return us;
}

void line(const char* what, const Quantiles& q) {
  std::printf("%-44s median %7.2f  p99 %7.2f  p99.9 %7.2f  worst %8.2f  mean %7.2f us\n", what,
              q.median_us, q.p99_us, q.p999_us, q.worst_us, q.mean_us);
}

/// Both rows of a drilling; gives the quantiles of the least times.
Quantiles lines(const char* what, const Repeated& r) {
  line(what, quantiles(r.all_us));
  const auto least = quantiles(r.least_us);
  line("  least of 5", least);
  return least;
}

/// What open drilling simulators do each tick: every leaf in the box of the tool, on a dense grid,
/// asked whether the tool holds it.
double dense_scan_us(const TissueGrid& grid, const Bur& bur, Vec3 tip, volatile long& found) {
  const double r = bur.head_radius_mm, leaf = grid.leaf_mm;
  const double begin = thread_us();
  const auto index = [&](double mm, double origin) {
    return static_cast<int>((mm - origin) / leaf);
  };
  for (int z = index(tip.z, grid.origin_mm.z);
       z <= index(tip.z + bur.cutting_length_mm, grid.origin_mm.z); ++z)
    for (int y = index(tip.y - r, grid.origin_mm.y); y <= index(tip.y + r, grid.origin_mm.y); ++y)
      for (int x = index(tip.x - r, grid.origin_mm.x); x <= index(tip.x + r, grid.origin_mm.x);
           ++x) {
        if (!grid.inside({x, y, z}) || grid.tissue[grid.index({x, y, z})] == k_air) continue;
        const Vec3 d = grid.centre_mm({x, y, z}) - tip;
        if (bur.head_distance_mm(d) < 0) found = found + 1;
      }
  return thread_us() - begin;
}

}  // namespace
}  // namespace cavum

namespace cavum {
namespace {

int usage() {
  std::fprintf(
      stderr,
      "tick_bench: use [TICKS [TOOTH.cvt]], 100 to 1000000 ticks, or count LEAF [SET], 0.02 to 0.5 mm\n");
  return 2;
}

int run(int argc, char** argv) {
  const Bur ball = testing_engine::shipped_bur("round-1.0");
  const auto block = [](double leaf) { return make_block({4, 4, 5.6}, {{"enamel", 5.6}}, leaf); };
  if (argc > 2 && std::strcmp(argv[1], "count") == 0) {
    if (!(std::atof(argv[2]) >= 0.02 && std::atof(argv[2]) <= 0.5)) return usage();
    (void)drill(block(std::atof(argv[2])), ball, {0, 0, 0}, 2000,
                argc > 3 ? argv[3] : "consistent");
    return 0;
  }
  const int ticks = argc > 1 ? std::atoi(argv[1]) : 8000;
  if (ticks < 100 || ticks > 1000000) return usage();
  std::optional<Tooth> real;
  if (argc > 2) real = load_tooth_file(argv[2]);
  std::printf("time on the processor; asking for it adds %.2f us to each tick\n", clock_cost_us());
  print_stalls();
  Quantiles at_005{}, least_at_005{};
  for (const double leaf : {0.1, 0.05, 0.025}) {
    const Tooth tooth = block(leaf);
    char what[80];
    std::snprintf(what, sizeof what, "block, round-1.0, leaf %.3f mm", leaf);
    const auto timed = drill_repeatedly(tooth, ball, {0, 0, 0}, ticks);
    const auto all = quantiles(timed.all_us), q = lines(what, timed);
    if (leaf == 0.025)
      std::printf(
          "  leaf 0.025 over leaf 0.05: median %.2f, mean %.2f; of the least times %.2f, %.2f\n",
          all.median_us / at_005.median_us, all.mean_us / at_005.mean_us,
          q.median_us / least_at_005.median_us, q.mean_us / least_at_005.mean_us);
    if (leaf == 0.05) at_005 = all, least_at_005 = q;
    const TissueGrid grid = tooth.octree.to_grid();
    std::vector<double> scan;
    volatile long found = 0;
    for (int i = 0; i < 300; ++i) scan.push_back(dense_scan_us(grid, ball, {0, 0, -1.5}, found));
    const double dense = quantiles(scan).median_us;
    std::printf(
        "  dense scan of the tool's box, %ld leaves inside: %.2f us, %.1f times the median tick, %.1f times the mean\n",
        found / 300, dense, dense / q.median_us, dense / q.mean_us);
  }
  const Tooth tooth = block(0.05);
  line("block, round-1.0, out of contact", quantiles(in_air(tooth, ball, 0, ticks)));
  for (const auto& name : testing_engine::bur_names())
    (void)lines(name.c_str(),
                drill_repeatedly(tooth, testing_engine::shipped_bur(name), {0, 0, 0}, ticks / 2));
  for (const char* name : {"round-1.4", "endo-access-1.0"})
    for (const double speed_mm_s : {2.0, 10.0, 40.0})
      for (const bool sways : {false, true}) {
        char what[80];
        std::snprintf(what, sizeof what, "%s slides, %g mm/s%s, 0.25 ms ticks", name, speed_mm_s,
                      sways ? ", swaying" : "");
        (void)lines(what, repeatedly([&] {
                      return slide(tooth, testing_engine::shipped_bur(name), speed_mm_s, sways,
                                   4 * ticks);
                    }));
      }
  if (real) {
    // straight down from the first solid leaf over the middle of the crown
    Vec3 top{0, 0, 12};
    while (top.z > -12 && !real->octree.is_solid(real->octree.tissue_at(top))) top.z -= 0.01;
    (void)lines(real->name.c_str(), drill_repeatedly(*real, ball, top, ticks));
  }
  return 0;
}

}  // namespace
}  // namespace cavum

int main(int argc, char** argv) {
  try {
    return cavum::run(argc, argv);
  } catch (const cavum::Error& e) {
    std::fprintf(stderr, "tick_bench: %s\n", e.what());
    return 2;
  }
}
