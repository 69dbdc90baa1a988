// The stages that cut: recession gathers, and the head is carved, one carve at a time and a part of
// it in each tick.
#include <algorithm>

#include "engine/physics/contact/tuning.h"
#include "engine/physics/servo/grinding.h"
#include "engine/physics/servo/stages.h"

namespace cavum {

using namespace tuning;

namespace {

/// The head where the proxy is.
CarvedHead head_here(const ContactState& contact) noexcept {
  return {contact.proxy_mm, contact.rotation, contact.bur};
}

/// Does the proxy move on by more than a leaf a tick? A tool pulled out of a deep hole touches its
/// walls like that: nothing is pending there.
bool travels(const Tick& tick, double leaf_mm) noexcept {
  return tick.contact.still_moving &&
         dot(tick.contact.moved_mm, tick.contact.moved_mm) > leaf_mm * leaf_mm;
}

/// How far the head has come since it was last carved, tip and top together, mm. One that neck or
/// shank hold, or that swings in its hole, has nothing to gain.
double advance_mm(const CarvedHead& from, const CarvedHead& to, double head_length_mm) noexcept {
  const Vec3 top{0, 0, head_length_mm}, by = to.tip_mm - from.tip_mm;
  return length(by) + length(by + to.rotation * top - from.rotation * top);
}

/// The head to be carved, when enough recession has gathered, or void tissue was swept through; bur
/// -1: none.
CarvedHead due(const Tick& tick, double pending_mm, const ContactState& contact, double leaf_mm,
               const HeadCarving& carving) noexcept {
  const bool sweeps = tick.means.void_tissue && carving.swept_mm >= k_sweep_leaves * leaf_mm;
  const double share = tick.means.void_tissue           ? k_void_share
                       : carving.swept_mm >= k_slide_mm ? k_slide_share
                                                        : 1.0;
  const double due_mm = share * carve_step_mm(leaf_mm);
  if (!sweeps && !(tick.means.touching && pending_mm >= due_mm)) return {};
  const CarvedHead here = head_here(contact),
                   head = tick.means.touching ? receded(here, contact.normal, pending_mm) : here;
  if (carving.last.bur == head.bur &&
      advance_mm(carving.last, head, tick.tool.bur.cutting_length_mm) < due_mm)
    return {};
  return head;
}

}  // namespace

void recede(const ServoModel& model, const Tick& tick, double rpm, double pressing_n,
            const ContactState& contact, double leaf_mm, Recession& recession) noexcept {
  const double speed_mm_s =
      model.force.law == CuttingLaw::penetration
          ? tick.penetration_mm * tick.means.of.recession_per_s * (rpm / model.force.rpm_ref)
          : ground_mm_s(tick.means.grinding, pressing_n, tick.tissue().stiffness_n_per_mm, rpm,
                        model.config.tick_s);
  gather_recession(speed_mm_s, model.config.tick_s, leaf_mm, recession);
  if (travels(tick, leaf_mm)) return;
  recession.head = head_here(contact);
  recession.normal = contact.normal;
}

Carved carve(const ServoModel& model, const Tick& tick, const CarvedHead& left,
             const Recession& recession, const ContactState& contact, Octree& tooth,
             ReservedVector<RemovedLeaf>& removed, HeadCarving& carving) noexcept {
  if (left.bur >= 0) begin_carving(carving, left);
  if (carving.now.bur != tick.input.bur) drop_carving(carving);
  carving.swept_mm += length(tick.contact.moved_mm);
  if (!carving.under_way()) {
    const CarvedHead next = due(tick, recession.pending_mm, contact, tooth.leaf_mm(), carving);
    if (next.bur < 0) return {};
    begin_carving(carving, next);
  }
  const CarvedHead head = carving.now;
  const Bur& bur = model.tray[static_cast<std::size_t>(head.bur)].bur;
  const CarvingStep done = go_on_carving(carving, tooth, bur, k_carve_work, removed);
  if (done != CarvingStep::done) return {.no_room = done == CarvingStep::no_room};
  return {.opened = OpenedPosition{head.tip_mm,
                                   head.rotation == contact.rotation ? contact.turned_rad : -1.0}};
}

}  // namespace cavum
