// What a tooth with a seed is made of, as data: cusps, ridges, walls, neck, enamel, roots and pulp.
// `grow_molar` and its like write a plan from drawn measures; `GrownTooth` turns it into a shape.
// Lengths in mm. In a plan +x is mesial, +y buccal (labial), and z = 0 the lowest point of the
// cervical line; `base_z_mm` moves it into the tooth frame, whose origin is the crown's centre.
#pragma once

#include <array>
#include <vector>

#include "engine/base/vec.h"
#include "engine/tooth/make/tooth_shapes.h"

namespace cavum {

/// A cusp: a four-sided pyramid with rounded edges. Its edges are the triangular ridge (inwards),
/// the two cusp ridges and the outer ridge.
struct CuspPlan {
  Vec3 tip_mm;
  double inward_x, inward_y;  // direction of the triangular ridge, length 1
  double cusp_ridge_slope;    // fall of the two cusp ridges, mm per mm
  double triangular_slope;    // fall of the triangular ridge
  double flank_slope;         // fall to both sides of the triangular ridge
  double outer_slope;         // fall outwards; the wall ends it
  double bend;  // of the triangular ridge, 1/mm: sideways shift per square of the way inwards
  double cusp_ridge_bow = 0.08;  // the cusp ridges turn inwards at their ends, 1/mm
  double round_mm = 0.5;         // radius of the edges
  double side_groove_mm = 0.06;  // depth of the supplemental grooves beside the triangular ridge
};

/// A marginal ridge: an upright crest that runs from buccal to lingual.
struct CrestPlan {
  double x_mm, bow;    // crest at x = x_mm - bow y²
  double z_mm, rise;   // crest at z = z_mm + rise y²: it climbs towards the cusps
  double inward_sign;  // +1: inwards is +x (distal ridge), -1: inwards is -x (mesial)
  double inward_slope, outer_slope;
  double end_mm;  // |y| where it ends below the cusps
  double round_mm = 0.45;
};

/// A groove between two neighbouring cusps that runs over the edge and down the wall. Indices into
/// `cusps`.
struct WallGroovePlan {
  std::size_t first, second;
  double depth_mm, width_mm;
};

/// Fissures: clefts at the bottom of the valleys between cusps and ridges, deeper where three of
/// them meet (pits).
struct FissurePlan {
  double depth_mm = 0.5, pit_mm = 0.2;
  double half_width = 0.42;  // as difference in height of the two slopes, mm
  double at_crests = 0.6;    // depth between a cusp and a marginal ridge, as a share
  double reach_x_mm = 3.6, reach_y_mm = 2.6,
         middle_x_mm = 0.0;  // fissures fade out around this ellipse
};

/// A dent (depth > 0) or bulge (< 0) of a wall: fades in from z[0] to z[1] and out from z[2] to
/// z[3].
struct DentPlan {
  double side;            // +1 buccal, -1 lingual
  double x_mm, width_mm;  // middle and half width
  double depth_mm;
  std::array<double, 4> z_mm;
};

/// Where the four walls stand, by z; between them a cross-section from ellipse (squareness 0) to
/// rounded rectangle (1).
struct WallPlan {
  std::vector<Knot> mesial, distal, buccal,
      lingual;  // distances from the axis, positive towards the wall's own side
  double squareness = 0.5, root_squareness = 0.0;  // of the crown, and below the neck
  double narrow_lingual =
      0.0;  // the lingual side is shorter than the buccal one by twice this share
  double narrow_distal = 0.0;
  std::vector<DentPlan> dents;
};

/// The cervical line: z = 0 at its lowest, higher on mesial, distal and lingual sides.
struct NeckPlan {
  double mesial_mm, distal_mm, lingual_mm;
  double half_x_mm, half_y_mm;
};

/// Thickness of enamel along the normal.
struct EnamelPlan {
  double buccal_mm, lingual_mm, proximal_mm;  // greatest of the walls
  double full_height_mm;      // above the neck: where the walls' thickness is reached
  double cusp_mm, valley_mm;  // at the tips and in the valleys beside a fissure
};

/// A root: an upright body of elliptic cross-section with a round apex, whose axis bends.
struct RootPlan {
  double top_x_mm, top_z_mm, apex_z_mm;
  double lean_mm, bend_mm;  // x of the axis at depth share s: top_x + lean s + bend s²
  double lean_y_mm;         // y: lean_y s
  double half_x_mm, half_y_mm;
  double taper;    // 1 = a paraboloid, less = slimmer towards the apex, 2 = half an ellipsoid
  double concave;  // share of half_x that the mesial and distal grooves take away
};

struct HornPlan {
  Vec3 from_mm, to_mm;
  double from_radius_mm, to_radius_mm;
};

/// A canal from the chamber's floor to its end above the apex, along its root's axis.
struct CanalPlan {
  std::size_t root;
  double x_mm, y_mm;        // at its mouth, from the root's axis there
  double mouth_mm, end_mm;  // radii, mesiodistally
  double oval;              // buccolingual radius over mesiodistal radius at the mouth
  double draw_in;           // share of y that is lost on the way down
};

struct PulpPlan {
  double roof_z_mm, floor_z_mm;
  double middle_x_mm, middle_y_mm, half_x_mm, half_y_mm;  // of the chamber at mid height
  double widen_x, widen_y;  // growth of the half widths per mm upwards
  double lean_y = 0.0;      // shift of its middle towards buccal per mm above the neck
  double sag;               // the roof hangs down in its middle, mm per mm of distance
  std::vector<HornPlan> horns;
  std::vector<CanalPlan> canals;
};

struct ToothPlan {
  double base_z_mm = 0.0;  // z of the plan's zero in the tooth frame
  std::vector<CuspPlan> cusps;
  std::vector<CrestPlan> crests;
  std::vector<WallGroovePlan> wall_grooves;
  double groove_low_z_mm = 2.0, groove_high_z_mm = 6.0;  // where the grooves of the walls fade in
  FissurePlan fissures;
  WallPlan wall;
  double edge_round_mm = 0.8;  // of the border between walls and occlusal face
  NeckPlan neck;
  EnamelPlan enamel;
  std::vector<RootPlan> roots;
  double rooted_z_mm = -3.2;  // from the neck down to here the trunk turns into the roots; a
                              // furcation lies a little higher
  PulpPlan pulp;
  double steepest =
      3.0;  // the shape's values grow no faster than this, mm per mm: see FormulaTooth
};

}  // namespace cavum
