#include "engine/physics/servo/servo_config.h"

#include <sstream>

#include "engine/base/toml_reader.h"

namespace cavum {

std::string to_toml(const ServoConfig& c) {
  std::ostringstream out;
  out.precision(17);
  out << "tick_s = " << c.tick_s << "\nmax_rpm = " << c.max_rpm << "\nspin_up_s = " << c.spin_up_s
      << "\nposition_quantum_mm = " << c.position_quantum_mm
      << "\n\n[limits]\npeak_n = " << c.limits.peak_n
      << "\ncontinuous_n = " << c.limits.continuous_n
      << "\nslew_n_per_s = " << c.limits.slew_n_per_s
      << "\nsustained_budget_n_s = " << c.limits.sustained_budget_n_s
      << "\nwatchdog_s = " << c.limits.watchdog_s << "\n";
  return out.str();
}

ServoConfig parse_servo_config(const std::string& text, const std::string& where) {
  const toml::table document = parse_toml(text, where);
  TomlReader in(document, where);
  ServoConfig c;
  c.tick_s = in.number("tick_s", 1e-5, 0.01);
  c.max_rpm = in.number("max_rpm", 1, 1e6);
  c.spin_up_s = in.number("spin_up_s", 0, 10);
  c.position_quantum_mm = in.number("position_quantum_mm", 0, 1);
  const auto* limits = in.table("limits");
  if (limits == nullptr) in.fail("limits", msg("is missing"), msg("add [limits]"));
  TomlReader l(*limits, where);
  c.limits.peak_n = l.number("peak_n", 0, 100);
  c.limits.continuous_n = l.number("continuous_n", 0, 100);
  c.limits.slew_n_per_s = l.number("slew_n_per_s", 1, 1e6);
  c.limits.sustained_budget_n_s = l.number("sustained_budget_n_s", 0.1, 1e6);
  c.limits.watchdog_s = l.number("watchdog_s", 0.001, 1);
  if (c.limits.slew_n_per_s * c.limits.watchdog_s < c.limits.peak_n)
    l.fail("slew_n_per_s", msg("is too slow for the force to fade within watchdog_s"),
           msg("raise it to at least peak_n / watchdog_s"));
  l.finish();
  in.finish();
  return c;
}

}  // namespace cavum
