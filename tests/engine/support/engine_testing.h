// What the tests of the engine's rooms share: the shipped burs and materials, teeth made from a
// closed-form signed distance, and a testing rig that turns poses into ticks.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "engine/base/file.h"
#include "engine/base/random.h"
#include "engine/physics/servo/servo.h"
#include "tests/engine/support/basics.h"

namespace cavum::testing_engine {

using namespace testing_basics;

inline std::string bur_text(const std::string& name) {
  return read_text_file(data_path("burs/" + name + ".toml"));
}
inline Bur shipped_bur(const std::string& name) {
  return parse_bur(bur_text(name), name + ".toml");
}

/// Names of the shipped burs, sorted.
inline std::vector<std::string> bur_names() {
  return testing_basics::toml_names(data_path("burs"));
}

inline ForceModel shipped_model(const std::string& name) {
  return parse_force_model(read_text_file(data_path("materials/" + name + ".toml")),
                           name + ".toml");
}

/// One k, c and τ for enamel and dentin; pulp stays a cavity.
inline ForceModel hard_model(double k_n_per_mm, double c_n_s_per_mm, double tau_s = 2.02) {
  ForceModel model = shipped_model("paper");
  for (const char* name : {"enamel", "dentin"})
    model.materials.find(name)->second = {{k_n_per_mm, c_n_s_per_mm}, tau_s};
  return model;
}

inline Vec3 random_direction(Random& random) {
  for (;;) {
    const Vec3 v{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    const double n = length(v);
    if (n > 0.1 && n <= 1) return v / n;
  }
}
inline Quat random_rotation(Random& random) {
  for (;;) {
    const Quat q{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1),
                 random.uniform(-1, 1)};
    const double n2 = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
    if (n2 > 0.01 && n2 <= 1) return normalized(q);
  }
}

/// Solid tissue where `distance_mm` (exact, negative inside) is negative, in a grid around
/// low..high.
inline Tooth tooth_of(
    const std::function<double(Vec3)>& distance_mm, Vec3 low, Vec3 high, double leaf_mm,
    const std::function<std::uint8_t(Vec3)>& tissue = [](Vec3) { return k_enamel; }) {
  Tooth tooth;
  TissueGrid grid;
  const auto leaves = [&](double mm) {
    return static_cast<std::int32_t>(std::ceil(mm / leaf_mm - 1e-9));
  };
  grid.allocate({leaves(high.x - low.x), leaves(high.y - low.y), leaves(high.z - low.z)}, leaf_mm,
                low);
  for (std::int32_t z = 0; z < grid.size.z; ++z)
    for (std::int32_t y = 0; y < grid.size.y; ++y)
      for (std::int32_t x = 0; x < grid.size.x; ++x) {
        const Vec3 at = grid.centre_mm({x, y, z});
        const double d = distance_mm(at);
        const auto i = grid.index({x, y, z});
        if (d < 0) grid.tissue[i] = tissue(at);
        grid.distance[i] = encode_distance(d / leaf_mm);
      }
  grid.make_consistent(tooth.tissues);
  tooth.octree = Octree(grid, tooth.tissues);
  tooth.name = "test body";
  return tooth;
}

/// Half space below the plane through `on_it` with outward `normal`, cut to a cube of 2·`half_mm`.
inline Tooth half_space_tooth(Vec3 normal, Vec3 on_it, double half_mm, double leaf_mm) {
  const Vec3 h{half_mm, half_mm, half_mm};
  return tooth_of([=](Vec3 p) { return dot(p - on_it, normal); }, -h, h, leaf_mm);
}

/// A candidate's hands without a hand: the pose goes straight into the tick.
struct Rig {
  ServoModel model;
  ServoState state;
  TickInput input;
  double tick_s = k_tick_s;

  Rig(const Tooth& tooth, const std::vector<Bur>& tray, const ForceModel& force, Vec3 first_tip_mm,
      double dt_s = k_tick_s)
      : tick_s(dt_s) {
    ServoConfig config;
    config.tick_s = dt_s;
    model = make_servo_model(tooth, tray, force, config);
    state = make_servo_state(model, tooth, first_tip_mm);
  }
  TickOutput tick(Vec3 tip_mm, double pedal, Quat rotation = {},
                  std::uint16_t flags = k_stylus_fresh | k_pedal_fresh) {
    input = make_tick_input({tip_mm, rotation}, pedal, flags, input.bur, input);
    return step(model, state, input);
  }
  /// Straight from `from` to `to` at `speed_mm_s`; returns the last output.
  TickOutput travel(Vec3 from, Vec3 to, double speed_mm_s, double pedal = 0, Quat rotation = {}) {
    const int n = std::max(1, static_cast<int>(length(to - from) / (speed_mm_s * tick_s) + 0.5));
    TickOutput out;
    for (int i = 1; i <= n; ++i)
      out = tick(from + (to - from) * (static_cast<double>(i) / n), pedal, rotation);
    return out;
  }
  /// Handpiece turning at full speed, out of contact.
  void spin_up(Vec3 tip_mm, Quat rotation = {}) {
    for (double t = 0; t < 2.0; t += tick_s) (void)tick(tip_mm, 1.0, rotation);
  }
};

/// Volume removed between two states of a tooth, mm³, counted leaf by leaf.
inline double removed_mm3(const Octree& before, const Octree& after) {
  const auto a = before.count_leaves(), b = after.count_leaves();
  double leaves = 0;
  for (std::size_t i = 1; i < a.size(); ++i)
    leaves += static_cast<double>(a[i]) - static_cast<double>(b[i]);
  return leaves * before.leaf_volume_mm3();
}

/// Signed distance, mm, from the whole bur at a pose to the plane {p: dot(p, normal) = height}: the
/// least height of its profile over the plane, found on a dense walk of the profile (closed form
/// around the axis).
inline double height_over_plane_mm(const Bur& bur, Vec3 tip_mm, Quat rotation_q, Vec3 normal,
                                   double plane_mm) {
  const Vec3 axis = rotation(rotation_q) * Vec3{0, 0, 1};
  const double along = dot(axis, normal), across = std::sqrt(std::max(0.0, 1 - along * along));
  double least = 0;  // the tip
  for (const auto& p : bur.profile.walk(0.004, bur.profile.length_mm()))
    least = std::min(least, p.at.z_mm * along - p.at.r_mm * across);
  // walk() leaves out the ends of the pieces, which is where sharp edges are
  for (const auto& s : bur.profile.segments())
    least = std::min(least, s.end.z_mm * along - s.end.r_mm * across);
  return dot(tip_mm, normal) - plane_mm + least;
}

}  // namespace cavum::testing_engine
