#include "engine/physics/contact/touched_means.h"

#include <algorithm>
#include <cmath>

#include "engine/physics/contact/proxy.h"
#include "engine/physics/contact/tuning.h"

namespace cavum {

using namespace tuning;

namespace {

/// Means of k, c, 1/τ and 1/K over the solid (or the void) tissues of a mix, and their share in it.
double mean_of(const Octree& tooth, const TissueMix& mix, const TissueConstants* tissue, bool solid,
               TissueConstants& mean) noexcept {
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
    mean.resistance_n_per_mm2 += mix.share[i] * tissue[label].resistance_n_per_mm2;
  }
  if (share > 0.0) {
    mean.stiffness_n_per_mm /= share;
    mean.damping_n_s_per_mm /= share;
    mean.recession_per_s /= share;
    mean.resistance_n_per_mm2 /= share;
  }
  return share;
}

/// What was found the last time is good enough for this tick.
bool still_hold(double leaf_mm, Vec3 tip, const ContactState& state, const ContactScratch& scratch,
                TouchedMemory& last) noexcept {
  const Vec3 swung = state.normal - last.normal, moved = tip - last.tip_mm;
  if (last.turned_rad != state.turned_rad || dot(swung, swung) >= k_same_normal2) return false;
  const double moved2 = dot(moved, moved);
  const double same_mm = std::max(k_same_means_leaves * leaf_mm, k_same_means_mm),
               late_mm = std::max(k_late_means_leaves * leaf_mm, k_late_means_mm);
  if (last.edit == state.gathered.edit && moved2 < same_mm * same_mm) return true;
  // After a carve all is gathered anew, which is enough work for a tick. The tip, as the surface
  // will have receded, stands where it stood: what it touches may be looked up in the next tick,
  // or, in one tissue, when that is done.
  const bool waits = state.catching_up && last.even;
  if (!(waits || (scratch.looked_up > 0 && !last.late)) || moved2 >= late_mm * late_mm)
    return false;
  last.late = !waits;
  return true;
}

/// Sums over the places of a tool whose tip is, or will be, at `tip`.
class Touching {
 public:
  Touching(const Octree& tooth, const ContactTool& tool, const VoidMap& voids,
           const TissueConstants* tissue, Vec3 tip, const ContactState& state,
           ContactScratch& scratch)
      : tooth_(tooth),
        tool_(tool),
        voids_(voids),
        tissue_(tissue),
        tip_(tip),
        state_(state),
        scratch_(scratch),
        leaf_mm_(tooth.leaf_mm()),
        ahead_(state.normal * (-k_ahead_leaves * leaf_mm_)),
        close_(state.normal * (-k_close_leaves * leaf_mm_)),
        head_end_(tool.patches[tool.head_patches - 1].last) {}

  /// The samples near the tooth, by the half spaces that contact has gathered.
  void count_gathered() noexcept {
    const GatheredContact& gathered = state_.gathered;
    const Vec3 since = tip_ - gathered.at_mm;
    scratch_.looked_up += static_cast<int>(gathered.samples.size());
    std::fill_n(scratch_.counted.begin(), head_end_, std::uint8_t{0});
    std::size_t patch = 0;
    bool near = void_near(tool_.patches[patch]);
    for (std::size_t n = 0; n < gathered.samples.size(); ++n) {
      const std::uint32_t i = gathered.samples[n];
      while (i >= tool_.patches[patch].last)
        near = void_near(tool_.patches[++patch]);  // samples stand in the order of their patches
      const auto& s = tool_.samples[i];
      const bool head = i < head_end_;
      if (head) scratch_.counted[i] = 1;
      const double seen = -dot(state_.rotation * s.normal, state_.normal);
      const auto& h = gathered.half_spaces[n];
      if (seen > 0.0)
        count(s.at_mm, s.area_mm2 * seen, seen, h.slack_mm + dot(h.normal, since), head, near);
    }
  }

  /// A fine tip may touch between its samples: the furthest place counts a little, and alone if
  /// need be.
  void count_furthest() noexcept {
    const Vec3 at_tool = tool_.furthest_along(state_.rotation.transposed(-state_.normal)),
               furthest = tip_ + state_.rotation * at_tool;
    count(at_tool, k_furthest_mm2, 1.0, tooth_.sample(furthest, scratch_.cursor).distance_mm, true,
          true);
  }

  /// Samples of the head that are far from the surface, and have void tissue before them.
  void count_void_ahead() noexcept {
    for (std::size_t p = 0; p < tool_.head_patches; ++p) {
      if (!void_near(tool_.patches[p])) continue;
      for (std::uint32_t i = tool_.patches[p].first; i < tool_.patches[p].last; ++i) {
        if (scratch_.counted[i] != 0) continue;
        const auto& s = tool_.samples[i];
        const double seen = -dot(state_.rotation * s.normal, state_.normal);
        if (seen <= 0.0) continue;
        const Vec3 at = tip_ + state_.rotation * s.at_mm + ahead_;
        if (tooth_.tissue_at(at, scratch_.cursor) != k_air)
          count_void(s.area_mm2 * seen *
                     mean_of(tooth_, tooth_.mix(at, scratch_.cursor), tissue_, false, void_mean_));
      }
    }
  }

  /// All sums over their areas.
  [[nodiscard]] TouchedMeans means() noexcept {
    TouchedMeans m = sums_;
    m.touching = cut_area_ > k_min_area_mm2;
    if (!m.touching) {
      m.of = {};
      m.grinding = {};
      return m;
    }
    const double area = solid_area_ + void_area_;
    m.of.stiffness_n_per_mm /= area;
    m.of.damping_n_s_per_mm /= area;
    m.of.recession_per_s /= cut_area_;
    m.grinding.head_share = ground_area_ / cut_area_;
    return m;
  }
  [[nodiscard]] bool even() const noexcept {
    return !sums_.void_tissue && least_n_per_mm_ > k_even_share * most_n_per_mm_;
  }

 private:
  [[nodiscard]] bool void_near(const ToolPatch& patch) const noexcept {
    return voids_.clear_mm(tip_ + state_.rotation * patch.centre_mm) <=
           patch.radius_mm + k_void_near_leaves * leaf_mm_;
  }

  void count_void(double area) noexcept {
    if (area <= 0.0) return;
    void_area_ += area;
    sums_.void_tissue = true;
    sums_.of.stiffness_n_per_mm += area * void_mean_.stiffness_n_per_mm;
    sums_.of.damping_n_s_per_mm += area * void_mean_.damping_n_s_per_mm;
  }

  /// Adds the place `at_tool` (tool frame) of the tool's surface that sees `area` along the normal,
  /// `gap_mm` before the solid surface; `cosine` of the angle between its own normal and that.
  void count(Vec3 at_tool, double area, double cosine, double gap_mm, bool head,
             bool void_near) noexcept {
    const Vec3 at = tip_ + state_.rotation * at_tool;
    double touch = std::clamp(
        1.0 - (gap_mm - k_touch_leaves * leaf_mm_) / (k_fade_leaves * leaf_mm_), 0.0, 1.0);
    if (touch <= 0.0 && !(head && void_near)) return;
    const TissueMix mix = tooth_.mix(at + ahead_, scratch_.cursor);
    double solid_share = mean_of(tooth_, mix, tissue_, true, solid_mean_);
    const double void_share = mean_of(tooth_, mix, tissue_, false, void_mean_);
    if (touch > 0.0 && solid_share <= 0.0 &&
        mean_of(tooth_, tooth_.mix(at + close_, scratch_.cursor), tissue_, true, solid_mean_) <=
            0.0)
      touch = 0.0;
    if (touch > 0.0) {
      const double touched = area * touch;
      least_n_per_mm_ = std::min(least_n_per_mm_, solid_mean_.stiffness_n_per_mm);
      most_n_per_mm_ = std::max(most_n_per_mm_, solid_mean_.stiffness_n_per_mm);
      cut_area_ += touched;
      if (head) {
        sums_.of.recession_per_s += touched * solid_mean_.recession_per_s;
        if (solid_mean_.resistance_n_per_mm2 > 0.0) count_ground(at_tool, touched, cosine);
      }
      // a sheet over air holds the tool whole; one over void tissue only as far as there is solid
      // tissue ahead
      solid_share = void_share > 0.0 ? solid_share / (solid_share + void_share) : 1.0;
      solid_area_ += touched * solid_share;
      sums_.of.stiffness_n_per_mm += touched * solid_share * solid_mean_.stiffness_n_per_mm;
      sums_.of.damping_n_s_per_mm += touched * solid_share * solid_mean_.damping_n_s_per_mm;
      if (head) count_void(touched * (1.0 - solid_share));
    }
    if (head) count_void(area * (1.0 - touch) * void_share);
  }

  /// Preston's sums of a place of the head, in the tissue of `solid_mean_`.
  void count_ground(Vec3 at_tool, double touched, double cosine) noexcept {
    const double resisted = touched * solid_mean_.resistance_n_per_mm2;
    sums_.grinding.sliding_n += resisted;
    sums_.grinding.per_turn_n_per_mm +=
        resisted * cosine /
        std::max(k_min_radius_mm, std::sqrt(at_tool.x * at_tool.x + at_tool.y * at_tool.y));
    ground_area_ += touched;
  }

  const Octree& tooth_;
  const ContactTool& tool_;
  const VoidMap& voids_;
  const TissueConstants* tissue_;
  const Vec3 tip_;
  const ContactState& state_;
  ContactScratch& scratch_;
  const double leaf_mm_;
  const Vec3 ahead_, close_;
  const std::uint32_t head_end_;
  TouchedMeans sums_;
  TissueConstants solid_mean_, void_mean_;  // of the last place
  double cut_area_ = 0.0, ground_area_ = 0.0, solid_area_ = 0.0, void_area_ = 0.0,
         least_n_per_mm_ = 1e9, most_n_per_mm_ = 0.0;
};

}  // namespace

TouchedMeans touched_means(const Octree& tooth, const ContactTool& tool, const VoidMap& voids,
                           const TissueConstants* tissue, double recession_mm,
                           const ContactState& contact, TouchedMemory& state,
                           ContactScratch& scratch) noexcept {
  const Vec3 tip = contact.proxy_mm - contact.normal * recession_mm;
  if (still_hold(tooth.leaf_mm(), tip, contact, scratch, state)) return state.means;
  state.late = false;
  state.turned_rad = contact.turned_rad;
  state.tip_mm = tip;
  state.edit = contact.gathered.edit;
  state.normal = contact.normal;
  Touching touching(tooth, tool, voids, tissue, tip, contact, scratch);
  touching.count_gathered();
  if (contact.touching) touching.count_furthest();
  touching.count_void_ahead();
  state.even = touching.even();
  state.means = touching.means();
  return state.means;
}

}  // namespace cavum
