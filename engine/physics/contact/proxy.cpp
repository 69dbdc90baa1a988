#include "engine/physics/contact/proxy.h"

#include <algorithm>
#include <cmath>

#include "engine/physics/contact/tuning.h"

namespace cavum {

using namespace tuning;

namespace {

constexpr int k_no_limit = 1 << 30;

/// Furthest that a sample at unit distance from the tip moves when the rotation changes from `a` to
/// `b` (Frobenius norm, an upper bound).
double turn_bound_rad(const Mat3& a, const Mat3& b) noexcept {
  const Vec3 x = a.row_x - b.row_x, y = a.row_y - b.row_y, z = a.row_z - b.row_z;
  return std::sqrt(dot(x, x) + dot(y, y) + dot(z, z));
}

double travel_mm(const ContactState& state, double lever_mm) noexcept {
  return state.moved_mm + state.turned_rad * lever_mm;
}

/// Free way around the whole tool, in mm of travel; 0 when something is near.
double tool_air_mm(const Octree& tooth, const ContactTool& tool, const Mat3& rotation,
                   Vec3 tip) noexcept {
  const double half = 0.5 * tool.reach_mm;
  const Vec3 middle = tip + rotation * Vec3{0, 0, half};
  for (const double margin : {4.0, 1.0}) {
    const double r = half + 1.0 + margin;
    if (tooth.is_air(middle - Vec3{r, r, r}, middle + Vec3{r, r, r})) return margin;
  }
  return 0;
}

/// Forgets every clearance: another bur was mounted, or the first tick.
void reset(ContactState& state, const ContactTool& tool, int bur) noexcept {
  state.bur = bur;
  state.clear.tool_air_until_mm = state.clear.tool_near_until_mm = -1.0;
  std::fill_n(state.clear.patch_clear_until_mm.begin(), tool.patches.size(), -1.0);
  std::fill_n(state.clear.patch_near_until_mm.begin(), tool.patches.size(), -1.0);
  std::fill_n(state.clear.sample_clear_until_mm.begin(), tool.samples.size(), -1.0);
  state.gathered.turned_rad = -1.0;
  state.catching_up = false;
  state.opened = {};
}

/// So far from where they were gathered half spaces stand in for the surface.
double linear_mm(double leaf_mm) noexcept {
  return std::max(k_linear_leaves * leaf_mm, k_linear_mm);
}

/// Room before a surface at `distance_mm`, as half spaces state it.
double slack_mm(double distance_mm, double leaf_mm) noexcept {
  if (distance_mm >= 0.0) return distance_mm;
  return std::max(std::min(distance_mm + k_dead_leaves * leaf_mm, 0.0),
                  -k_deepest_leaves * leaf_mm);
}

/// Begins to gather half spaces about a place, for steps of `reach_mm` and small moves.
void begin_gathering(const Octree& tooth, Vec3 at_mm, double reach_mm, const ContactState& state,
                     GatheredContact& g) noexcept {
  const double leaf = tooth.leaf_mm();
  g.at_mm = at_mm;
  g.turned_rad = state.turned_rad;
  g.edit = tooth.edit_hash();
  g.reach_mm = std::max(reach_mm, k_gather_leaves * leaf) + linear_mm(leaf);
  g.half_spaces.clear();
  g.samples.clear();
  g.next_patch = g.next_sample = 0;
}

/// Goes on to collect a half space for each sample that a step could bring into contact; true when
/// all have been asked, false after `most` places.
bool go_on_gathering(const Octree& tooth, const ContactTool& tool, int most, ContactState& state,
                     GatheredContact& g, ContactScratch& scratch) noexcept {
  const double leaf = tooth.leaf_mm(), off_mm = length(g.at_mm - state.proxy_mm);
  const int last_looked_up = scratch.looked_up + most;
  for (; g.next_patch < tool.patches.size(); ++g.next_patch) {
    const auto& patch = tool.patches[g.next_patch];
    const double travel = travel_mm(state, patch.lever_mm), far_mm = travel + g.reach_mm + off_mm;
    if (far_mm <= state.clear.patch_clear_until_mm[g.next_patch]) continue;
    if (travel + off_mm > state.clear.patch_near_until_mm[g.next_patch]) {
      const double r = patch.radius_mm + k_margin_mm;
      const Vec3 middle = g.at_mm + state.rotation * patch.centre_mm;
      if (tooth.is_clear(middle - Vec3{r, r, r}, middle + Vec3{r, r, r})) {
        state.clear.patch_clear_until_mm[g.next_patch] = travel + k_margin_mm - off_mm;
        continue;
      }
      state.clear.patch_near_until_mm[g.next_patch] = travel + k_stays_near_mm;
    }
    for (std::uint32_t i = std::max(g.next_sample, patch.first); i < patch.last; ++i) {
      if (far_mm <= state.clear.sample_clear_until_mm[i]) continue;
      if (scratch.looked_up >= last_looked_up) {
        g.next_sample = i;
        return false;
      }
      const auto s = tooth.sample(g.at_mm + state.rotation * tool.samples[i].at_mm, scratch.cursor);
      ++scratch.looked_up;
      state.clear.sample_clear_until_mm[i] = travel + s.distance_mm - off_mm;
      if (s.distance_mm > g.reach_mm) continue;
      if (dot(s.gradient, s.gradient) < 1e-3) continue;  // no direction out: neighbours speak
      g.half_spaces.push_back({s.gradient, slack_mm(s.distance_mm, leaf)});
      g.samples.push_back(i);
    }
  }
  return true;
}

/// Makes sure that the half spaces in force are good for a step of `reach_mm` from where the proxy
/// is.
void gather(const Octree& tooth, const ContactTool& tool, double reach_mm, ContactState& state,
            ContactScratch& scratch) noexcept {
  GatheredContact& g = state.gathered;
  const double moved_mm = length(state.proxy_mm - g.at_mm);
  if (g.turned_rad == state.turned_rad && (g.edit == tooth.edit_hash() || state.catching_up) &&
      moved_mm <= linear_mm(tooth.leaf_mm()) && g.reach_mm >= reach_mm + moved_mm)
    return;
  begin_gathering(tooth, state.proxy_mm, reach_mm, state, g);
  (void)go_on_gathering(tooth, tool, k_no_limit, state, g, scratch);
  state.active = {};
  state.catching_up = false;
}

/// How far the opened place lies ahead of the proxy, mm; 0 when the proxy cannot simply take it: it
/// has gone elsewhere, or the device is not that far.
double opened_travel_mm(const OpenedPosition& opened, Vec3 device_mm, double leaf_mm,
                        const ContactState& state) noexcept {
  if (opened.turned_rad != state.turned_rad) return 0.0;
  const Vec3 way = opened.tip_mm - state.proxy_mm;
  const double ahead_mm = -dot(way, state.normal);
  const bool beyond = ahead_mm <= 0.0 || ahead_mm > dot(state.proxy_mm - device_mm, state.normal);
  return beyond || length(way + state.normal * ahead_mm) > k_aside_leaves * leaf_mm ? 0.0
                                                                                    : ahead_mm;
}

/// After a carve: gathers anew a part in each tick, and then follows.
void catch_up(const Octree& tooth, const ContactTool& tool, Vec3 device_mm, double reach_mm,
              ContactState& state, ContactScratch& scratch) noexcept {
  if (!state.touching || state.gathered.edit == tooth.edit_hash() ||
      state.gathered.turned_rad != state.turned_rad) {
    state.catching_up = false;
    return;
  }
  GatheredContact& coming = state.coming;
  const double leaf = tooth.leaf_mm();
  if (!state.catching_up) {
    begin_gathering(tooth,
                    opened_travel_mm(state.opened, device_mm, leaf, state) > 0.0
                        ? state.opened.tip_mm
                        : state.proxy_mm,
                    reach_mm, state, coming);
    state.catching_up = true;
  }
  if (!go_on_gathering(tooth, tool, k_part_looked_up, state, coming, scratch)) return;
  state.catching_up = false;
  std::swap(state.gathered, state.coming);
  state.active = {};
  const double moved_mm = opened_travel_mm(state.opened, device_mm, leaf, state);
  // The head has room there; neck and shank may not.
  const auto& there = state.gathered.half_spaces;
  const bool room = std::all_of(there.begin(), there.end(), [&](const HalfSpace& h) {
    return h.slack_mm >= -k_room_leaves * leaf;
  });
  if (moved_mm > 0.0 && room && state.gathered.at_mm == state.opened.tip_mm) {
    state.moved_mm += length(state.opened.tip_mm - state.proxy_mm);
    state.proxy_mm = state.opened.tip_mm;
  }
  state.opened = {};
}

/// The step from `gathered.at_mm` nearest to the wanted one. Samples alone would let the head sink
/// in between them: where it rests, the head's own furthest place against the surface is asked too,
/// and becomes a half space if it enters the tissue.
HalfSpaceSolution solve(const Octree& tooth, const ContactTool& tool, Vec3 wanted, double stride_mm,
                        ContactState& state, ContactScratch& scratch) noexcept {
  auto solution = nearest_step(wanted, state.gathered.half_spaces, state.active);
  const double leaf = tooth.leaf_mm();
  const Vec3 since = state.proxy_mm - state.gathered.at_mm;
  for (int round = 0; round < k_refinements && solution.feasible && solution.active.count > 0;
       ++round) {
    const Vec3 way = solution.step - since;
    const double moved_mm = length(way);
    const Vec3 there = moved_mm > stride_mm ? since + way * (stride_mm / moved_mm) : solution.step;
    bool refined = false;
    for (int i = 0; i < solution.active.count; ++i) {
      const Vec3 normal = normalized(
          state.gathered.half_spaces[static_cast<std::size_t>(solution.active.at[i])].normal);
      const Vec3 furthest = tool.furthest_along(state.rotation.transposed(-normal));
      const auto s =
          tooth.sample(state.gathered.at_mm + there + state.rotation * furthest, scratch.cursor);
      if (s.distance_mm >= -k_dead_leaves * leaf || dot(s.gradient, s.gradient) < 1e-3) continue;
      if (state.gathered.half_spaces.size() >=
          state.gathered.samples.size() +
              k_refined_room) {  // begin anew; the active ones go with them
        state.gathered.half_spaces.resize(state.gathered.samples.size());
        solution.active.count = 0;
      }
      state.gathered.half_spaces.push_back(
          {s.gradient, slack_mm(s.distance_mm, leaf) - dot(s.gradient, there)});
      refined = true;
    }
    if (!refined) break;
    solution = nearest_step(wanted, state.gathered.half_spaces, solution.active);
  }
  state.active = solution.active;
  return solution;
}

/// Is there nothing but air around the whole tool on its way to the device?
bool path_is_free(const Octree& tooth, const ContactTool& tool, Vec3 device_mm,
                  ContactState& state) noexcept {
  const double moved_mm = length(device_mm - state.proxy_mm),
               travel = travel_mm(state, tool.reach_mm);
  if (state.clear.tool_air_until_mm <= travel + moved_mm &&
      state.clear.tool_near_until_mm <= travel) {
    const double air_mm = tool_air_mm(tooth, tool, state.rotation, state.proxy_mm);
    state.clear.tool_air_until_mm = travel + air_mm;
    if (air_mm == 0.0) state.clear.tool_near_until_mm = travel + k_stays_near_mm;
  }
  return travel + moved_mm < state.clear.tool_air_until_mm;
}

/// One step of the proxy.
struct ProxyStep {
  Vec3 step;
  double mm = 0.0;       ///< its length
  bool blocked = false;  ///< the tooth holds the tool before the device
  bool is_long = false;  ///< more than half a stride
  bool back = false;     ///< and it leads back the way the one before came
};

/// The way to the device as far as the tooth and the stride allow. One back makes the stride
/// shorter.
ProxyStep next_step(const Octree& tooth, const ContactTool& tool, Vec3 rest, ContactState& state,
                    ContactScratch& scratch) noexcept {
  const double leaf = tooth.leaf_mm();
  double& stride = state.stride_mm;
  gather(tooth, tool, std::min(length(rest), stride) + k_gather_more_leaves * leaf, state, scratch);
  // The whole way is projected, and what is left of it shortened: a deep push must not hold back a
  // slide. The half spaces stand about the place where they were gathered: so do the steps.
  const Vec3 since = state.proxy_mm - state.gathered.at_mm;
  auto solution = solve(tooth, tool, since + rest, stride, state, scratch);
  if (!solution.feasible) {  // squeezed between walls: do not enter them further, whatever the
                             // depth so far
    for (auto& h : state.gathered.half_spaces)
      h.slack_mm = std::max(h.slack_mm, k_squeeze_leaves * leaf);
    state.gathered.turned_rad = -1.0;
    solution = nearest_step(since + rest, state.gathered.half_spaces);
  }
  solution.step -= since;
  ProxyStep s{.step = solution.feasible ? solution.step : Vec3{}};
  s.mm = length(s.step);
  s.is_long = s.mm > 0.5 * stride;
  s.back = s.is_long && state.touching && dot(s.step, state.last_step_mm) < 0.0;
  if (s.back) stride = std::max(k_shorter * stride, k_resting_stride * leaf);
  if (s.mm > stride) {
    s.step = s.step * (stride / s.mm);
    s.mm = stride;
  }
  const Vec3 held = solution.step - rest;
  s.blocked = !solution.feasible || dot(held, held) > k_settled_mm * k_settled_mm;
  return s;
}

/// Moves the proxy towards the device, near the tooth; true when the tooth holds it before.
bool approach(const Octree& tooth, const ContactTool& tool, Vec3 device_mm, ContactState& state,
              ContactScratch& scratch, bool& still_moving) noexcept {
  // A tool at rest in its hole needs to look around only a little; one on its way takes whole
  // leaves. Where the surface turns under a step the next one leads back: less far, or the proxy
  // would go forth and back for ever.
  const double leaf = tooth.leaf_mm();
  double& stride = state.stride_mm;
  if (!state.touching) stride = leaf;
  bool strode = false, blocked = false;
  int times_back = 0;
  catch_up(tooth, tool, device_mm,
           std::min(length(device_mm - state.proxy_mm), stride) + k_gather_more_leaves * leaf,
           state, scratch);
  for (int i = 0; i < k_max_steps; ++i) {
    const Vec3 rest = device_mm - state.proxy_mm;
    const ProxyStep s = next_step(tooth, tool, rest, state, scratch);
    times_back += s.back;
    blocked = s.blocked;
    if (s.mm <= k_settled_mm) break;  // settled: standing still keeps what was gathered
    state.proxy_mm += s.step;
    state.moved_mm += s.mm;
    if (!blocked && length(rest) <= stride) break;
    state.last_step_mm = s.step;
    strode |= s.is_long;
    if (s.is_long && !s.back) stride = std::min(k_longer * stride, leaf);
    still_moving = i + 1 == k_max_steps ||
                   scratch.looked_up > (times_back > 1 ? k_max_going_back : k_max_looked_up);
    if (still_moving) break;
  }
  if (!strode) {  // at rest
    stride = std::max(k_shorter * stride, k_resting_stride * leaf);
    state.last_step_mm = {};
  }
  return blocked;
}

std::size_t most_samples(const std::vector<ContactTool>& tray) {
  std::size_t most = 0;
  for (const auto& t : tray) most = std::max(most, t.samples.size());
  return most;
}

}  // namespace

ContactState make_contact_state(const std::vector<ContactTool>& tray, Vec3 first_tip_mm) {
  ContactState state;
  state.proxy_mm = first_tip_mm;
  const std::size_t samples = most_samples(tray);
  std::size_t patches = 0;
  for (const auto& t : tray) patches = std::max(patches, t.patches.size());
  state.clear.sample_clear_until_mm.assign(samples, -1.0);
  state.clear.patch_clear_until_mm.assign(patches, -1.0);
  state.clear.patch_near_until_mm.assign(patches, -1.0);
  for (GatheredContact* g : {&state.gathered, &state.coming}) {
    g->samples.reserve(samples);
    g->half_spaces.reserve(samples + k_refined_room);
  }
  return state;
}

ContactScratch make_contact_scratch(const std::vector<ContactTool>& tray) {
  ContactScratch scratch;
  scratch.counted.assign(most_samples(tray), 0);
  return scratch;
}

ContactResult solve_proxy(const Octree& tooth, const ContactTool& tool, int bur, const Pose& device,
                          ContactState& state, ContactScratch& scratch) noexcept {
  const Vec3 before = state.proxy_mm;
  scratch.looked_up = 0;
  const Mat3 turned = rotation(device.rotation);
  state.turned_rad += turn_bound_rad(state.rotation, turned);
  state.rotation = turned;
  if (state.bur != bur) reset(state, tool, bur);

  ContactResult result;
  bool blocked = false;
  result.in_air = path_is_free(tooth, tool, device.tip_mm, state);
  if (result.in_air) {
    state.moved_mm += length(device.tip_mm - state.proxy_mm);
    state.proxy_mm = device.tip_mm;
  } else {
    blocked = approach(tooth, tool, device.tip_mm, state, scratch, result.still_moving);
  }

  result.moved_mm = state.proxy_mm - before;
  const Vec3 out = state.proxy_mm - device.tip_mm;
  result.penetration_mm = length(out);
  result.touching = blocked && result.penetration_mm > k_settled_mm;
  result.still_moving &= result.touching;
  if (result.touching)
    state.normal = out / result.penetration_mm;
  else
    result.penetration_mm = 0;
  result.normal = state.normal;
  state.touching = result.touching;
  return result;
}

}  // namespace cavum
