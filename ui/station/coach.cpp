#include "ui/station/coach.h"

namespace cavum::station {

Message coaching_hint(const scenarios::ExamSetup& setup, const scenarios::LiveView& view) {
  const TickOutput& now = view.output;
  const scenarios::ZoneMap& zones = setup.zones;
  const scenarios::Scenario& scenario = setup.scenario;
  // the hand lifts, and the tooth holds the head back
  constexpr double k_lifted_mm = 0.5;
  const Vec3 lifted = view.input.pose().tip_mm - now.proxy_mm;
  if (now.contact && dot(lifted, zones.approach()) > k_lifted_mm && dot(lifted, now.normal) < 0.0)
    return msg(
        "The head is caught under an edge: hold the handpiece upright, press the pedal, and lift slowly.");
  const double force_n = length(now.rendered_force_n);
  if (scenario.force_limit_n > 0 && force_n > scenario.force_limit_n)
    return msg("Too much force: {}. Let the diamond do the work, below {}.", as_n(force_n, 1),
               as_n(scenario.force_limit_n, 1));
  if (!now.contact) {
    constexpr double k_far_mm = 1.5;
    if (now.rpm > 1000 && zones.distance_mm(now.proxy_mm) > k_far_mm)
      return msg(
          "The handpiece turns in the air: bring it to the tooth first, then press the pedal.");
    return {};
  }
  if (!now.cutting) return msg("In contact. Press the pedal to cut.");
  const double beyond_mm = zones.distance_mm(now.proxy_mm);
  const double floor_mm =
      dot(now.proxy_mm, zones.approach()) - dot(zones.target_low_mm(), zones.approach());
  const double tolerated_mm =
      floor_mm < 0 ? scenario.zones.leeway.bottom_mm : scenario.zones.leeway.sides_mm;
  if (beyond_mm > tolerated_mm)
    return msg("The tip is {} beyond what is to be removed: come back inside.",
               as_mm(beyond_mm, 1));
  constexpr double k_near_mm = 0.35;
  if (floor_mm < k_near_mm && floor_mm > 0)
    return msg("{} to the floor: press lightly now.", as_mm(floor_mm, 1));
  return {};
}

}  // namespace cavum::station
