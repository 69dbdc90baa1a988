// The stages that ask the tooth: how far the tool is in, and what it touches.
#include <algorithm>

#include "engine/physics/contact/tuning.h"
#include "engine/physics/servo/stages.h"

namespace cavum {

using namespace tuning;

CarvedHead left_behind(const Tick& tick, double leaf_mm, const Recession& recession) noexcept {
  if (!tick.was_touching || tick.contact.touching ||
      recession.pending_mm < k_lift_share * carve_step_mm(leaf_mm))
    return {};
  return receded(recession.head, recession.normal, recession.pending_mm);
}

double penetration(const Tick& tick, const ContactState& contact, const CarvedHead& carved,
                   double leaf_mm, Recession& recession) noexcept {
  follow_recession(contact, tick.contact, tick.was_touching, carved, leaf_mm, recession);
  return tick.contact.touching ? std::max(0.0, tick.contact.penetration_mm - recession.pending_mm)
                               : 0.0;
}

TouchedMeans tissue_mixture(const ServoModel& model, const Octree& tooth, const Tick& tick,
                            double rpm, const Recession& recession, const ContactState& contact,
                            ContactScratch& scratch, TouchedMemory& touched) noexcept {
  if (tick.contact.in_air || !(tick.contact.touching || rpm > 0)) return {};
  const TouchedMeans before = touched.means;
  TouchedMeans means =
      touched_means(tooth, tick.tool, model.voids, model.tissue.data(),
                    std::max(0.0, recession.pending_mm), contact, touched, scratch);
  if (!tick.contact.still_moving || !tick.was_touching || means.touching) return means;
  // A proxy between two places of contact touches nothing; what it left speaks until it arrives, or
  // the force would drop out for a tick.
  means.touching = before.touching;
  means.of = before.of;
  means.of.recession_per_s = 0.0;
  touched.means = means;
  return means;
}

}  // namespace cavum
