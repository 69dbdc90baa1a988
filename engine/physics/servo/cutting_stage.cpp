// The stage that cuts: recession gathers, and the head is carved, one carve at a time and a part of it in each tick.
#include <algorithm>

#include "engine/physics/contact/tuning.h"
#include "engine/physics/servo/grinding.h"
#include "engine/physics/servo/stages.h"

namespace cavum {

using namespace tuning;

namespace {

/// The head where the proxy is.
CarvedHead head_here(const ServoState& state) noexcept { return {state.contact.proxy_mm, state.contact.rotation, state.contact.bur}; }

/// Is the proxy on a way of more than a leaf a tick? A tool pulled out of a deep hole touches its walls like that: it owes nothing there.
bool travels(const Tick& tick, double leaf_mm) noexcept {
  return tick.contact.on_its_way && dot(tick.contact.moved_mm, tick.contact.moved_mm) > leaf_mm * leaf_mm;
}

/// How far the head has come since it was last carved, tip and top together, mm. One that neck or shank hold, or that swings in its hole, has
/// nothing to gain.
double way_mm(const CarvedHead& from, const CarvedHead& to, double head_length_mm) noexcept {
  const Vec3 top{0, 0, head_length_mm}, tip_way = to.tip_mm - from.tip_mm, top_way = tip_way + to.rotation * top - from.rotation * top;
  return length(tip_way) + length(top_way);
}

/// Begins a carve when enough recession has gathered, or void tissue was swept through.
void begin_what_is_due(const ServoState& state, const Tick& tick, HeadCarving& carving) noexcept {
  const double leaf_mm = state.tooth.leaf_mm(), owed_mm = state.recession.owed_mm;
  const bool sweeps = tick.means.void_tissue && carving.swept_mm >= k_sweep_leaves * leaf_mm;
  const double share = tick.means.void_tissue ? k_void_share : carving.swept_mm >= k_slide_mm ? k_slide_share : 1.0;
  const double due_mm = share * carve_step_mm(leaf_mm);
  if (!sweeps && !(tick.means.touching && owed_mm >= due_mm)) return;
  const CarvedHead here = head_here(state), head = tick.means.touching ? receded(here, state.contact.normal, owed_mm) : here;
  if (carving.last.bur == head.bur && way_mm(carving.last, head, tick.tool.bur.cutting_length_mm) < due_mm) return;
  begin_carving(carving, head);
}

/// Goes on with the carve under way. Contact learns what was opened.
void carve(const ServoModel& model, ServoState& state, TickOutput& out) noexcept {
  const CarvedHead head = state.carving.now;
  const Bur& bur = model.tray[static_cast<std::size_t>(head.bur)].bur;
  const auto done = go_on_carving(state.carving, state.tooth, bur, k_carve_work, state.removed);
  if (done == CarvingStep::no_room) out.notices |= k_notice_tooth_full;
  if (done == CarvingStep::done) state.contact.opened = {head.tip_mm, head.rotation == state.contact.rotation ? state.contact.turned_rad : -1.0};
}

/// r', mm/s.
double recession_mm_s(const ServoModel& model, const ServoState& state, const Tick& tick, double pressing_n) noexcept {
  const double rpm = state.handpiece.rpm;
  if (model.force.law == CuttingLaw::penetration) return tick.penetration_mm * tick.means.of.recession_per_s * (rpm / model.force.rpm_ref);
  return ground_mm_s(tick.means.grinding, pressing_n, tick.tissue().stiffness_n_per_mm, rpm, model.config.tick_s);
}

}  // namespace

void cut(const ServoModel& model, ServoState& state, const Tick& tick, TickOutput& out) noexcept {
  // F = k X + c V alone: what wear, water or run-out add is felt, and grinds nothing.
  const double pressing_n = voigt_force_n(tick.tissue(), tick.penetration_mm, state.render.speed_mm_s);
  if (model.force.drive.torque_n_mm > 0.0) state.handpiece.load_n_mm = grinding_torque_n_mm(tick.means.grinding, pressing_n, model.force.force_ratio);
  const bool still = !turns(model.config, state.handpiece);
  if (still || state.carving.now.bur != tick.input.bur) drop_carving(state.carving);
  if (still) return;
  state.carving.swept_mm += length(tick.contact.moved_mm);
  if (tick.means.touching) {
    const double leaf_mm = state.tooth.leaf_mm();
    gather_recession(recession_mm_s(model, state, tick, pressing_n), model.config.tick_s, leaf_mm, state.recession);
    if (!travels(tick, leaf_mm)) {
      state.recession.head = head_here(state);
      state.recession.normal = state.contact.normal;
    }
    out.cutting = tick.means.of.recession_per_s > 0 || tick.means.grinding.per_turn_n_per_mm > 0;
  }
  if (!state.carving.under_way()) begin_what_is_due(state, tick, state.carving);
  if (state.carving.under_way()) carve(model, state, out);
  if (state.terms.counts_removed) state.terms.removed_leaves[tick.input.bur] += static_cast<std::uint32_t>(state.removed.size());
}

}  // namespace cavum
