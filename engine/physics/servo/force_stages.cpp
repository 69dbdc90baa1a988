// The stages that make a force of what was touched: the model's, which is recorded, and the one
// that a sampled device may be given.
#include "engine/physics/servo/stages.h"

namespace cavum {
namespace {

/// Sine and cosine of twice the angle from z towards x, times the square of the normal's part in
/// that plane: no jump where it leaves it.
SinCos approach_of(Vec3 normal) noexcept {
  return {2.0 * normal.x * normal.z, normal.z * normal.z - normal.x * normal.x};
}

}  // namespace

TermsForce model_terms(const ServoModel& model, const ServoState& now, const Tick& tick,
                       TermsState& terms) noexcept {
  if (model.force.terms.empty()) return {};
  const double dt_s = model.config.tick_s, rpm = now.handpiece.rpm;
  const double removed_mm3 = terms.removed_leaves[tick.input.bur] * now.tooth.leaf_volume_mm3();
  const TermInput seen{
      .touching = tick.contact.touching,
      .penetration_mm = tick.penetration_mm,
      .approach_mm_s = now.render.speed_mm_s,
      .stiffness_n_per_mm = tick.tissue().stiffness_n_per_mm,
      .damping_n_s_per_mm = tick.tissue().damping_n_s_per_mm,
      .voigt_n = voigt_force_n(tick.tissue(), tick.penetration_mm, now.render.speed_mm_s),
      .rpm = rpm,
      .tick = now.tick,
      .dt_s = dt_s,
      .time_s = static_cast<double>(now.tick) * dt_s,
      .wet = rpm > 0.0 ? 1.0 : 0.0,
      .removed_mm3 = removed_mm3,
      .removed_on_mm3 = removed_mm3,
      .approach = tick.contact.touching ? approach_of(tick.contact.normal) : SinCos{}};
  return apply_terms(model.force.terms, model.force.rendering, seen, tick.moved_mm, terms);
}

double model_force(const Tick& tick, double speed_mm_s) noexcept {
  const double along_n =
      voigt_force_n(tick.tissue(), tick.penetration_mm, speed_mm_s, tick.terms.tissue_n);
  return tick.contact.touching ? along_n + dot(tick.terms.drag_n, tick.contact.normal) : along_n;
}

Vec3 render(const ServoModel& model, const ServoState& now, const Tick& tick,
            RenderState& render) noexcept {
  const ServoConfig& config = model.config;
  const double fastest = fastest_mm_s(now.estimate, tick.contact.normal, now.tick,
                                      config.position_quantum_mm, config.tick_s);
  const double along_n = render_force_n(
      model.force.rendering, tick.tissue(), render, tick.contact.touching, tick.penetration_mm,
      tick.approach_mm, config.tick_s, tick.terms.tissue_n, fastest);
  return (tick.contact.touching ? tick.contact.normal * along_n : Vec3{}) +
         tick.terms.rendered_drag_n;
}

}  // namespace cavum
