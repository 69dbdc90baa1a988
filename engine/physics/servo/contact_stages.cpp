// The stages that ask the tooth: where the tool is held, how far it is in, and what it touches.
#include <algorithm>

#include "engine/physics/contact/tuning.h"
#include "engine/physics/servo/stages.h"

namespace cavum {

using namespace tuning;

namespace {

/// What a tool that lifts off still owes is carved where it was owed, or many short touches would cut nothing.
void carve_at_lift_off(const Recession& owed, double leaf_mm, HeadCarving& carving) noexcept {
  if (owed.owed_mm >= k_lift_share * carve_step_mm(leaf_mm)) begin_carving(carving, receded(owed.head, owed.normal, owed.owed_mm));
}

}  // namespace

void solve_proxy(ServoState& state, Tick& tick) noexcept {
  tick.was_touching = state.contact.touching;
  tick.contact = update_contact(state.tooth, tick.tool, tick.input.bur, tick.device, state.contact);
}

void penetration(ServoState& state, Tick& tick) noexcept {
  const double leaf_mm = state.tooth.leaf_mm();
  if (tick.was_touching && !tick.contact.touching) carve_at_lift_off(state.recession, leaf_mm, state.carving);
  follow_recession(state.contact, tick.contact, tick.was_touching, state.carving.last, leaf_mm, state.recession);
  if (!tick.contact.touching) return;
  tick.penetration_mm = std::max(0.0, tick.contact.penetration_mm - state.recession.owed_mm);
  tick.approach_mm = -dot(tick.moved_mm, tick.contact.normal);
}

void tissue_mixture(const ServoModel& model, ServoState& state, Tick& tick) noexcept {
  if (tick.contact.in_air || !(tick.contact.touching || state.handpiece.rpm > 0)) return;
  const TouchedMeans before = state.contact.touched.means;
  TouchedMeans& means = tick.means;
  means = touched_means(state.tooth, tick.tool, model.voids, model.tissue.data(), std::max(0.0, state.recession.owed_mm), state.contact);
  if (!tick.contact.on_its_way || !tick.was_touching || means.touching) return;
  // A proxy between two places of contact touches nothing; what it left speaks until it arrives, or the force would drop out for a tick.
  means.touching = before.touching;
  means.of = before.of;
  means.of.recession_per_s = 0.0;
  state.contact.touched.means = means;
}

}  // namespace cavum
