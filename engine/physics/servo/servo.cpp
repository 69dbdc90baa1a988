#include "engine/physics/servo/servo.h"

#include <fmt/core.h>

#include "engine/base/error.h"
#include "engine/base/state_hash.h"
#include "engine/physics/servo/grinding.h"
#include "engine/physics/servo/stages.h"
#include "engine/tooth/adjacent.h"

namespace cavum {
namespace {

constexpr double k_mm_per_m = 1000.0;
constexpr std::size_t k_max_burs = 255;       // TickInput::bur is a byte
constexpr std::size_t k_edit_room = 1 << 17;  // bricks, 8 million leaves: more than a tooth has at
                                              // its surface; untouched room costs no memory
constexpr std::size_t k_removed_room =
    1 << 16;  // leaves a tick: a ball of 2.5 mm radius at leaves of 0.1 mm, or of 1.2 mm at 0.05

/// A neighbour's enamel is enamel unless the model says otherwise.
auto material_of(const ForceModel& force, const std::string& tissue) {
  const auto found = force.materials.find(tissue);
  return found == force.materials.end() && is_of_neighbour(tissue)
             ? force.materials.find(tissue.substr(k_neighbour_prefix.size()))
             : found;
}

}  // namespace

ServoModel make_servo_model(const Tooth& tooth, const std::vector<Bur>& tray,
                            const ForceModel& force, const ServoConfig& config) {
  if (tray.empty() || tray.size() > k_max_burs)
    throw Error(msg("tray"), msg("holds {} burs", tray.size()), msg("allow between 1 and 255"));
  ServoModel model;
  model.config = config;
  model.force = force;
  for (const auto& p : tray) model.tray.push_back(make_contact_tool(p));
  model.voids = VoidMap(tooth.octree);
  for (const auto& t : tooth.tissues) {
    const auto found = material_of(force, t.name);
    if (found == force.materials.end()) {
      if (!t.solid) continue;  // a void without entry resists nothing
      throw Error(msg("force model '{}'", force.name),
                  msg("has no material for tissue '{}'", t.name),
                  msg("add [materials.{}]", t.name));
    }
    const Material& m = found->second;
    const bool by_pressure = force.law == CuttingLaw::pressure;
    const double cut = by_pressure ? m.wear_mm3_per_n_m : m.tau_s;
    const char* name = by_pressure ? "wear_mm3_per_n_m" : "tau_s";
    if (t.solid && !(cut > 0))
      throw Error(msg("force model '{}'", force.name),
                  msg("has no {} for solid tissue '{}'", name, t.name), msg("add {}", name));
    TissueConstants& of = model.tissue[t.id];
    of.stiffness_n_per_mm = m.voigt.stiffness_n_per_mm;
    of.damping_n_s_per_mm = m.voigt.damping_n_s_per_mm;
    if (t.solid && by_pressure) of.resistance_n_per_mm2 = k_mm_per_m / m.wear_mm3_per_n_m;
    if (t.solid && !by_pressure) of.recession_per_s = 1.0 / m.tau_s;
  }
  return model;
}

ServoState make_servo_state(const ServoModel& model, const Tooth& tooth, Vec3 first_tip_mm) {
  ServoState state;
  state.tooth = tooth.octree;
  state.tooth.reserve_edits(k_edit_room);
  state.contact = make_contact_state(model.tray, first_tip_mm);
  state.scratch = make_contact_scratch(model.tray);
  state.recession.followed_edit = state.tooth.edit_hash();
  state.estimate = make_tip_estimate(make_tick_input({first_tip_mm, {}}, 0.0, 0, 0, {}).tip_nm);
  state.terms = make_terms_state(model.force.terms);
  state.removed.reserve(k_removed_room);
  return state;
}

namespace {

/// The stages of a tick with a bur; the force that the device should render, N.
Vec3 tick_with(const ServoModel& model, ServoState& state, const ContactTool& tool,
               const TickInput& input, Vec3 moved_mm, TickOutput& out) noexcept {
  const double dt_s = model.config.tick_s, leaf_mm = state.tooth.leaf_mm(),
               rpm = state.handpiece.rpm;
  Tick tick{.input = input,
            .tool = tool,
            .device = {state.estimate.tip_mm, input.pose().rotation},
            .moved_mm = moved_mm};
  tick.was_touching = state.contact.touching;
  tick.contact =
      solve_proxy(state.tooth, tool, input.bur, tick.device, state.contact, state.scratch);  // p, n
  const bool touching = tick.contact.touching;
  const CarvedHead left = left_behind(tick, leaf_mm, state.recession);
  tick.penetration_mm = penetration(tick, state.contact, state.carving.last, leaf_mm,
                                    state.recession);  // X = max(0, |p − s| − r)
  tick.approach_mm = touching ? -dot(moved_mm, tick.contact.normal) : 0.0;
  tick.means = tissue_mixture(model, state.tooth, tick, rpm, state.recession, state.contact,
                              state.scratch, state.touched);  // k, c, 1/τ

  update_speed(model.force.rendering, state.render, touching, tick.approach_mm, dt_s);  // V
  const double speed_mm_s = state.render.speed_mm_s;
  tick.terms = model_terms(model, state, tick, state.terms);  // Σ
  out.contact = touching;
  out.normal = touching ? tick.contact.normal : Vec3{};
  out.penetration_mm = tick.penetration_mm;
  out.approach_mm_s = speed_mm_s;
  out.stiffness_n_per_mm = tick.tissue().stiffness_n_per_mm;
  out.model_force_n = model_force(tick, speed_mm_s);  // F = max(0, k X + c V + Σ)
  out.drag_n = tick.terms.drag_n;
  if (!tick.terms.finite) out.notices |= k_notice_not_finite;
  const Vec3 wanted_n = render(model, state, tick, state.render);  // k X + z + b V + Σ, along n

  // F = k X + c V alone: what wear, water or run-out add is felt, and grinds nothing.
  const double pressing_n = voigt_force_n(tick.tissue(), tick.penetration_mm, speed_mm_s);
  if (model.force.drive.torque_n_mm > 0.0)
    state.handpiece.load_n_mm =
        grinding_torque_n_mm(tick.means.grinding, pressing_n, model.force.force_ratio);
  if (!turns(model.config, state.handpiece)) {
    drop_carving(state.carving);
    return wanted_n;
  }
  if (tick.means.touching) {
    recede(model, tick, rpm, pressing_n, state.contact, leaf_mm,
           state.recession);  // r' = X/τ · rpm/rpm_ref, or by pressure
    out.cutting = tick.means.of.recession_per_s > 0 || tick.means.grinding.per_turn_n_per_mm > 0;
  }
  const Carved carved = carve(model, tick, left, state.recession, state.contact, state.tooth,
                              state.removed, state.carving);
  if (carved.opened) state.contact.opened = *carved.opened;
  if (carved.no_room) out.notices |= k_notice_tooth_full;
  if (state.terms.counts_removed)
    state.terms.removed_leaves[input.bur] += static_cast<std::uint32_t>(state.removed.size());
  return wanted_n;
}

}  // namespace

TickOutput step(const ServoModel& model, ServoState& state, const TickInput& input) noexcept {
  const ServoConfig& config = model.config;
  TickOutput out;
  Vec3 wanted_n;
  state.removed.clear();
  if ((input.flags & k_pedal_fresh) == 0) out.notices |= k_notice_no_pedal;
  update_handpiece(config, model.force.drive, input, state.handpiece);
  const Vec3 tip_before_mm = state.estimate.tip_mm;
  update_tip_estimate(state.estimate, input.tip_nm, state.tick, config.position_quantum_mm,
                      config.tick_s);
  if (input.bur < model.tray.size()) {
    wanted_n = tick_with(model, state, model.tray[input.bur], input,
                         state.estimate.tip_mm - tip_before_mm, out);
  } else {
    out.notices |= k_notice_bad_bur;
    state.handpiece = {};
    drop_carving(state.carving);
  }
  out.rpm = state.handpiece.rpm;
  out.proxy_mm = state.contact.proxy_mm;
  out.removed_count = static_cast<std::uint32_t>(state.removed.size());
  out.rendered_force_n = make_safe(config.limits, state.safety, wanted_n,
                                   (input.flags & k_stylus_fresh) != 0, config.tick_s, out.notices);
  state.trace_hash = hash_of(make_tick_record(out), state.trace_hash);
  ++state.tick;
  return out;
}

std::uint64_t state_hash(const ServoState& s) noexcept {
  const auto& [tooth, tick, handpiece, estimate, contact, touched, recession, render, terms,
               carving, safety, trace_hash, removed, scratch] = s;
  StateHash hash(k_physics_version);
  hash(tick, trace_hash, tooth.edit_hash(), handpiece, estimate, contact, touched, recession,
       render, terms, carving, safety);
  return hash.value();
}

}  // namespace cavum
