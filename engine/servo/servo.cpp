#include "engine/servo/servo.h"

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "engine/base/hash.h"

namespace cavum {
namespace {

// Recession is gathered up to a step before the octree is edited: a leaf of 0.025 mm at once, a quarter of a coarse one. A tool that slides
// is carved after half of it, for the surface it leaves behind is the one it felt; before void tissue a quarter, so that its first leaf goes in time;
// and what a tool still owes as it lifts off is carved where it last was, or many short touches would cut nothing.
constexpr double k_least_step_mm = 0.025, k_carve_step_leaves = 0.25;
constexpr double k_slide_mm = 0.1, k_slide_share = 0.5, k_void_share = 0.25, k_lift_share = 0.04;
constexpr double k_sweep_step_leaves = 1.0;  // way through void tissue between two carves
constexpr double k_clamped_steps = 1.9;      // recession owed by a head that is clamped in its hole
constexpr double k_most_steps = 2.2;         // more recession is never owed
constexpr double k_most_ahead_leaves = 0.1;  // the proxy is paid for no more than that in advance
constexpr double k_same_hole_leaves = 0.5;   // a proxy that comes back is in the hole it left when it is no further aside
constexpr double k_ease = 0.1;               // of that recession
constexpr int k_tick_work = 800, k_hurried_work = 2400, k_least_work = 400;  // units (15 ns each) a tick for a carve under way
constexpr double k_hurry_share = 0.25;                                       // of a step
constexpr int k_busy_looked_up = 150;                                        // places: after more of them a carve waits for the next tick
constexpr int k_lookup_work = 4;                                             // of them, that a place looked up by the contact costs
constexpr double k_still_share = 0.01;                                       // of the full speed: below it the handpiece stands still
constexpr std::size_t k_edit_room = 1 << 17;                                 // bricks; untouched room costs no memory
constexpr std::size_t k_removed_room = 1 << 16;                              // leaves a tick

std::int32_t to_whole(double value) noexcept {
  if (!(value > -2147483647.0)) return -2147483647;
  if (!(value < 2147483647.0)) return 2147483647;
  return static_cast<std::int32_t>(std::floor(value + 0.5));
}

/// Speed of the handpiece after this tick; without a known pedal it stops at once.
double next_rpm(const ServoConfig& config, double rpm, const TickInput& input) noexcept {
  if ((input.flags & k_pedal_fresh) == 0) return 0.0;
  constexpr double k_dead_travel = 0.02;
  const double pedal = input.pedal();
  const double wanted = pedal > k_dead_travel ? pedal * config.max_rpm : 0.0;
  rpm += (wanted - rpm) * (config.tick_s / (config.spin_up_s + config.tick_s));
  return wanted == 0.0 && rpm < k_still_share * config.max_rpm ? 0.0 : rpm;
}

/// Sine and cosine of twice the angle from z towards x, times the square of the normal's part in that plane: no jump where it leaves it.
SinCos approach_of(Vec3 normal) noexcept { return {2.0 * normal.x * normal.z, normal.z * normal.z - normal.x * normal.x}; }

/// Recession between two carves, mm.
double carve_step_mm(double leaf_mm) noexcept { return std::max(k_carve_step_leaves * leaf_mm, k_least_step_mm); }

/// Goes on with the carve under way.
void carve(const ServoModel& model, ServoState& state, int work, TickOutput& out) noexcept {
  const CarvedHead head = state.carving.now;
  const auto done = go_on_carving(state.carving, state.tooth, model.tray[static_cast<std::size_t>(head.point)].point, work, state.removed);
  if (done == CarvingStep::no_room) out.notices |= k_notice_tooth_full;
  if (done == CarvingStep::done) state.contact.opened = {head.tip_mm, head.rotation == state.contact.rotation ? state.contact.turned_rad : -1.0};
}

/// What a tool that lifts off still owes is carved where it was.
void carve_what_is_owed(ServoState& state, const CarvedHead& last_touch, Vec3 normal) noexcept {
  if (last_touch.point < 0 || state.recession_mm < k_lift_share * carve_step_mm(state.tooth.leaf_mm())) return;
  begin_carving(state.carving, {last_touch.tip_mm - normal * state.recession_mm, last_touch.rotation, last_touch.point}, 0.0);
  state.carve_began_mm = 0.0;
  state.swept_mm = 0.0;
}

/// What a proxy that comes back to where the head was carved owes beforehand, mm, at most 0: the hole is a clearance deeper than the head was.
double begun_with_mm(const ServoState& state, int point) noexcept {
  const CarvedHead& last = state.carving.last;
  if (last.point != point) return 0.0;
  const double leaf = state.tooth.leaf_mm(), deeper_mm = dot(last.tip_mm - state.contact.proxy_mm, state.contact.normal);
  const bool there = length(last.tip_mm - state.contact.proxy_mm - state.contact.normal * deeper_mm) <= k_same_hole_leaves * leaf;
  return there ? -std::clamp(deeper_mm, 0.0, k_most_ahead_leaves * leaf) : 0.0;
}

/// Lets the surface recede and carves when enough has gathered.
void cut(const ServoModel& model, ServoState& state, const ContactTool& tool, const ContactResult& contact, const TouchedMeans& means,
         double penetration_mm, int input_point, TickOutput& out) noexcept {
  const double leaf = state.tooth.leaf_mm(), step = carve_step_mm(leaf);
  state.swept_mm += length(contact.moved_mm);
  const double due_mm = step * (means.void_tissue ? k_void_share : state.swept_mm >= k_slide_mm ? k_slide_share : 1.0);
  bool due = false;
  if (means.touching) {
    // v = X/τ · rpm/rpm_ref (slope 0.505 mm of the paper’s eq. 6 over 0.25 mm/s)
    state.recession_mm += penetration_mm * means.of.recession_per_s * (state.rpm / model.force.rpm_ref) * model.config.tick_s;
    state.recession_mm = std::min(state.recession_mm, k_most_steps * step);
    due = state.recession_mm >= due_mm;
    out.cutting = means.of.recession_per_s > 0;
  }
  // Contact and carving share the time of a tick. A carve takes more of it once a good part of what the next one takes has gathered.
  const bool hurries = state.carving.under_way() && state.recession_mm - state.carve_began_mm >= k_hurry_share * due_mm;
  const int work = std::max((hurries ? k_hurried_work : k_tick_work) - k_lookup_work * state.contact.looked_up, k_least_work);
  if (state.carving.under_way()) {
    // A carve may take its time as long as the next one is not due.
    const bool late = state.recession_mm - state.carve_began_mm >= due_mm || state.swept_mm >= k_sweep_step_leaves * leaf;
    if (late && (means.touching || means.void_tissue)) {
      carve(model, state, k_at_once, out);
    } else {
      state.carve_waits = !state.carve_waits && state.contact.looked_up > k_busy_looked_up;
      if (!state.carve_waits) carve(model, state, work, out);
    }
    return;
  }
  if (means.void_tissue && state.swept_mm >= k_sweep_step_leaves * leaf) due = true;
  if (!due) return;
  const double ahead = means.touching ? std::max(0.0, state.recession_mm) : 0.0;
  const Vec3 at = state.contact.proxy_mm - state.contact.normal * ahead;
  // Where the head was carved already (held up by neck or shank, or swinging in its hole) there is nothing to gain.
  const Mat3& turned = state.contact.rotation;
  const CarvedHead& last = state.carving.last;
  if (last.point == input_point) {
    const Vec3 top{0, 0, tool.point.cutting_length_mm};
    const Vec3 tip_way = at - last.tip_mm, top_way = tip_way + turned * top - last.rotation * top;
    if (length(tip_way) + length(top_way) < due_mm) return;
  }
  // A recession that the proxy does not follow means a head clamped by the rounding between leaves: ease it by a few micrometres.
  begin_carving(state.carving, {at, turned, input_point}, ahead > k_clamped_steps * step ? k_ease * ahead : 0.0);
  state.carve_began_mm = state.recession_mm;
  state.swept_mm = 0.0;
  state.carve_waits = state.contact.looked_up > k_busy_looked_up;
  if (!state.carve_waits) carve(model, state, work, out);
}

}  // namespace

TickInput make_tick_input(const Pose& pose, double pedal, std::uint16_t flags, std::uint8_t point, const TickInput& previous) noexcept {
  TickInput in = previous;
  in.flags = flags;
  in.point = point;
  constexpr double k_furthest_mm = 2000.0;
  const Quat q = pose.rotation;
  const double n2 = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  const Vec3 t = pose.tip_mm;
  if (is_finite(t) && std::fabs(t.x) < k_furthest_mm && std::fabs(t.y) < k_furthest_mm && std::fabs(t.z) < k_furthest_mm && n2 > 0.25 && n2 < 4.0) {
    in.tip_nm = {to_whole(t.x * 1e6), to_whole(t.y * 1e6), to_whole(t.z * 1e6)};
    const Quat u = normalized(q);
    constexpr double k_one = 1 << 30;
    in.rotation_q30 = {to_whole(u.w * k_one), to_whole(u.x * k_one), to_whole(u.y * k_one), to_whole(u.z * k_one)};
  } else {
    in.flags = static_cast<std::uint16_t>((in.flags & ~k_stylus_fresh) | k_stylus_fault);
  }
  if (pedal >= 0.0 && pedal <= 1.0) {
    in.pedal_q16 = static_cast<std::uint16_t>(pedal * 65535.0 + 0.5);
  } else {
    in.pedal_q16 = 0;
    in.flags = static_cast<std::uint16_t>(in.flags & ~k_pedal_fresh);
  }
  return in;
}

TickRecord make_tick_record(const TickOutput& out) noexcept {
  TickRecord r;
  r.rendered_un = {to_whole(out.rendered_force_n.x * 1e6), to_whole(out.rendered_force_n.y * 1e6), to_whole(out.rendered_force_n.z * 1e6)};
  r.model_un = to_whole(out.model_force_n * 1e6);
  r.penetration_nm = to_whole(out.penetration_mm * 1e6);
  r.proxy_nm = {to_whole(out.proxy_mm.x * 1e6), to_whole(out.proxy_mm.y * 1e6), to_whole(out.proxy_mm.z * 1e6)};
  r.rpm = to_whole(out.rpm);
  r.removed = out.removed_count;
  r.notices = out.notices;
  return r;
}

ServoModel make_servo_model(const Tooth& tooth, const std::vector<DiamondPoint>& tray, const ForceModel& force, const ServoConfig& config) {
  if (tray.empty() || tray.size() > 255) throw Error("tray", "holds " + std::to_string(tray.size()) + " diamond points", "allow between 1 and 255");
  ServoModel model;
  model.config = config;
  model.force = force;
  for (const auto& p : tray) model.tray.push_back(make_contact_tool(p));
  model.voids = VoidMap(tooth.octree);
  for (const auto& t : tooth.tissues) {
    const auto found = force.materials.find(t.name);
    if (found == force.materials.end()) {
      if (!t.solid) continue;  // a void without entry resists nothing
      throw Error("force model '" + force.name + "'", "has no material for tissue '" + t.name + "'", "add [materials." + t.name + "]");
    }
    const Material& m = found->second;
    if (t.solid && !(m.tau_s > 0)) throw Error("force model '" + force.name + "'", "has no tau_s for solid tissue '" + t.name + "'", "add tau_s");
    model.tissue[t.id] = {m.voigt.stiffness_n_per_mm, m.voigt.damping_n_s_per_mm, t.solid ? 1.0 / m.tau_s : 0.0};
  }
  return model;
}

ServoState make_servo_state(const ServoModel& model, const Tooth& tooth, Vec3 first_tip_mm) {
  ServoState state;
  state.tooth = tooth.octree;
  state.tooth.reserve_edits(k_edit_room);
  state.contact = make_contact_state(model.tray, first_tip_mm);
  state.followed_edit = state.tooth.edit_hash();
  state.estimate = make_tip_estimate(make_tick_input({first_tip_mm, {}}, 0.0, 0, 0, {}).tip_nm);
  state.last_tip_mm = first_tip_mm;
  state.terms = make_terms_state(model.force.terms);
  state.removed.reserve(k_removed_room);
  return state;
}

TickOutput step(const ServoModel& model, ServoState& state, const TickInput& input) noexcept {
  TickOutput out;
  state.removed.clear();
  const double dt = model.config.tick_s;
  const bool fresh = (input.flags & k_stylus_fresh) != 0;
  if ((input.flags & k_pedal_fresh) == 0) out.notices |= k_notice_no_pedal;
  state.rpm = next_rpm(model.config, state.rpm, input);
  update_tip_estimate(state.estimate, input.tip_nm, state.tick, model.config.position_quantum_mm, dt);

  double wanted_n = 0.0;
  Vec3 wanted_drag_n;
  if (input.point < model.tray.size()) {
    const ContactTool& tool = model.tray[input.point];
    const Pose device{state.estimate.tip_mm, input.pose().rotation};
    const bool was_touching = state.contact.touching;
    const CarvedHead last_touch{state.contact.proxy_mm, state.contact.rotation, state.contact.point};
    const Vec3 last_normal = state.contact.normal;
    const ContactResult contact = update_contact(state.tooth, tool, input.point, device, state.contact);
    // What the proxy advanced along the contact when the tooth was carved is paid from the recession that was owed; so the surface
    // recedes at exactly v·dt, whatever the rounding of a single carve. A proxy that only slides pays nothing: its normal is within a
    // degree of the surface's, which over 2 mm would add up to half a leaf.
    if (was_touching && !contact.touching) carve_what_is_owed(state, last_touch, last_normal);
    if (!contact.touching)
      state.recession_mm = 0.0;
    else if (!was_touching)
      state.recession_mm = begun_with_mm(state, input.point);
    else if (state.followed_edit != state.contact.gathered.edit)
      state.recession_mm = std::max(state.recession_mm + dot(contact.moved_mm, contact.normal), -k_most_ahead_leaves * state.tooth.leaf_mm());
    if (!contact.on_its_way) state.followed_edit = state.contact.gathered.edit;
    const TouchedMeans before = state.contact.touched.means;
    TouchedMeans means = !contact.in_air && (contact.touching || state.rpm > 0)
                             ? touched_means(state.tooth, tool, model.voids, model.tissue.data(), std::max(0.0, state.recession_mm), state.contact)
                             : TouchedMeans{};
    if (contact.on_its_way && was_touching && !means.touching) {
      // A proxy between two places of contact touches nothing; what it left speaks until it arrives, or the force would drop out for a tick.
      means.touching = before.touching;
      means.of = before.of;
      means.of.recession_per_s = 0.0;
      state.contact.touched.means = means;
    }
    const double approach_mm = contact.touching ? -dot(device.tip_mm - state.last_tip_mm, contact.normal) : 0.0;
    const double penetration = contact.touching ? std::max(0.0, contact.penetration_mm - state.recession_mm) : 0.0;
    const Viscoelastic tissue{means.of.stiffness_n_per_mm, means.of.damping_n_s_per_mm};
    update_speed(model.force.rendering, state.render, contact.touching, approach_mm, dt);
    out.model_force_n = voigt_force_n(tissue, penetration, state.render.speed_mm_s);
    TermsForce terms;
    if (!model.force.terms.empty()) {
      const double removed_mm3 = state.terms.removed_leaves[input.point] * state.tooth.leaf_volume_mm3();
      const TermInput seen{.touching = contact.touching,
                           .penetration_mm = penetration,
                           .approach_mm_s = state.render.speed_mm_s,
                           .stiffness_n_per_mm = tissue.stiffness_n_per_mm,
                           .damping_n_s_per_mm = tissue.damping_n_s_per_mm,
                           .voigt_n = out.model_force_n,
                           .rpm = state.rpm,
                           .tick = state.tick,
                           .dt_s = dt,
                           .time_s = static_cast<double>(state.tick) * dt,
                           .wet = state.rpm > 0.0 ? 1.0 : 0.0,
                           .removed_mm3 = removed_mm3,
                           .removed_on_mm3 = removed_mm3,
                           .approach = contact.touching ? approach_of(contact.normal) : SinCos{}};
      terms = apply_terms(model.force.terms, model.force.rendering, seen, device.tip_mm - state.last_tip_mm, state.terms);
      out.model_force_n = voigt_force_n(tissue, penetration, state.render.speed_mm_s, terms.tissue_n);
      if (contact.touching) out.model_force_n += dot(terms.drag_n, contact.normal);
      out.drag_n = terms.drag_n;
      wanted_drag_n = terms.rendered_drag_n;
      if (!terms.finite) out.notices |= k_notice_not_finite;
    }
    wanted_n = render_force_n(model.force.rendering, tissue, state.render, contact.touching, penetration, approach_mm, dt, terms.tissue_n,
                              fastest_mm_s(state.estimate, contact.normal, state.tick, model.config.position_quantum_mm, dt));
    if (state.rpm < k_still_share * model.config.max_rpm || state.carving.now.point != input.point) drop_carving(state.carving);
    if (state.rpm >= k_still_share * model.config.max_rpm) cut(model, state, tool, contact, means, penetration, input.point, out);
    if (state.terms.counts_removed) state.terms.removed_leaves[input.point] += static_cast<std::uint32_t>(state.removed.size());
    state.last_tip_mm = device.tip_mm;
    out.contact = contact.touching;
    out.penetration_mm = penetration;
    out.approach_mm_s = state.render.speed_mm_s;
    out.stiffness_n_per_mm = tissue.stiffness_n_per_mm;
    out.normal = contact.touching ? contact.normal : Vec3{};
  } else {
    out.notices |= k_notice_bad_point;
    state.rpm = 0.0;
    drop_carving(state.carving);
  }
  out.proxy_mm = state.contact.proxy_mm;
  out.rpm = state.rpm;
  out.removed_count = static_cast<std::uint32_t>(state.removed.size());
  Vec3 wanted = out.normal * wanted_n;
  if (!model.force.terms.empty()) wanted += wanted_drag_n;
  out.rendered_force_n = make_safe(model.config.limits, state.safety, wanted, fresh, dt, out.notices);

  ++state.tick;
  const TickRecord record = make_tick_record(out);
  state.trace_hash = fast_hash(record.rendered_un.data(), sizeof record.rendered_un, state.trace_hash);
  const std::array<std::int64_t, 8> rest{record.model_un, record.penetration_nm, record.proxy_nm[0], record.proxy_nm[1], record.proxy_nm[2],
                                         record.rpm,      record.removed,        record.notices};
  state.trace_hash = fast_hash(rest.data(), sizeof rest, state.trace_hash);
  return out;
}

std::uint64_t state_hash(const ServoState& s) noexcept {
  const std::array<std::uint64_t, 5> whole{static_cast<std::uint64_t>(s.tick), s.trace_hash, s.tooth.edit_hash(), s.followed_edit,
                                           s.carving.under_way() ? s.carving.plan.progress() : 0};
  const std::array<double, 17> parts{s.contact.proxy_mm.x, s.contact.proxy_mm.y,
                                     s.contact.proxy_mm.z, s.contact.normal.x,
                                     s.contact.normal.y,   s.contact.normal.z,
                                     s.render.branch_n,    s.render.speed_mm_s,
                                     s.safety.force_n.x,   s.safety.force_n.y,
                                     s.safety.force_n.z,   s.safety.used_budget_n_s,
                                     s.safety.silent_s,    s.rpm,
                                     s.recession_mm,       s.swept_mm,
                                     s.carve_began_mm};
  const std::uint64_t rest = fast_hash(parts.data(), sizeof parts, fast_hash(whole.data(), sizeof whole, k_physics_version));
  return hash_of(s.terms, hash_of(s.estimate, rest));
}

}  // namespace cavum
