// The zones of a scenario laid into one tooth, leaf by leaf, with the signed distance to the
// target's surface and the wall that each leaf belongs to. Everything that is counted or measured
// uses it.
//
// Rules. A leaf belongs to the target when its centre lies inside the target's shape. Any other
// leaf belongs to the *bottom* when the line from the nearest point of the target's surface to the
// leaf runs within 45° of straight down (of straight in, where the cavity is looked at from a side:
// facing.h), otherwise to the *sides*; within the leeway's width there it is leeway, within the
// container's container, beyond it none. What is protected is so wherever it lies in the tooth,
// also beyond the container and where the other zones' shapes reach: it is taken out of the target.
// Only leaves that hold tissue have a zone.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "engine/tooth/tooth.h"
#include "scenarios/file/facing.h"
#include "scenarios/file/scenario.h"

namespace cavum::scenarios {

enum class Zone : std::uint8_t {
  none,
  target,
  leeway_sides,
  leeway_bottom,
  container_sides,
  container_bottom,
  protected_
};
inline constexpr std::size_t k_zones = 7;
[[nodiscard]] const char* zone_name(Zone zone) noexcept;

/// Wall that a surface facing out of the target along `direction` belongs to; of a cavity looked at
/// from a side, the direction as Facing::local has it.
[[nodiscard]] Wall wall_of(Vec3 direction) noexcept;

/// How far a distance to the target's surface may be from the true one, in leaves (shape given
/// exactly): half a leaf off faces, measured at up to 0.54 some leaves off the tilted edge of a
/// box, where leaf centres near the edge are sparse.
inline constexpr double k_distance_bound_leaves = 0.6;

/// From a leaf to those that share a face with it.
inline constexpr IVec3 k_six_neighbours[] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                             {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};

class ZoneMap {
 public:
  [[nodiscard]] double leaf_mm() const noexcept { return leaf_mm_; }
  [[nodiscard]] double leaf_volume_mm3() const noexcept { return leaf_mm_ * leaf_mm_ * leaf_mm_; }
  /// First leaf and number of leaves of the stored box (octree leaf coordinates).
  [[nodiscard]] IVec3 low() const noexcept { return low_; }
  [[nodiscard]] IVec3 size() const noexcept { return size_; }
  [[nodiscard]] Vec3 centre_mm(IVec3 leaf) const noexcept {
    return origin_mm_ + Vec3{leaf.x + 0.5, leaf.y + 0.5, leaf.z + 0.5} * leaf_mm_;
  }
  [[nodiscard]] bool in_box(IVec3 leaf) const noexcept { return lies_in(leaf - low_, size_); }
  /// Zone of a leaf of the tooth; none where the tooth has no tissue. Outside the box: protected or
  /// none.
  [[nodiscard]] Zone zone(IVec3 leaf) const noexcept {
    if (in_box(leaf)) return static_cast<Zone>(zone_[index(leaf)]);
    return guarded_beyond(leaf) ? Zone::protected_ : Zone::none;
  }
  /// Signed distance of a leaf's centre to the target's surface, mm, negative inside.
  [[nodiscard]] double distance_mm(IVec3 leaf) const noexcept {
    return in_box(leaf) ? static_cast<double>(distance_mm_[index(leaf)])
                        : distance_mm(centre_mm(leaf));
  }
  /// The same between leaves (trilinear); beyond the box, the border's value and the way there.
  [[nodiscard]] double distance_mm(Vec3 p) const noexcept;
  [[nodiscard]] Wall wall(IVec3 leaf) const noexcept;
  /// Leaves (with tissue) of each zone; of the whole tooth but for none, which is that of the box.
  [[nodiscard]] const std::array<std::uint64_t, k_zones>& counts() const noexcept {
    return counts_;
  }
  [[nodiscard]] std::uint64_t count(Zone z) const noexcept {
    return counts_[static_cast<std::size_t>(z)];
  }
  /// Some leaf of the target lies beside air: there is a way to it. A buried one can only be come
  /// to through what lies around.
  [[nodiscard]] bool target_is_open() const noexcept { return target_is_open_; }
  /// Leaves of the target's shapes that were taken out of it because they are protected.
  [[nodiscard]] std::uint64_t guarded_in_target() const noexcept { return guarded_in_target_; }
  /// Part of a leaf that lies in the target as grading counts it (4x4x4 parts), in units of 1 /
  /// k_share_units; 0 without tissue.
  [[nodiscard]] std::uint32_t target_share(IVec3 leaf) const noexcept {
    return in_box(leaf) ? target_share_[index(leaf)] : 0;
  }
  /// Of all leaves together, more than 0.
  [[nodiscard]] std::uint64_t target_shares() const noexcept { return target_shares_; }
  static constexpr std::uint32_t k_share_units = 1 << 15;
  [[nodiscard]] double target_mm3() const noexcept {
    return static_cast<double>(count(Zone::target)) * leaf_volume_mm3();
  }
  /// Target leaves with a neighbour that is not target: half of them bounds the error of the
  /// target's volume.
  [[nodiscard]] std::uint64_t target_border_leaves() const noexcept { return target_border_; }
  /// Corners of the box of all target leaves, mm.
  [[nodiscard]] Vec3 target_low_mm() const noexcept { return target_low_mm_; }
  [[nodiscard]] Vec3 target_high_mm() const noexcept { return target_high_mm_; }
  /// Mean height of the tooth's surface over the target: the level of the opening, along `facing`'s
  /// way out (z; from a side ±y).
  [[nodiscard]] double opening_z_mm() const noexcept { return opening_z_mm_; }
  /// How far below the opening a place of the tooth frame lies, mm.
  [[nodiscard]] double below_opening_mm(Vec3 p) const noexcept {
    return opening_z_mm_ - facing_.local(p).z;
  }
  /// Levels between which the target's leaves lie, along `facing`'s way out.
  [[nodiscard]] double floor_level_mm() const noexcept {
    return std::min(facing_.local(target_low_mm_).z, facing_.local(target_high_mm_).z);
  }
  [[nodiscard]] double top_level_mm() const noexcept {
    return std::max(facing_.local(target_low_mm_).z, facing_.local(target_high_mm_).z);
  }
  /// The way in, pointing out of the tooth, unit: the axis of the target's first body where the
  /// scenario turns it (an incisor is entered from its lingual side), within 60° of occlusal; from
  /// a side, square to the surface, where that body is a cavity in it; else +z.
  [[nodiscard]] Vec3 approach() const noexcept { return approach_; }
  /// From a side where the target's first body is a cavity in it, else from occlusal.
  [[nodiscard]] Facing facing() const noexcept { return facing_; }
  /// Calls `visit(leaf)` for every target leaf, z slowest.
  template <class Visit>
  void for_each_target_leaf(const Visit& visit) const {
    for_each_leaf([&](IVec3 leaf, Zone z) {
      if (z == Zone::target) visit(leaf);
    });
  }
  /// Calls `visit(leaf, zone)` for every leaf of the box.
  template <class Visit>
  void for_each_leaf(const Visit& visit) const {
    std::size_t i = 0;
    for (int z = 0; z < size_.z; ++z)
      for (int y = 0; y < size_.y; ++y)
        for (int x = 0; x < size_.x; ++x, ++i)
          visit(low_ + IVec3{x, y, z}, static_cast<Zone>(zone_[i]));
  }

 private:
  friend class ZoneBuilder;  // of build_zones
  [[nodiscard]] std::size_t index(IVec3 leaf) const noexcept {
    return cell_index(leaf - low_, size_);
  }
  [[nodiscard]] bool guarded_beyond(IVec3 l) const noexcept {
    if (guarded_.empty() || !lies_in(l, tooth_size_)) return false;
    return guarded_[tooth_index(l)];
  }
  [[nodiscard]] std::size_t tooth_index(IVec3 l) const noexcept {
    return cell_index(l, tooth_size_);
  }

  double leaf_mm_ = 0.05;
  Vec3 origin_mm_;  // of leaf (0,0,0) of the tooth
  IVec3 low_, size_, tooth_size_;
  std::vector<std::uint8_t> zone_, wall_;
  std::vector<bool> guarded_;  // protected leaves outside the box, of all leaves of the tooth;
                               // empty when nothing is protected
  std::uint64_t guarded_in_target_ = 0;
  bool target_is_open_ = false;
  std::vector<float> distance_mm_;
  std::vector<std::uint16_t> target_share_;
  std::uint64_t target_shares_ = 0;
  std::array<std::uint64_t, k_zones> counts_{};
  std::uint64_t target_border_ = 0;
  Vec3 target_low_mm_, target_high_mm_;
  double opening_z_mm_ = 0.0;
  Vec3 approach_{0, 0, 1};
  Facing facing_;
};

/// Lays the zones into a tooth (the whole one, before the exam). Throws Error when the target is
/// empty or the tooth lacks a tissue that a zone refers to, and beyond a limit of zone_work.h.
[[nodiscard]] ZoneMap build_zones(const Scenario& scenario, const Tooth& tooth);

}  // namespace cavum::scenarios
