#include "ui/station/coach.h"

#include "ui/station/theme.h"

namespace cavum::station {

std::string coaching_hint(const scenarios::ExamSetup& setup, const scenarios::LiveView& view) {
  const TickOutput& now = view.output;
  const scenarios::ZoneMap& zones = setup.zones;
  const scenarios::Scenario& scenario = setup.scenario;
  // the hand lifts, and the tooth holds the head back
  constexpr double k_lifted_mm = 0.5;
  const Vec3 lifted = view.input.pose().tip_mm - now.proxy_mm;
  if (now.contact && dot(lifted, zones.approach()) > k_lifted_mm && dot(lifted, now.normal) < 0.0)
    return "The head is caught under an edge: hold the handpiece upright, press the pedal, and lift slowly.";
  const double force_n = length(now.rendered_force_n);
  if (scenario.force_limit_n > 0 && force_n > scenario.force_limit_n)
    return number_text("Too much force: %.1f N. ", force_n) + number_text("Let the diamond do the work, below %.1f N.", scenario.force_limit_n);
  if (!now.contact) {
    constexpr double k_far_mm = 1.5;
    if (now.rpm > 1000 && zones.distance_mm(now.proxy_mm) > k_far_mm)
      return "The handpiece turns in the air: bring it to the tooth first, then press the pedal.";
    return {};
  }
  if (!now.cutting) return "In contact. Press the pedal to cut.";
  const double beyond_mm = zones.distance_mm(now.proxy_mm);
  const double floor_mm = dot(now.proxy_mm, zones.approach()) - dot(zones.target_low_mm(), zones.approach());
  const double tolerated_mm = floor_mm < 0 ? scenario.zones.leeway.bottom_mm : scenario.zones.leeway.sides_mm;
  if (beyond_mm > tolerated_mm) return number_text("The tip is %.1f mm beyond what is to be removed: come back inside.", beyond_mm);
  constexpr double k_near_mm = 0.35;
  if (floor_mm < k_near_mm && floor_mm > 0) return number_text("%.1f mm to the floor: press lightly now.", floor_mm);
  return {};
}

}  // namespace cavum::station
