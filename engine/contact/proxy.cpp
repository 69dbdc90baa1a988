#include "engine/contact/proxy.h"

#include <algorithm>
#include <cmath>

namespace cavum {
namespace {

constexpr int k_max_steps = 12;          // of one leaf: the proxy follows 0.6 mm a tick at a 0.05 mm leaf
constexpr double k_same_normal2 = 1e-4;  // 0.01 rad: the areas seen along the normal have hardly changed
constexpr double k_same_means_leaves = 0.02, k_same_means_mm = 0.001, k_late_means_leaves = 0.05, k_late_means_mm = 0.0025;
constexpr double k_linear_leaves = 0.3, k_linear_mm = 0.0135;  // so far, or that far, a half space stands in for the curved surface
constexpr double k_squeeze_leaves = 0.005;
constexpr double k_deepest_leaves = 0.5;  // a sample that lies deeper is pushed out no faster
constexpr double k_dead_leaves = 0.004;  // one that lies no deeper is not pushed at all: two walls that differ by rounding would squeeze the tool out
constexpr double k_touch_leaves = 0.2;   // a sample nearer than that touches fully; rounding of distances is far less
constexpr double k_fade_leaves = 0.5;    // and from there it touches less and less
constexpr double k_ahead_leaves = 1.6;   // so far before a sample its tissue is looked up: a last leaf over the pulp has faded out when it is cut
constexpr double k_stays_near_mm = 0.3;  // what is near is not asked for air again before that much travel
constexpr double k_settled_mm = 2e-5;    // a smaller step ends the search
constexpr int k_refinements = 8;
constexpr std::size_t k_refined_room = 32;
// Half spaces say little of a crest of tissue between two samples, or of a sheet between head and neck: the proxy goes forth and back over it, and
// gathers anew each time. So a step back makes the stride shorter, and the search ends for this tick once more places than that were looked up,
// sooner after a second step back: the proxy goes on in the next tick. The last gathering comes on top (some 450 places in a deep hole).
constexpr int k_most_looked_up = 1200, k_most_going_back = 300;
constexpr int k_all_places = 1 << 30;
constexpr int k_part_looked_up = 140;              // places of a gathering that is spread over ticks, in each of them
constexpr double k_aside_leaves = 0.1;             // the proxy takes an opened way while it lies no further beside it
constexpr double k_room_leaves = 0.01;             // and nothing there enters the tissue by more
constexpr double k_resting_stride = 0.05;          // leaves: the shortest stride
constexpr double k_shorter = 0.4, k_longer = 1.5;  // a stride after a step back, and after one onwards

/// Furthest that a sample at unit distance from the tip moves when the rotation changes from `a` to `b` (Frobenius norm, an upper bound).
double turn_bound_rad(const Mat3& a, const Mat3& b) noexcept {
  const Vec3 x = a.row_x - b.row_x, y = a.row_y - b.row_y, z = a.row_z - b.row_z;
  return std::sqrt(dot(x, x) + dot(y, y) + dot(z, z));
}

double travel_mm(const ContactState& state, double lever_mm) noexcept { return state.moved_mm + state.turned_rad * lever_mm; }

/// Free way around the whole tool, in mm of travel; 0 when something is near.
double tool_air_mm(const Octree& tooth, const ContactTool& tool, const Mat3& rotation, Vec3 tip) noexcept {
  const double half = 0.5 * tool.reach_mm;
  const Vec3 middle = tip + rotation * Vec3{0, 0, half};
  for (const double margin : {4.0, 1.0}) {
    const double r = half + 1.0 + margin;
    if (tooth.is_air(middle - Vec3{r, r, r}, middle + Vec3{r, r, r})) return margin;
  }
  return 0;
}

/// Forgets every clearance: another point was mounted, or the first tick.
void reset(ContactState& state, const ContactTool& tool, int point) noexcept {
  state.point = point;
  state.tool_air_until_mm = state.tool_near_until_mm = -1.0;
  std::fill_n(state.patch_clear_until_mm.begin(), tool.patches.size(), -1.0);
  std::fill_n(state.patch_near_until_mm.begin(), tool.patches.size(), -1.0);
  std::fill_n(state.sample_clear_until_mm.begin(), tool.samples.size(), -1.0);
  state.gathered.turned_rad = -1.0;
  state.catching_up = false;
  state.opened = {};
}

/// So far from where they were gathered half spaces stand in for the surface.
double linear_mm(double leaf_mm) noexcept { return std::max(k_linear_leaves * leaf_mm, k_linear_mm); }

/// Room before a surface at `distance_mm`, as half spaces state it.
double slack_mm(double distance_mm, double leaf_mm) noexcept {
  if (distance_mm >= 0.0) return distance_mm;
  return std::max(std::min(distance_mm + k_dead_leaves * leaf_mm, 0.0), -k_deepest_leaves * leaf_mm);
}

/// Begins to gather half spaces about a place, for steps of `reach_mm` and small moves.
void begin_gathering(const Octree& tooth, Vec3 at_mm, double reach_mm, const ContactState& state, GatheredContact& g) noexcept {
  constexpr double k_gather_leaves = 1.1;  // what touches where the surface will recede to is wanted, too
  const double leaf = tooth.leaf_mm();
  g.at_mm = at_mm;
  g.turned_rad = state.turned_rad;
  g.edit = tooth.edit_hash();
  g.reach_mm = std::max(reach_mm, k_gather_leaves * leaf) + linear_mm(leaf);
  g.half_spaces.clear();
  g.samples.clear();
  g.next_patch = g.next_sample = 0;
}

/// Goes on to collect a half space for each sample that a step could bring into contact; true when all have been asked, false after `most` places.
bool go_on_gathering(const Octree& tooth, const ContactTool& tool, int most, ContactState& state, GatheredContact& g) noexcept {
  const double leaf = tooth.leaf_mm(), off_mm = length(g.at_mm - state.proxy_mm);
  const int last_looked_up = state.looked_up + most;
  for (; g.next_patch < tool.patches.size(); ++g.next_patch) {
    const auto& patch = tool.patches[g.next_patch];
    const double travel = travel_mm(state, patch.lever_mm), far_mm = travel + g.reach_mm + off_mm;
    if (far_mm <= state.patch_clear_until_mm[g.next_patch]) continue;
    if (travel + off_mm > state.patch_near_until_mm[g.next_patch]) {
      constexpr double k_margin_mm = 0.5;
      const double r = patch.radius_mm + k_margin_mm;
      const Vec3 middle = g.at_mm + state.rotation * patch.centre_mm;
      if (tooth.is_clear(middle - Vec3{r, r, r}, middle + Vec3{r, r, r})) {
        state.patch_clear_until_mm[g.next_patch] = travel + k_margin_mm - off_mm;
        continue;
      }
      state.patch_near_until_mm[g.next_patch] = travel + k_stays_near_mm;
    }
    for (std::uint32_t i = std::max(g.next_sample, patch.first); i < patch.last; ++i) {
      if (far_mm <= state.sample_clear_until_mm[i]) continue;
      if (state.looked_up >= last_looked_up) {
        g.next_sample = i;
        return false;
      }
      const auto s = tooth.sample(g.at_mm + state.rotation * tool.samples[i].at_mm, state.cursor);
      ++state.looked_up;
      state.sample_clear_until_mm[i] = travel + s.distance_mm - off_mm;
      if (s.distance_mm > g.reach_mm) continue;
      if (dot(s.gradient, s.gradient) < 1e-3) continue;  // no direction out: neighbours speak
      g.half_spaces.push_back({s.gradient, slack_mm(s.distance_mm, leaf)});
      g.samples.push_back(i);
    }
  }
  return true;
}

/// Makes sure that the half spaces in force are good for a step of `reach_mm` from where the proxy is.
void gather(const Octree& tooth, const ContactTool& tool, double reach_mm, ContactState& state) noexcept {
  GatheredContact& g = state.gathered;
  const double moved_mm = length(state.proxy_mm - g.at_mm);
  if (g.turned_rad == state.turned_rad && (g.edit == tooth.edit_hash() || state.catching_up) && moved_mm <= linear_mm(tooth.leaf_mm()) &&
      g.reach_mm >= reach_mm + moved_mm)
    return;
  begin_gathering(tooth, state.proxy_mm, reach_mm, state, g);
  (void)go_on_gathering(tooth, tool, k_all_places, state, g);
  state.active = {};
  state.catching_up = false;
}

/// How far the opened place lies ahead of the proxy, mm; 0 when the proxy cannot simply take it: it has gone elsewhere, or the device is not that
/// far.
double opened_way_mm(const OpenedPlace& opened, Vec3 device_mm, double leaf_mm, const ContactState& state) noexcept {
  if (opened.turned_rad != state.turned_rad) return 0.0;
  const Vec3 way = opened.tip_mm - state.proxy_mm;
  const double ahead_mm = -dot(way, state.normal);
  const bool beyond = ahead_mm <= 0.0 || ahead_mm > dot(state.proxy_mm - device_mm, state.normal);
  return beyond || length(way + state.normal * ahead_mm) > k_aside_leaves * leaf_mm ? 0.0 : ahead_mm;
}

/// After a carve: gathers anew a part in each tick, and then follows.
void catch_up(const Octree& tooth, const ContactTool& tool, Vec3 device_mm, double reach_mm, ContactState& state) noexcept {
  if (!state.touching || state.gathered.edit == tooth.edit_hash() || state.gathered.turned_rad != state.turned_rad) {
    state.catching_up = false;
    return;
  }
  GatheredContact& coming = state.coming;
  const double leaf = tooth.leaf_mm();
  if (!state.catching_up) {
    begin_gathering(tooth, opened_way_mm(state.opened, device_mm, leaf, state) > 0.0 ? state.opened.tip_mm : state.proxy_mm, reach_mm, state, coming);
    state.catching_up = true;
  }
  if (!go_on_gathering(tooth, tool, k_part_looked_up, state, coming)) return;
  state.catching_up = false;
  std::swap(state.gathered, state.coming);
  state.active = {};
  const double way_mm = opened_way_mm(state.opened, device_mm, leaf, state);
  // The head has room there; neck and shank may not.
  const auto& there = state.gathered.half_spaces;
  const bool room = std::all_of(there.begin(), there.end(), [&](const HalfSpace& h) { return h.slack_mm >= -k_room_leaves * leaf; });
  if (way_mm > 0.0 && room && state.gathered.at_mm == state.opened.tip_mm) {
    state.moved_mm += length(state.opened.tip_mm - state.proxy_mm);
    state.proxy_mm = state.opened.tip_mm;
  }
  state.opened = {};
}

/// The step from `gathered.at_mm` nearest to the wanted one. Samples alone would let the head sink in between them: where it
/// rests, the head's own furthest place against the surface is asked too, and becomes a half space if it enters the tissue.
HalfSpaceSolution solve(const Octree& tooth, const ContactTool& tool, Vec3 wanted, double stride_mm, ContactState& state) noexcept {
  auto solution = nearest_step(wanted, state.gathered.half_spaces, state.active);
  const double leaf = tooth.leaf_mm();
  const Vec3 since = state.proxy_mm - state.gathered.at_mm;
  for (int round = 0; round < k_refinements && solution.feasible && solution.active.count > 0; ++round) {
    const Vec3 way = solution.step - since;
    const double way_mm = length(way);
    const Vec3 there = way_mm > stride_mm ? since + way * (stride_mm / way_mm) : solution.step;
    bool refined = false;
    for (int i = 0; i < solution.active.count; ++i) {
      const Vec3 normal = normalized(state.gathered.half_spaces[static_cast<std::size_t>(solution.active.at[i])].normal);
      const Vec3 furthest = tool.furthest_along(state.rotation.transposed(-normal));
      const auto s = tooth.sample(state.gathered.at_mm + there + state.rotation * furthest, state.cursor);
      if (s.distance_mm >= -k_dead_leaves * leaf || dot(s.gradient, s.gradient) < 1e-3) continue;
      if (state.gathered.half_spaces.size() >= state.gathered.samples.size() + k_refined_room) {  // begin anew; the active ones go with them
        state.gathered.half_spaces.resize(state.gathered.samples.size());
        solution.active.count = 0;
      }
      state.gathered.half_spaces.push_back({s.gradient, slack_mm(s.distance_mm, leaf) - dot(s.gradient, there)});
      refined = true;
    }
    if (!refined) break;
    solution = nearest_step(wanted, state.gathered.half_spaces, solution.active);
  }
  state.active = solution.active;
  return solution;
}

/// Means of k, c and 1/τ over the solid (or the void) tissues of a mix, and their share in it.
inline double mean_of(const Octree& tooth, const TissueMix& mix, const TissueConstants* tissue, bool solid, TissueConstants& mean) noexcept {
  double share = 0.0;
  mean = {};
  if (mix.count == 1) {
    const std::uint8_t label = mix.label[0];
    if (label == k_air || tooth.is_solid(label) != solid) return 0.0;
    mean = tissue[label];
    return 1.0;
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(mix.count); ++i) {
    const std::uint8_t label = mix.label[i];
    if (label == k_air || tooth.is_solid(label) != solid) continue;
    share += mix.share[i];
    mean.stiffness_n_per_mm += mix.share[i] * tissue[label].stiffness_n_per_mm;
    mean.damping_n_s_per_mm += mix.share[i] * tissue[label].damping_n_s_per_mm;
    mean.recession_per_s += mix.share[i] * tissue[label].recession_per_s;
  }
  if (share > 0.0) {
    mean.stiffness_n_per_mm /= share;
    mean.damping_n_s_per_mm /= share;
    mean.recession_per_s /= share;
  }
  return share;
}

}  // namespace

ContactState make_contact_state(const std::vector<ContactTool>& tray, Vec3 first_tip_mm) {
  ContactState state;
  state.proxy_mm = first_tip_mm;
  std::size_t samples = 0, patches = 0;
  for (const auto& t : tray) {
    samples = std::max(samples, t.samples.size());
    patches = std::max(patches, t.patches.size());
  }
  state.sample_clear_until_mm.assign(samples, -1.0);
  state.patch_clear_until_mm.assign(patches, -1.0);
  state.patch_near_until_mm.assign(patches, -1.0);
  state.counted.assign(samples, 0);
  for (GatheredContact* g : {&state.gathered, &state.coming}) {
    g->samples.reserve(samples);
    g->half_spaces.reserve(samples + k_refined_room);
  }
  return state;
}

ContactResult update_contact(const Octree& tooth, const ContactTool& tool, int point, const Pose& device, ContactState& state) noexcept {
  const Vec3 before = state.proxy_mm;
  state.looked_up = 0;
  const Mat3 turned = rotation(device.rotation);
  state.turned_rad += turn_bound_rad(state.rotation, turned);
  state.rotation = turned;
  if (state.point != point) reset(state, tool, point);

  ContactResult result;
  const double leaf = tooth.leaf_mm();
  const Vec3 way = device.tip_mm - state.proxy_mm;
  const double way_mm = length(way), travel = travel_mm(state, tool.reach_mm);
  if (state.tool_air_until_mm <= travel + way_mm && state.tool_near_until_mm <= travel) {
    const double air_mm = tool_air_mm(tooth, tool, turned, state.proxy_mm);
    state.tool_air_until_mm = travel + air_mm;
    if (air_mm == 0.0) state.tool_near_until_mm = travel + k_stays_near_mm;
  }
  bool blocked = false;
  if (travel + way_mm < state.tool_air_until_mm) {
    state.proxy_mm = device.tip_mm;
    state.moved_mm += way_mm;
    result.in_air = true;
  } else {
    // A tool at rest in its hole needs to look around only a little; one on its way takes whole leaves. Where the surface turns under a step
    // the next one leads back: less far, or the proxy would go forth and back for ever.
    const double least_stride = k_resting_stride * leaf;
    double& stride = state.stride_mm;
    if (!state.touching) stride = leaf;
    bool strode = false;
    int times_back = 0;
    catch_up(tooth, tool, device.tip_mm, std::min(way_mm, stride) + 0.02 * leaf, state);
    for (int i = 0; i < k_max_steps; ++i) {
      const Vec3 rest = device.tip_mm - state.proxy_mm;
      const double rest_mm = length(rest);
      gather(tooth, tool, std::min(rest_mm, stride) + 0.02 * leaf, state);
      // The whole way is projected, and what is left of it shortened: a deep push must not hold back a slide.
      // The half spaces stand about the place where they were gathered: so do the steps.
      const Vec3 since = state.proxy_mm - state.gathered.at_mm;
      auto solution = solve(tooth, tool, since + rest, stride, state);
      if (!solution.feasible) {  // squeezed between walls: do not enter them further, whatever the depth so far
        for (auto& h : state.gathered.half_spaces) h.slack_mm = std::max(h.slack_mm, k_squeeze_leaves * leaf);
        state.gathered.turned_rad = -1.0;
        solution = nearest_step(since + rest, state.gathered.half_spaces);
      }
      solution.step -= since;
      Vec3 stepped = solution.feasible ? solution.step : Vec3{};
      double stepped_mm = length(stepped);
      const bool long_step = stepped_mm > 0.5 * stride, back = long_step && state.touching && dot(stepped, state.last_step_mm) < 0.0;
      times_back += back;
      if (back) stride = std::max(k_shorter * stride, least_stride);
      if (stepped_mm > stride) {
        stepped = stepped * (stride / stepped_mm);
        stepped_mm = stride;
      }
      const Vec3 held = solution.step - rest;
      blocked = !solution.feasible || dot(held, held) > k_settled_mm * k_settled_mm;
      if (stepped_mm <= k_settled_mm) break;  // settled: standing still keeps what was gathered
      state.proxy_mm += stepped;
      state.moved_mm += stepped_mm;
      if (!blocked && rest_mm <= stride) break;
      state.last_step_mm = stepped;
      strode |= long_step;
      if (long_step && !back) stride = std::min(k_longer * stride, leaf);
      result.on_its_way = i + 1 == k_max_steps || state.looked_up > (times_back > 1 ? k_most_going_back : k_most_looked_up);
      if (result.on_its_way) break;
    }
    if (!strode) {  // at rest
      stride = std::max(k_shorter * stride, least_stride);
      state.last_step_mm = {};
    }
  }

  result.moved_mm = state.proxy_mm - before;
  const Vec3 out = state.proxy_mm - device.tip_mm;
  result.penetration_mm = length(out);
  result.touching = blocked && result.penetration_mm > k_settled_mm;
  result.on_its_way &= result.touching;
  if (result.touching)
    state.normal = out / result.penetration_mm;
  else
    result.penetration_mm = 0;
  result.normal = state.normal;
  state.touching = result.touching;
  return result;
}

TouchedMeans touched_means(const Octree& tooth, const ContactTool& tool, const VoidMap& voids, const TissueConstants* tissue, double recession_mm,
                           ContactState& state) noexcept {
  const double leaf = tooth.leaf_mm();
  const Vec3 tip = state.proxy_mm - state.normal * recession_mm;
  const Vec3 swung = state.normal - state.means_normal;
  const Vec3 moved = tip - state.means_tip_mm;
  const double same_mm = std::max(k_same_means_leaves * leaf, k_same_means_mm);
  if (state.means_turned_rad == state.turned_rad && dot(swung, swung) < k_same_normal2) {
    const double moved2 = dot(moved, moved), late_mm = std::max(k_late_means_leaves * leaf, k_late_means_mm);
    if (state.means_edit == state.gathered.edit && moved2 < same_mm * same_mm) return state.means;
    // After a carve all is gathered anew, which is enough work for a tick. The tip, as the surface will have receded, stands where it
    // stood: what it touches may be looked up in the next tick, or, in one tissue, when that is done.
    const bool waits = state.catching_up && state.means_even;
    if ((waits || (state.looked_up > 0 && !state.means_late)) && moved2 < late_mm * late_mm) {
      state.means_late = !waits;
      return state.means;
    }
  }
  state.means_late = false;
  state.means_turned_rad = state.turned_rad;
  state.means_tip_mm = tip;
  state.means_edit = state.gathered.edit;
  state.means_normal = state.normal;
  TouchedMeans& means = state.means;
  means = {};
  state.looked_up += static_cast<int>(state.gathered.samples.size());
  const double touch_mm = k_touch_leaves * leaf, fade_mm = k_fade_leaves * leaf;
  const Vec3 ahead = state.normal * (-k_ahead_leaves * leaf), close = state.normal * (-0.1 * leaf), since = tip - state.gathered.at_mm;
  const std::uint32_t head_end = tool.patches[tool.head_patches - 1].last;
  double cut_area = 0.0, solid_area = 0.0, void_area = 0.0, least_n_per_mm = 1e9, most_n_per_mm = 0.0;
  TissueConstants solid_mean, void_mean;
  const auto count_void = [&](double area) {
    if (area <= 0.0) return;
    void_area += area;
    means.void_tissue = true;
    means.of.stiffness_n_per_mm += area * void_mean.stiffness_n_per_mm;
    means.of.damping_n_s_per_mm += area * void_mean.damping_n_s_per_mm;
  };
  // Adds a place of the tool's surface that sees `area` along the normal, `gap_mm` before the solid surface.
  const auto count = [&](Vec3 at, double area, double gap_mm, bool head, bool void_near) {
    double touch = std::clamp(1.0 - (gap_mm - touch_mm) / fade_mm, 0.0, 1.0);
    if (touch <= 0.0 && !(head && void_near)) return;
    const TissueMix mix = tooth.mix(at + ahead, state.cursor);
    double solid_share = mean_of(tooth, mix, tissue, true, solid_mean);
    const double void_share = mean_of(tooth, mix, tissue, false, void_mean);
    if (touch > 0.0 && solid_share <= 0.0 && mean_of(tooth, tooth.mix(at + close, state.cursor), tissue, true, solid_mean) <= 0.0) touch = 0.0;
    if (touch > 0.0) {
      const double touched = area * touch;
      least_n_per_mm = std::min(least_n_per_mm, solid_mean.stiffness_n_per_mm);
      most_n_per_mm = std::max(most_n_per_mm, solid_mean.stiffness_n_per_mm);
      cut_area += touched;
      if (head) means.of.recession_per_s += touched * solid_mean.recession_per_s;
      // a sheet over air holds the tool whole; one over void tissue only as far as there is solid tissue ahead
      solid_share = void_share > 0.0 ? solid_share / (solid_share + void_share) : 1.0;
      solid_area += touched * solid_share;
      means.of.stiffness_n_per_mm += touched * solid_share * solid_mean.stiffness_n_per_mm;
      means.of.damping_n_s_per_mm += touched * solid_share * solid_mean.damping_n_s_per_mm;
      if (head) count_void(touched * (1.0 - solid_share));
    }
    if (head) count_void(area * (1.0 - touch) * void_share);
  };
  const auto void_near = [&](const ToolPatch& patch) {
    return voids.clear_mm(tip + state.rotation * patch.centre_mm) <= patch.radius_mm + 3.0 * leaf;
  };
  std::fill_n(state.counted.begin(), head_end, std::uint8_t{0});
  std::size_t patch = 0;
  bool near = void_near(tool.patches[patch]);
  for (std::size_t n = 0; n < state.gathered.samples.size(); ++n) {
    const std::uint32_t i = state.gathered.samples[n];
    while (i >= tool.patches[patch].last) near = void_near(tool.patches[++patch]);  // samples stand in the order of their patches
    const auto& s = tool.samples[i];
    const bool head = i < head_end;
    if (head) state.counted[i] = 1;
    const double seen = -dot(state.rotation * s.normal, state.normal);
    const auto& h = state.gathered.half_spaces[n];
    if (seen > 0.0) count(tip + state.rotation * s.at_mm, s.area_mm2 * seen, h.slack_mm + dot(h.normal, since), head, near);
  }
  if (state.touching) {  // a fine tip may touch between its samples: the furthest place counts a little, and alone if need be
    constexpr double k_furthest_mm2 = 1e-3;
    const Vec3 furthest = tip + state.rotation * tool.furthest_along(state.rotation.transposed(-state.normal));
    count(furthest, k_furthest_mm2, tooth.sample(furthest, state.cursor).distance_mm, true, true);
  }
  for (std::size_t p = 0; p < tool.head_patches; ++p) {
    if (!void_near(tool.patches[p])) continue;
    for (std::uint32_t i = tool.patches[p].first; i < tool.patches[p].last; ++i) {
      if (state.counted[i] != 0) continue;
      const auto& s = tool.samples[i];
      const double seen = -dot(state.rotation * s.normal, state.normal);
      if (seen <= 0.0) continue;
      const Vec3 at = tip + state.rotation * s.at_mm + ahead;
      if (tooth.tissue_at(at, state.cursor) != k_air)
        count_void(s.area_mm2 * seen * mean_of(tooth, tooth.mix(at, state.cursor), tissue, false, void_mean));
    }
  }
  state.means_even = !means.void_tissue && least_n_per_mm > 0.999 * most_n_per_mm;
  means.touching = cut_area > 1e-9;
  if (!means.touching) {
    means.of = {};
    return means;
  }
  const double area = solid_area + void_area;
  means.of.stiffness_n_per_mm /= area;
  means.of.damping_n_s_per_mm /= area;
  means.of.recession_per_s /= cut_area;
  return means;
}

}  // namespace cavum
