#include "engine/explain/mechanism.h"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace cavum::explain {

const std::vector<Mechanism>& mechanisms() {
  static const std::vector<Mechanism> all = [] {
    constexpr std::array order{"bias",
                               "drift",
                               "coulomb_friction",
                               "stribeck_friction",
                               "viscous_friction",
                               "gravity_posture",
                               "inertia",
                               "gain_error",
                               "cross_talk",
                               "delay",
                               "low_pass",
                               "saturation",
                               "backlash",
                               "hysteresis",
                               "series_compliance",
                               "nonlinear_stiffness",
                               "hidden_layer",
                               "graded_stiffness",
                               "anisotropy",
                               "relaxation",
                               "feed_power_law",
                               "edge_force",
                               "wear",
                               "run_out",
                               "chatter",
                               "coolant",
                               "thermal_softening"};
    std::vector<Mechanism> found;
    for (auto family : {sensor_mechanisms(), friction_mechanisms(), tissue_mechanisms(), cutting_mechanisms()})
      for (auto& m : family) found.push_back(std::move(m));
    std::vector<Mechanism> sorted;
    for (const std::string name : order)
      for (auto& m : found)
        if (name == m.name) sorted.push_back(m);
    if (sorted.size() != order.size()) throw std::logic_error("a mechanism is missing from its family");
    return sorted;
  }();
  return all;
}

bool makes_sense(const Mechanism& m, const double* own, std::size_t count) {
  const std::string name = m.name;
  if (name == "coulomb_friction" || name == "viscous_friction" || name == "inertia" || name == "hysteresis" || name == "edge_force" ||
      name == "thermal_softening" || name == "relaxation" || name == "stribeck_friction")
    return std::all_of(own, own + count, [](double v) { return v > 0.0; });  // stribeck_friction: Fc and Fs - Fc
  if (name == "saturation") return own[0] > 0.8 && own[0] < 1.25;            // the plateau is where the force reaches it
  return true;
}

std::size_t session_groups(const Recording& r) { return r.sessions.size() <= 12 ? std::max<std::size_t>(1, r.sessions.size()) : 1; }

int law_of(int mechanism) {
  const std::string name = mechanisms()[static_cast<std::size_t>(mechanism)].name;
  for (const auto& [variant, law] : {std::pair{"stribeck_friction", "coulomb_friction"},
                                     {"graded_stiffness", "nonlinear_stiffness"},
                                     {"series_compliance", "nonlinear_stiffness"},
                                     {"low_pass", "delay"}})
    if (name == variant) return find_mechanism(law);
  return mechanism;
}

int find_mechanism(const std::string& name) {
  const auto& all = mechanisms();
  for (std::size_t i = 0; i < all.size(); ++i)
    if (name == all[i].name) return static_cast<int>(i);
  return -1;
}

}  // namespace cavum::explain
