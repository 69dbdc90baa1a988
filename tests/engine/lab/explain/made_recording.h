// Recordings for the tests of explain, from formulae of their own: six sessions of strokes in air
// and presses with holds, k = 0.8 N/mm, c = 0.6 N s/mm, noise that remembers (AR(1), rho = 0.5).
#pragma once

#include <cmath>
#include <functional>

#include "engine/base/random.h"
#include "engine/lab/explain/recording/recording.h"

namespace cavum::explain::made {

inline constexpr double k_k = 0.8, k_c = 0.6;

/// True state at one row.
struct Row {
  double t_s = 0, x_mm = 0, v_mm_s = 0, base_n = 0, rpm = 0;
  bool first = false;  ///< of its session
};

struct Options {
  double dt_s = 0.02, noise_n = 0.02, rho = 0.5, quantum_mm = 0.0;
  bool one_way = false;        ///< approach and press at one constant speed, nothing else
  bool one_programme = false;  ///< every session moves like the first, to the last digit
  std::uint64_t seed = 1;
};

/// `effect`: force added to the base, N.
inline Recording recording(const Options& o, const std::function<double(const Row&)>& effect = {}) {
  Random random(o.seed);
  std::vector<double> t, x, f, rpm;
  Recording r;
  struct Leg {
    double to, speed, hold;
  };
  std::vector<Leg> legs, programme;
  for (int session = 0; session < 6; ++session) {
    const auto begin = static_cast<Eigen::Index>(t.size());
    legs.clear();
    if (o.one_way) {
      legs = {{2.0, 0.25, 0}};
    } else if (o.one_programme && session > 0) {
      legs = programme;
    } else {
      const double speeds[] = {0.1, 0.25, 0.5, 1.0};
      for (int i = 0; i < 2; ++i)
        legs.insert(legs.end(), {{-0.3, speeds[(session + i) % 4], 0},
                                 {-0.8, speeds[(session + i + 1) % 4], 0}});
      for (int i = 0; i < 4; ++i) {
        const double depth = 0.3 + 0.1 * random.uniform(0, 3), v = speeds[(i + session) % 4],
                     u = speeds[(i + session + 2) % 4];
        legs.insert(legs.end(), {{-0.1, 0.8, 0},
                                 {depth, v, i == 0 ? 8.0 : 1.5},
                                 {depth + 0.2, u, 1.0},
                                 {depth, v, 0.5},
                                 {-0.4, std::max(0.25, u), 0.4}});
      }
    }
    programme = legs;
    double at = -0.8, speed = 0.0, noise = o.noise_n * random.normal(), now = 0.0;
    const auto row = [&](bool on) {
      Row q{now, at, speed, 0, on ? 20000.0 : 0.0, static_cast<Eigen::Index>(t.size()) == begin};
      q.base_n = at > 0.0 ? std::max(0.0, k_k * at + k_c * speed) : 0.0;
      noise = o.rho * noise + o.noise_n * std::sqrt(1 - o.rho * o.rho) * random.normal();
      t.push_back(now);
      x.push_back(o.quantum_mm > 0 ? o.quantum_mm * std::round(at / o.quantum_mm) : at);
      f.push_back(q.base_n + (effect ? effect(q) : 0.0) + noise);
      rpm.push_back(q.rpm);
      now += o.dt_s;
    };
    for (std::size_t leg = 0; leg < legs.size(); ++leg) {
      const bool on = leg % 3 != 0;
      const double sign = legs[leg].to > at ? 1.0 : -1.0;
      // speed follows its aim within 0.1 s
      while (sign * (legs[leg].to - at) > 0.0) {
        const double before = speed;
        speed += (sign * legs[leg].speed - speed) * std::min(1.0, o.dt_s / 0.1);
        at += 0.5 * (before + speed) * o.dt_s;
        row(on);
      }
      for (double held = 0.0; held < legs[leg].hold; held += o.dt_s) {
        const double before = speed;
        speed -= speed * std::min(1.0, o.dt_s / 0.1);
        at += 0.5 * (before + speed) * o.dt_s;
        row(on);
      }
    }
    r.sessions.push_back({std::to_string(session + 1), begin, static_cast<Eigen::Index>(t.size())});
  }
  const auto series = [](const std::vector<double>& v) {
    return Series(Eigen::Map<const Series>(v.data(), static_cast<Eigen::Index>(v.size())));
  };
  r.t_s = series(t);
  r.x_mm = series(x);
  r.f_n = series(f);
  r.columns.emplace_back("spindle_rpm", series(rpm));
  r.rig.k_n_per_mm = 1.02 * k_k;
  r.rig.c_n_s_per_mm = 0.98 * k_c;
  r.rig.position_quantum_mm = o.quantum_mm;
  return r;
}

}  // namespace cavum::explain::made
