#include "engine/lab/explain/report/protocol.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace cavum::explain {
namespace {

constexpr double k_rate_hz = 200.0;
constexpr double k_acceleration_mm_s2 =
    10.0;  // reached within 0.1 s at the fastest speed: inertia and lags show, a rig follows

struct Part {
  double depth_mm = 0;    ///< to go to, positive = into the tooth
  double speed_mm_s = 0;  ///< 0 = hold
  double hold_s = 0;
  bool spinning = false;
};

/// One session: strokes in air at four speeds, then four presses, each to two depths with a
/// reversal in contact.
std::vector<Part> parts() {
  std::vector<Part> p{{-0.8, 0, 2.0, false}};
  const double speeds[] = {0.1, 0.25, 0.5, 1.0};
  for (const double v : speeds) p.insert(p.end(), {{-0.3, v, 0, v > 0.3}, {-0.8, v, 0, v > 0.3}});
  for (int i = 0; i < 4; ++i) {
    const double v = speeds[i], other = speeds[(i + 2) % 4], depth = 0.3 + 0.1 * i;
    const bool on = i % 2 == 1;
    p.insert(p.end(), {{-0.05, 1.0, 0, on},
                       {depth, v, 0, on},
                       {depth, 0, i == 0 ? 10.0 : 2.0, on},
                       {depth + 0.2, other, 0, on},
                       {depth + 0.2, 0, 1.0, on},
                       {depth, other, 0, on},
                       {depth, 0, 1.0, on},
                       {-0.3, std::max(0.25, v), 0, on},
                       {-0.3, 0, 0.5, false}});
  }
  return p;
}

}  // namespace

std::string protocol_motion_csv() {
  std::string out =
      "# One session of the protocol that `cavum explain --protocol` describes: z is height above the surface.\n# bur = "
      "round-1.0\nt_s,x_mm,y_mm,z_mm,qw,qx,qy,qz,pedal\n";
  double depth = -0.8;
  long row = 0;
  const auto write = [&](double at, bool spinning) {
    out += fmt::format("{:.3f},0,0,{:.6f},1,0,0,0,{}\n", static_cast<double>(row) / k_rate_hz, -at,
                       spinning ? 1 : 0);
    ++row;
  };
  for (const auto& part : parts()) {
    if (part.speed_mm_s <= 0.0) {
      for (int i = 0; i < static_cast<int>(part.hold_s * k_rate_hz); ++i)
        write(depth, part.spinning);
      continue;
    }
    // trapezium of speed
    const double way = std::fabs(part.depth_mm - depth), sign = part.depth_mm > depth ? 1.0 : -1.0;
    const double v = std::min(part.speed_mm_s, std::sqrt(way * k_acceleration_mm_s2)),
                 ramp = v / k_acceleration_mm_s2;
    const double total = way / v + ramp;
    for (double t = 0.0; t < total; t += 1.0 / k_rate_hz) {
      const double rest = total - t;
      const double gone = t < ramp      ? 0.5 * k_acceleration_mm_s2 * t * t
                          : rest < ramp ? way - 0.5 * k_acceleration_mm_s2 * rest * rest
                                        : v * (t - 0.5 * ramp);
      write(depth + sign * gone, part.spinning);
    }
    depth = part.depth_mm;
  }
  return out;
}

}  // namespace cavum::explain
