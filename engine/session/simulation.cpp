#include "engine/session/simulation.h"

#include <fmt/core.h>

namespace cavum {

Simulation make_simulation(const SessionSetup& setup, const std::string& where,
                           const Tooth* start) {
  Simulation s;
  s.tooth = start != nullptr ? *start : load_tooth(setup.tooth, where + ": start_tooth.cvt");
  std::vector<Bur> tray;
  for (std::size_t i = 0; i < setup.burs_toml.size(); ++i)
    tray.push_back(parse_bur(setup.burs_toml[i], fmt::format("{}: bur_{:03}.toml", where, i)));
  const ForceModel force = parse_force_model(setup.force_model_toml, where + ": force_model.toml");
  const ServoConfig config = parse_servo_config(setup.servo_toml, where + ": servo.toml");
  s.model = make_servo_model(s.tooth, tray, force, config);
  s.state = make_servo_state(s.model, s.tooth, setup.first_tip_mm());
  return s;
}

Tooth drilled_tooth(const Simulation& simulation) {
  return {simulation.tooth, simulation.state.tooth, simulation.tooth.tissues};
}

}  // namespace cavum
