// The stages that make a force of what was touched: the model's, which is recorded, and the one that a sampled device may be given.
#include "engine/physics/servo/stages.h"

namespace cavum {
namespace {

/// Sine and cosine of twice the angle from z towards x, times the square of the normal's part in that plane: no jump where it leaves it.
SinCos approach_of(Vec3 normal) noexcept { return {2.0 * normal.x * normal.z, normal.z * normal.z - normal.x * normal.x}; }

/// What the terms of the force model may look at.
TermInput seen_by_terms(const ServoModel& model, const ServoState& state, const Tick& tick, double voigt_n) noexcept {
  const double dt_s = model.config.tick_s, rpm = state.handpiece.rpm;
  const double removed_mm3 = state.terms.removed_leaves[tick.input.bur] * state.tooth.leaf_volume_mm3();
  return {.touching = tick.contact.touching,
          .penetration_mm = tick.penetration_mm,
          .approach_mm_s = state.render.speed_mm_s,
          .stiffness_n_per_mm = tick.tissue().stiffness_n_per_mm,
          .damping_n_s_per_mm = tick.tissue().damping_n_s_per_mm,
          .voigt_n = voigt_n,
          .rpm = rpm,
          .tick = state.tick,
          .dt_s = dt_s,
          .time_s = static_cast<double>(state.tick) * dt_s,
          .wet = rpm > 0.0 ? 1.0 : 0.0,
          .removed_mm3 = removed_mm3,
          .removed_on_mm3 = removed_mm3,
          .approach = tick.contact.touching ? approach_of(tick.contact.normal) : SinCos{}};
}

}  // namespace

void model_force(const ServoModel& model, ServoState& state, Tick& tick, TickOutput& out) noexcept {
  const ForceModel& force = model.force;
  update_speed(force.rendering, state.render, tick.contact.touching, tick.approach_mm, model.config.tick_s);
  const double speed_mm_s = state.render.speed_mm_s;
  out.model_force_n = voigt_force_n(tick.tissue(), tick.penetration_mm, speed_mm_s);
  if (!force.terms.empty()) {
    tick.terms = apply_terms(force.terms, force.rendering, seen_by_terms(model, state, tick, out.model_force_n), tick.moved_mm, state.terms);
    out.model_force_n = voigt_force_n(tick.tissue(), tick.penetration_mm, speed_mm_s, tick.terms.tissue_n);
    if (tick.contact.touching) out.model_force_n += dot(tick.terms.drag_n, tick.contact.normal);
    if (!tick.terms.finite) out.notices |= k_notice_not_finite;
  }
  out.drag_n = tick.terms.drag_n;
  out.contact = tick.contact.touching;
  out.penetration_mm = tick.penetration_mm;
  out.approach_mm_s = speed_mm_s;
  out.stiffness_n_per_mm = tick.tissue().stiffness_n_per_mm;
  out.normal = tick.contact.touching ? tick.contact.normal : Vec3{};
}

Vec3 render(const ServoModel& model, ServoState& state, const Tick& tick) noexcept {
  const ServoConfig& config = model.config;
  const double fastest = fastest_mm_s(state.estimate, tick.contact.normal, state.tick, config.position_quantum_mm, config.tick_s);
  const double along_n = render_force_n(model.force.rendering, tick.tissue(), state.render, tick.contact.touching, tick.penetration_mm,
                                        tick.approach_mm, config.tick_s, tick.terms.tissue_n, fastest);
  return (tick.contact.touching ? tick.contact.normal * along_n : Vec3{}) + tick.terms.rendered_drag_n;
}

}  // namespace cavum
