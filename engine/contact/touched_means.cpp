#include "engine/contact/touched_means.h"

#include <algorithm>

#include "engine/contact/proxy.h"

namespace cavum {
namespace {

constexpr double k_same_normal2 = 1e-4;  // 0.01 rad: the areas seen along the normal have hardly changed
constexpr double k_same_means_leaves = 0.02, k_same_means_mm = 0.001, k_late_means_leaves = 0.05, k_late_means_mm = 0.0025;
constexpr double k_touch_leaves = 0.2;  // a sample nearer than that touches fully; rounding of distances is far less
constexpr double k_fade_leaves = 0.5;   // and from there it touches less and less
constexpr double k_ahead_leaves = 1.6;  // so far before a sample its tissue is looked up: a last leaf over the pulp has faded out when it is cut

/// Means of k, c and 1/τ over the solid (or the void) tissues of a mix, and their share in it.
double mean_of(const Octree& tooth, const TissueMix& mix, const TissueConstants* tissue, bool solid, TissueConstants& mean) noexcept {
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

TouchedMeans touched_means(const Octree& tooth, const ContactTool& tool, const VoidMap& voids, const TissueConstants* tissue, double recession_mm,
                           ContactState& state) noexcept {
  const double leaf = tooth.leaf_mm();
  const Vec3 tip = state.proxy_mm - state.normal * recession_mm;
  const Vec3 swung = state.normal - state.touched.normal;
  const Vec3 moved = tip - state.touched.tip_mm;
  const double same_mm = std::max(k_same_means_leaves * leaf, k_same_means_mm);
  if (state.touched.turned_rad == state.turned_rad && dot(swung, swung) < k_same_normal2) {
    const double moved2 = dot(moved, moved), late_mm = std::max(k_late_means_leaves * leaf, k_late_means_mm);
    if (state.touched.edit == state.gathered.edit && moved2 < same_mm * same_mm) return state.touched.means;
    // After a carve all is gathered anew, which is enough work for a tick. The tip, as the surface will have receded, stands where it
    // stood: what it touches may be looked up in the next tick, or, in one tissue, when that is done.
    const bool waits = state.catching_up && state.touched.even;
    if ((waits || (state.looked_up > 0 && !state.touched.late)) && moved2 < late_mm * late_mm) {
      state.touched.late = !waits;
      return state.touched.means;
    }
  }
  state.touched.late = false;
  state.touched.turned_rad = state.turned_rad;
  state.touched.tip_mm = tip;
  state.touched.edit = state.gathered.edit;
  state.touched.normal = state.normal;
  TouchedMeans& means = state.touched.means;
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
  std::fill_n(state.touched.counted.begin(), head_end, std::uint8_t{0});
  std::size_t patch = 0;
  bool near = void_near(tool.patches[patch]);
  for (std::size_t n = 0; n < state.gathered.samples.size(); ++n) {
    const std::uint32_t i = state.gathered.samples[n];
    while (i >= tool.patches[patch].last) near = void_near(tool.patches[++patch]);  // samples stand in the order of their patches
    const auto& s = tool.samples[i];
    const bool head = i < head_end;
    if (head) state.touched.counted[i] = 1;
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
      if (state.touched.counted[i] != 0) continue;
      const auto& s = tool.samples[i];
      const double seen = -dot(state.rotation * s.normal, state.normal);
      if (seen <= 0.0) continue;
      const Vec3 at = tip + state.rotation * s.at_mm + ahead;
      if (tooth.tissue_at(at, state.cursor) != k_air)
        count_void(s.area_mm2 * seen * mean_of(tooth, tooth.mix(at, state.cursor), tissue, false, void_mean));
    }
  }
  state.touched.even = !means.void_tissue && least_n_per_mm > 0.999 * most_n_per_mm;
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
