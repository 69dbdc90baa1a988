// The servo in a closed loop with the simulated Omni in a simulated hand, without threads: what
// tests of stability and of tick lengths share.
#pragma once

#include <vector>

#include "engine/device/simulated_omni.h"
#include "tests/engine/support/engine_testing.h"

namespace cavum::testing_engine {

/// A hand that moves its intended tip along `path(t)`.
struct ClosedLoop {
  Rig rig;
  OmniModel omni;
  HandModel hand;
  OmniState device;
  TickOutput last;
  double time_s = 0;

  ClosedLoop(Rig r, Vec3 start_mm) : rig(std::move(r)), device(make_omni_state(start_mm)) {}
  const TickOutput& tick(Vec3 intended_mm, double pedal) {
    time_s += rig.tick_s;
    const Vec3 tip =
        advance_omni(omni, hand, device, last.rendered_force_n, intended_mm, rig.tick_s);
    return last = rig.tick(tip, pedal);
  }
};

struct MeanAndSd {
  double mean = 0, sd = 0;
};
inline MeanAndSd mean_and_sd(const std::vector<double>& values) {
  MeanAndSd out;
  for (const double v : values) out.mean += v / static_cast<double>(values.size());
  for (const double v : values)
    out.sd += (v - out.mean) * (v - out.mean) / static_cast<double>(values.size());
  out.sd = std::sqrt(out.sd);
  return out;
}

/// `base` with [[terms]] of these kinds and parameters.
inline ForceModel with_terms(
    ForceModel base,
    const std::vector<std::pair<std::string, std::vector<std::pair<std::string, double>>>>& terms) {
  for (const auto& [kind, parameters] : terms)
    base.terms.push_back(make_force_term(kind, parameters, "test"));
  return base;
}

}  // namespace cavum::testing_engine
