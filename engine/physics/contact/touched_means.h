// Means of the tissues that the bur touches: what force, damping and cutting go by.
#pragma once

#include <cstdint>

#include "engine/base/state_hash.h"
#include "engine/physics/contact/contact_tool.h"
#include "engine/tooth/octree.h"
#include "engine/tooth/void_map.h"

namespace cavum {

struct ContactState;
struct ContactScratch;

/// Constants of one tissue as the contact averages them.
struct TissueConstants {
  double stiffness_n_per_mm = 0, damping_n_s_per_mm = 0;
  double recession_per_s = 0;       ///< 1/τ; 0 for void tissue, and where cutting goes by pressure
  double resistance_n_per_mm2 = 0;  ///< 1/K: pressure per mm ground off while the coating slides 1
                                    ///< mm; 0 where cutting goes by penetration
};
CAVUM_STATE(TissueConstants, stiffness_n_per_mm, damping_n_s_per_mm, recession_per_s,
            resistance_n_per_mm2)

/// What grinding by pressure needs of the area touched: sums over the coated head, zero where
/// cutting goes by penetration (engine/physics/servo/grinding.h). A: area of a place, w: how far it
/// touches, θ: between its normal and the contact normal, r: its distance from the tool's axis.
struct GrindingSums {
  double per_turn_n_per_mm =
      0;  ///< S = Σ A w cos²θ/(K r): force for each mm of recession in a radian of turning
  double sliding_n = 0;   ///< Q = Σ A w cosθ/K
  double head_share = 0;  ///< part of the area touched that is the coated head's; neck and shank
                          ///< bear the rest, and do not grind
};
CAVUM_STATE(GrindingSums, per_turn_n_per_mm, sliding_n, head_share)

/// Means over the area touched, weighted by the area seen along the contact normal.
struct TouchedMeans {
  TissueConstants of;     ///< recession over the solid part only, where the coated head touches it
  bool touching = false;  ///< false: nothing touched, `of` is zero
  bool void_tissue = false;  ///< pulp or another void tissue lies before the head
  GrindingSums grinding;
};
CAVUM_STATE(TouchedMeans, of, touching, void_tissue, grinding)

/// Means of an earlier tick, and what they were taken from: they hold as long as neither tool,
/// tooth nor normal changed much.
struct TouchedMemory {
  TouchedMeans means;
  double turned_rad = -1.0;
  std::uint64_t edit = 0;  ///< of the half spaces that they were taken from
  Vec3 tip_mm, normal;
  bool even = false;  ///< they are of one tissue
  bool late = false;  ///< they have waited for what was gathered in the tick before
};
CAVUM_STATE(TouchedMemory, means, turned_rad, edit, tip_mm, normal, even, late)

/// A sample touches solid tissue fully within 0.2 leaves of it and less and less up to 0.7; where
/// it does not, void tissue before it counts. Which tissue that is, is interpolated 1.6 leaves
/// ahead of where the surface will be once the `recession_mm` that is not yet carved is: so k and c
/// change continuously across every border and through every carve, and a border is felt 0.08 mm
/// early at a leaf of 0.05 mm. `tissue` has 256 entries.
[[nodiscard]] TouchedMeans touched_means(const Octree& tooth, const ContactTool& tool,
                                         const VoidMap& voids, const TissueConstants* tissue,
                                         double recession_mm, const ContactState& contact,
                                         TouchedMemory& state, ContactScratch& scratch) noexcept;

}  // namespace cavum
