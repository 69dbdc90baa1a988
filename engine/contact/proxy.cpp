#include "engine/contact/proxy.h"

#include <algorithm>
#include <cmath>

namespace cavum {
namespace {

constexpr int k_max_steps = 12;          // of one leaf: the proxy follows 0.6 mm a tick at a 0.05 mm leaf
constexpr double k_same_normal2 = 1e-4;  // 0.01 rad: the areas seen along the normal have hardly changed
constexpr double k_linear_leaves = 0.1;  // so far a half space stands in for the curved surface
constexpr double k_squeeze_leaves = 0.005;
constexpr double k_settled_mm = 2e-5;     // a smaller step ends the search
constexpr double k_resting_stride = 0.1;  // leaves: first stride of a tool that was already in contact

/// Furthest that any sample moves when the rotation changes from `a` to `b` (Frobenius norm, an upper bound).
double turn_bound_mm(const Mat3& a, const Mat3& b, double reach_mm) noexcept {
  const Vec3 x = a.row_x - b.row_x, y = a.row_y - b.row_y, z = a.row_z - b.row_z;
  return std::sqrt(dot(x, x) + dot(y, y) + dot(z, z)) * reach_mm;
}

/// Box around a ball: is it free of solid tissue?
bool clear_around(const Octree& tooth, Vec3 centre, double radius) noexcept {
  const Vec3 r{radius, radius, radius};
  return tooth.is_clear(centre - r, centre + r);
}

/// Free way around the whole tool, in mm of travel; 0 when something is near.
double tool_clearance_mm(const Octree& tooth, const ContactTool& tool, const Mat3& rotation, Vec3 tip) noexcept {
  const double half = 0.5 * tool.reach_mm;
  const Vec3 middle = tip + rotation * Vec3{0, 0, half};
  for (const double margin : {4.0, 1.0})
    if (clear_around(tooth, middle, half + 1.0 + margin)) return margin;
  return 0;
}

/// Forgets every clearance: another point was mounted, or the first tick.
void reset(ContactState& state, const ContactTool& tool, int point) noexcept {
  state.point = point;
  state.tool_clear_until_mm = state.travel_mm;
  std::fill_n(state.patch_clear_until_mm.begin(), tool.patches.size(), state.travel_mm);
  std::fill_n(state.patch_near_until_mm.begin(), tool.patches.size(), -1.0);
  state.gathered_turned_mm = -1;
  std::fill_n(state.sample_clear_until_mm.begin(), tool.samples.size(), state.travel_mm);
}

/// Collects a half space for each sample that a step of `reach_mm` could bring into contact.
void gather(const Octree& tooth, const ContactTool& tool, double reach_mm, ContactState& state) noexcept {
  const Vec3 moved = state.proxy_mm - state.gathered_mm;
  const double moved_mm = length(moved);
  if (state.gathered_turned_mm == state.turned_mm && state.gathered_edit == tooth.edit_hash() && moved_mm <= k_linear_leaves * tooth.leaf_mm() &&
      state.gathered_reach_mm >= reach_mm + moved_mm)
    return;
  reach_mm += k_linear_leaves * tooth.leaf_mm();
  state.gathered_mm = state.proxy_mm;
  state.gathered_turned_mm = state.turned_mm;
  state.gathered_edit = tooth.edit_hash();
  state.gathered_reach_mm = reach_mm;
  state.half_spaces.clear();
  const double leaf = tooth.leaf_mm();
  const double deepest = 0.5 * leaf;
  for (std::size_t p = 0; p < tool.patches.size(); ++p) {
    const auto& patch = tool.patches[p];
    if (state.travel_mm + reach_mm <= state.patch_clear_until_mm[p]) continue;
    if (state.travel_mm > state.patch_near_until_mm[p]) {
      constexpr double k_margin_mm = 0.5, k_stays_near_mm = 0.1;
      if (clear_around(tooth, state.proxy_mm + state.rotation * patch.centre_mm, patch.radius_mm + k_margin_mm)) {
        state.patch_clear_until_mm[p] = state.travel_mm + k_margin_mm;
        continue;
      }
      state.patch_near_until_mm[p] = state.travel_mm + k_stays_near_mm;
    }
    for (std::size_t i = patch.first; i < patch.last; ++i) {
      if (state.travel_mm + reach_mm <= state.sample_clear_until_mm[i]) continue;
      const auto s = tooth.sample(state.proxy_mm + state.rotation * tool.samples[i].at_mm, state.cursor);
      state.sample_clear_until_mm[i] = state.travel_mm + s.distance_mm;
      if (s.distance_mm > reach_mm) continue;
      if (dot(s.gradient, s.gradient) < 1e-3) continue;  // no direction out: neighbours speak
      state.half_spaces.push_back({s.gradient, std::max(s.distance_mm, -deepest)});
    }
  }
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
  state.sample_clear_until_mm.assign(samples, 0.0);
  state.patch_clear_until_mm.assign(patches, 0.0);
  state.patch_near_until_mm.assign(patches, -1.0);
  state.half_spaces.reserve(samples);
  return state;
}

ContactResult update_contact(const Octree& tooth, const ContactTool& tool, int point, const Pose& device, ContactState& state) noexcept {
  const Vec3 before = state.proxy_mm;
  const Mat3 turned = rotation(device.rotation);
  const double turn_mm = turn_bound_mm(state.rotation, turned, tool.reach_mm);
  state.travel_mm += turn_mm;
  state.turned_mm += turn_mm;
  state.rotation = turned;
  if (state.point != point) reset(state, tool, point);

  const double leaf = tooth.leaf_mm();
  const Vec3 way = device.tip_mm - state.proxy_mm;
  const double way_mm = length(way);
  if (state.tool_clear_until_mm <= state.travel_mm + way_mm)
    state.tool_clear_until_mm = state.travel_mm + tool_clearance_mm(tooth, tool, turned, state.proxy_mm);
  bool blocked = false;
  if (state.travel_mm + way_mm < state.tool_clear_until_mm) {
    state.proxy_mm = device.tip_mm;
    state.travel_mm += way_mm;
  } else {
    // A tool at rest in its hole needs to look around only a little; one on its way takes whole leaves.
    double stride = state.touching ? k_resting_stride * leaf : leaf;
    for (int i = 0; i < k_max_steps; ++i) {
      const Vec3 rest = device.tip_mm - state.proxy_mm;
      const double rest_mm = length(rest);
      gather(tooth, tool, std::min(rest_mm, stride) + 0.02 * leaf, state);
      // the whole way is projected, and what is left of it shortened: a deep push must not hold back a slide
      const Vec3 wanted = rest;
      // the half spaces stand about the place where they were gathered: so do the steps
      const Vec3 since = state.proxy_mm - state.gathered_mm;
      auto solution = nearest_step(since + wanted, state.half_spaces);
      if (!solution.feasible) {  // squeezed between walls: do not enter them further, whatever the depth so far
        for (auto& h : state.half_spaces) h.slack_mm = std::max(h.slack_mm, k_squeeze_leaves * leaf);
        state.gathered_turned_mm = -1;
        solution = nearest_step(since + wanted, state.half_spaces);
      }
      solution.step -= since;
      Vec3 stepped = solution.feasible ? solution.step : Vec3{};
      double stepped_mm = length(stepped);
      if (stepped_mm > stride) {
        stepped = stepped * (stride / stepped_mm);
        stepped_mm = stride;
      }
      const Vec3 held = solution.step - wanted;
      blocked = !solution.feasible || dot(held, held) > k_settled_mm * k_settled_mm;
      if (stepped_mm <= k_settled_mm) break;  // settled: standing still keeps what was gathered
      state.proxy_mm += stepped;
      state.travel_mm += stepped_mm;
      if (!blocked && rest_mm <= stride) break;
      if (stepped_mm > 0.5 * stride) stride = leaf;
    }
  }

  ContactResult result;
  result.moved_mm = state.proxy_mm - before;
  const Vec3 out = state.proxy_mm - device.tip_mm;
  result.penetration_mm = length(out);
  result.touching = blocked && result.penetration_mm > k_settled_mm;
  if (result.touching)
    state.normal = out / result.penetration_mm;
  else
    result.penetration_mm = 0;
  result.normal = state.normal;
  state.touching = result.touching;
  return result;
}

TouchedMeans touched_means(const Octree& tooth, const ContactTool& tool, const TissueConstants* tissue, ContactState& state) noexcept {
  const Vec3 swung = state.normal - state.means_normal;
  const Vec3 moved = state.proxy_mm - state.means_proxy_mm;
  const double same_mm = 0.5 * k_linear_leaves * tooth.leaf_mm();
  if (state.means_turned_mm == state.turned_mm && state.means_edit == tooth.edit_hash() && dot(swung, swung) < k_same_normal2 &&
      dot(moved, moved) < same_mm * same_mm)
    return state.means;
  state.means_turned_mm = state.turned_mm;
  state.means_proxy_mm = state.proxy_mm;
  state.means_edit = tooth.edit_hash();
  state.means_normal = state.normal;
  TouchedMeans& means = state.means;
  means = {};
  const double leaf = tooth.leaf_mm();
  const double touch_mm = 0.5 * leaf, before_mm = 0.9 * leaf, reached_mm = 0.1 * leaf;
  double solid_area = 0, void_area = 0;
  for (std::size_t p = 0; p < tool.patches.size(); ++p) {
    const auto& patch = tool.patches[p];
    const bool near_solid = state.patch_clear_until_mm[p] <= state.travel_mm + touch_mm;
    if (!near_solid && p >= tool.head_patches) continue;
    for (std::size_t i = patch.first; i < patch.last; ++i) {
      const auto& s = tool.samples[i];
      const double seen = -dot(state.rotation * s.normal, state.normal);
      if (seen <= 0) continue;
      const Vec3 at = state.proxy_mm + state.rotation * s.at_mm;
      std::uint8_t label = tooth.tissue_at(at - state.normal * before_mm, state.cursor);
      if (label == k_air) continue;
      if (!tooth.is_solid(label)) {  // void tissue counts from where the surface reaches it, not from behind the last solid leaf
        const std::uint8_t nearer = tooth.tissue_at(at - state.normal * reached_mm, state.cursor);
        if (tooth.is_solid(nearer)) label = nearer;
      }
      double area = s.area_mm2 * seen;
      if (tooth.is_solid(label)) {
        const double gap = state.sample_clear_until_mm[i] - state.travel_mm;  // as the proxy's search left it
        area *= std::clamp(1.0 - gap / touch_mm, 0.0, 1.0);
        solid_area += area;
        if (p < tool.head_patches) means.of.recession_per_s += area * tissue[label].recession_per_s;
      } else {
        void_area += area;
        means.void_tissue = true;
      }
      means.of.stiffness_n_per_mm += area * tissue[label].stiffness_n_per_mm;
      means.of.damping_n_s_per_mm += area * tissue[label].damping_n_s_per_mm;
    }
  }
  const double area = solid_area + void_area;
  means.touching = solid_area > 1e-9;
  if (!means.touching) {
    means.of = {};
    return means;
  }
  means.of.stiffness_n_per_mm /= area;
  means.of.damping_n_s_per_mm /= area;
  means.of.recession_per_s /= solid_area;
  return means;
}

}  // namespace cavum
