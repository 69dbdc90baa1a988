#include "engine/explain/report/protocol.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/base/print.h"
#include "engine/explain/model/mechanism.h"

namespace cavum::explain {
namespace {

constexpr double k_rate_hz = 200.0;
constexpr double k_acceleration_mm_s2 = 10.0;  // reached within 0.1 s at the fastest speed: inertia and lags show, a rig follows

struct Part {
  double depth_mm = 0;    ///< to go to, positive = into the tooth
  double speed_mm_s = 0;  ///< 0 = hold
  double hold_s = 0;
  bool spinning = false;
};

/// One session: strokes in air at four speeds, then four presses, each to two depths with a reversal in contact.
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
      "# One session of the protocol that `cavum explain --protocol` describes: z is height above the surface.\n# point = "
      "round-1.0\nt_s,x_mm,y_mm,z_mm,qw,qx,qy,qz,pedal\n";
  double depth = -0.8;
  long row = 0;
  const auto write = [&](double at, bool spinning) {
    out += printed("%.3f,0,0,%.6f,1,0,0,0,%d\n", static_cast<double>(row) / k_rate_hz, -at, spinning ? 1 : 0);
    ++row;
  };
  for (const auto& part : parts()) {
    if (part.speed_mm_s <= 0.0) {
      for (int i = 0; i < static_cast<int>(part.hold_s * k_rate_hz); ++i) write(depth, part.spinning);
      continue;
    }
    // trapezium of speed
    const double way = std::fabs(part.depth_mm - depth), sign = part.depth_mm > depth ? 1.0 : -1.0;
    const double v = std::min(part.speed_mm_s, std::sqrt(way * k_acceleration_mm_s2)), ramp = v / k_acceleration_mm_s2;
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

std::string protocol_page() {
  std::string rows;
  for (const auto& m : mechanisms()) rows += fmt::format("<li><b>{}</b> (<code>{}</code>): {}</li>\n", m.words, m.name, m.separate);
  return R"(<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1"><title>Recording protocol for cavum explain</title>
<style>:root{color-scheme:light}body{font:16px/1.5 sans-serif;color:#222;background:#fff;max-width:60em;margin:2em auto;padding:0 1em;overflow-wrap:anywhere}code{font-size:1em}li{margin:.3em 0}</style></head><body><main>
<h1>A recording from which causes can be told apart</h1>
<p>Six sessions of about a minute, each with the motion in the CSV file beside this page (height z above the surface; the first touch is z = 0). Sample force and
position together, 200 times a second or faster; write the measured speed down too when the machine knows it: with a coarse encoder it is worth most.</p>
<ol>
<li>Switch on, wait ten minutes, and zero the load cell in air with the handpiece level.</li>
<li>Sessions 1 and 4 with the handpiece level, 2 and 5 tilted by 30 degrees, 3 and 6 by 60 degrees: <code>posture_deg</code>.</li>
<li>In each session the motion does it all: strokes in air at four speeds with reversals; four presses at four speeds, spindle off and on, each with a hold
(one of 10 s), a reversal in contact at another speed, and a way back into air. When the measured speed is not written down, begin each session 0.013 mm deeper than the
last: a coarse encoder rounds a hold at one depth by the same error every time, which looks like a bend in the material.</li>
<li>A new site for each session, and the site of the first session again in the last: <code>site</code>. Approach at 0, 45, 90 and 135 degrees in turn: <code>approach_deg</code>.</li>
<li>Sessions 2, 4 and 6 with water: <code>wet</code> 1. A new diamond point for session 4: <code>bur_id</code>. Count the removed volume: <code>removed_mm3</code>.</li>
<li>Press once sideways in air in each session, if lateral forces are measured: <code>fy_n</code>, <code>fz_n</code>.</li>
<li>Write beside the CSV a <code>rig.toml</code> with <code>position_quantum_mm</code>, <code>force_quantum_n</code>, <code>force_limit_n</code>, and <code>k_n_per_mm</code>, <code>c_n_s_per_mm</code> of the simulation.</li>
</ol>
<p>CSV columns: <code>session,t_s,x_mm,f_n</code> and any of <code>v_mm_s, spindle_rpm, wet, posture_deg, approach_deg, fy_n, fz_n, removed_mm3, bur_id, site, layer, temperature_c</code>;
any other numeric column is tried as an explanation too. Then: <code>cavum explain recording.csv --out report.html</code></p>
<h2>What shows what</h2>
<ul>
)" + rows +
         "</ul>\n</main></body></html>\n";
}

}  // namespace cavum::explain
