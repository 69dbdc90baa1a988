// The constants by which contact, carving and the handpiece are tuned, each with its unit and its
// reason; tests/bench/tuning.py measures what one breaks when it is halved or doubled. "Leaves":
// edges of a leaf of the tooth. What has a source in the world (stiffness, removal, limits of
// force) is no tuning: it stands in data/materials and in the servo's configuration.
#pragma once

#ifdef CAVUM_TUNABLE  // a build for measuring: the environment may give another value
#include <cstdlib>
#define CAVUM_TUNING(NAME, VALUE)                                          \
  inline const decltype(VALUE) NAME = [] {                                 \
    const char* given = std::getenv(#NAME);                                \
    return static_cast<decltype(VALUE)>(given ? std::atof(given) : VALUE); \
  }()
#else
#define CAVUM_TUNING(NAME, VALUE) inline constexpr auto NAME = VALUE
#endif

namespace cavum {
namespace tuning {

// Shape of the tool (contact_tool).
/// mm. Edges are felt as round as that, as grit makes them: a sharper one could not lie in the
/// corner it has cut, which is rounded between leaves.
CAVUM_TUNING(k_edge_radius_mm, 0.08);
/// Samples of a head, at most: a long one is straight, and the count decides the time of a tick.
CAVUM_TUNING(k_max_head_samples, 450.0);

// One step of the proxy: the nearest place that no half space forbids (half_spaces).
/// mm. A half space violated by more enters the active ones; one violated by less may leave. Apart,
/// or two that are nearly one would take turns.
CAVUM_TUNING(k_enters_mm, 1e-8);
CAVUM_TUNING(k_holds_mm, 1e-9);
/// Rounding of a multiplier that is zero.
CAVUM_TUNING(k_multiplier_tolerance, -1e-9);
/// rad. Normals nearer to each other, or to one plane, have no corner in reach. Cross products keep
/// their digits where the determinant of dot products loses them: normals of a flat surface differ
/// by 1e-3 to 1e-2 rad, by the rounding of distances.
CAVUM_TUNING(k_parallel_rad, 1e-6);

// The way of the proxy in a tick (proxy).
/// Steps in a tick, of one leaf at most: 0.6 mm a tick at leaves of 0.05 mm, 600 mm/s.
CAVUM_TUNING(k_max_steps, 12);
/// So far, in leaves or mm, a half space stands in for a curved surface.
CAVUM_TUNING(k_linear_leaves, 0.3);
CAVUM_TUNING(k_linear_mm, 0.0135);
/// Leaves. A squeezed tool may still move by that: the dead zone, and a little more.
CAVUM_TUNING(k_squeeze_leaves, 0.005);
/// Leaves. A sample no deeper is not pushed out: two walls that differ by rounding would squeeze
/// the tool out.
CAVUM_TUNING(k_dead_leaves, 0.004);
/// Leaves. A sample that lies deeper is pushed out no faster.
CAVUM_TUNING(k_deepest_leaves, 0.5);
/// Leaves. What touches where the surface will recede to is gathered, too; beyond a step, against
/// rounding.
CAVUM_TUNING(k_gather_leaves, 1.1);
CAVUM_TUNING(k_gather_more_leaves, 0.02);
/// mm. What is near is not asked for air again before so much travel; round a patch, so much must
/// be clear.
CAVUM_TUNING(k_stays_near_mm, 0.3);
CAVUM_TUNING(k_margin_mm, 0.5);
/// mm. A smaller step ends the search: the noise of a rendered force of 1 N at 1 N/mm is then below
/// 0.1 mN.
CAVUM_TUNING(k_settled_mm, 2e-5);
/// Half spaces are made anew at the place found, at most so often, and so many more are kept than
/// there are samples: of a curved surface each round halves what is left, and 8 end below a settled
/// step.
CAVUM_TUNING(k_refinements, 8);
CAVUM_TUNING(k_refined_room, 32);
/// Places looked up in a tick, at most; after a second step back. Half spaces say little of a crest
/// between two samples, or of a sheet between head and neck: the proxy goes forth and back over it
/// and gathers anew each time, so a step back makes the stride shorter, and the search goes on in
/// the next tick once more places were looked up. The last gathering comes on top, some 450 places
/// in a deep hole.
CAVUM_TUNING(k_max_looked_up, 1200);
CAVUM_TUNING(k_max_going_back, 300);
/// Places of a gathering that is spread over ticks, in each of them.
CAVUM_TUNING(k_part_looked_up, 140);
/// Leaves. The proxy takes an opened way while it lies no further beside it, and nothing there
/// enters the tissue by more.
CAVUM_TUNING(k_aside_leaves, 0.1);
CAVUM_TUNING(k_room_leaves, 0.01);
/// Leaves: the shortest stride. A stride after a step back, and after one onwards.
CAVUM_TUNING(k_resting_stride, 0.05);
CAVUM_TUNING(k_shorter, 0.4);
CAVUM_TUNING(k_longer, 1.5);

// What is touched (touched_means).
/// Squared, of unit normals: at 0.01 rad the areas seen along the normal have hardly changed.
CAVUM_TUNING(k_same_normal2, 1e-4);
/// So little way, in leaves and mm, changes no weight by more than 4 %; after a carve 10 %.
CAVUM_TUNING(k_same_means_leaves, 0.02);
CAVUM_TUNING(k_same_means_mm, 0.001);
CAVUM_TUNING(k_late_means_leaves, 0.05);
CAVUM_TUNING(k_late_means_mm, 0.0025);
/// Leaves. A sample nearer than the first touches fully, for rounding of distances is far less;
/// from there, over the second, less and less.
CAVUM_TUNING(k_touch_leaves, 0.2);
CAVUM_TUNING(k_fade_leaves, 0.5);
/// Leaves. So far before a sample its tissue is looked up: a last leaf over the pulp has faded out
/// when it is cut. Where a sheet is thinner: just inside.
CAVUM_TUNING(k_ahead_leaves, 1.6);
CAVUM_TUNING(k_close_leaves, 0.1);
/// Leaves: what is looked up ahead, and the eight leaves around it.
CAVUM_TUNING(k_void_near_leaves, 3.0);
/// mm², of the sample that touches when none does: an eighth of what a sample of the head stands
/// for.
CAVUM_TUNING(k_furthest_mm2, 1e-3);
/// mm²: rounding.
CAVUM_TUNING(k_min_area_mm2, 1e-9);
/// mm: half a coarse grain. No grain stands still, though the axis does.
CAVUM_TUNING(k_min_radius_mm, 0.05);
/// Stiffnesses nearer than that share are one tissue's.
CAVUM_TUNING(k_even_share, 0.999);

// Recession into carves (servo: recession, contact_stages, cutting_stage).
/// A carve's step, mm and leaves: a leaf of 0.025 mm goes at once, a coarse one in four. What a
/// carve costs hardly depends on how deep it is.
CAVUM_TUNING(k_min_step_mm, 0.025);
CAVUM_TUNING(k_step_leaves, 0.25);
/// Carves that may be owed: one that contact is following, one under way, one that gathers. A head
/// that neck or shank hold owes no more.
CAVUM_TUNING(k_max_pending_steps, 3.0);
/// Leaves. The distance field is cut wider than the head by a clearance of 0.01 leaf and more: the
/// proxy may be paid for that in advance.
CAVUM_TUNING(k_max_ahead_leaves, 0.1);
/// Leaves: half the distance of two. A proxy further aside stands in another hole.
CAVUM_TUNING(k_same_hole_leaves, 0.5);
/// Of a carve's step: a micrometre at leaves of 0.05 mm. Less is no touch: many short ones would
/// each begin a carve for nothing.
CAVUM_TUNING(k_lift_share, 0.04);
/// Units of 15 ns (Octree::plan), 24 µs in all: a tenth of the shortest tick, 0.25 ms. A whole
/// carve takes 50 to 160 µs at leaves of 0.05 mm and four times that at 0.025
/// (docs/decisions/0013-a-carve-takes-equal-parts-of-ticks.md); so much a tick ends it long before
/// the next one is due.
CAVUM_TUNING(k_carve_work, 1600);
/// mm, share of a step. A tool that slides is carved after half a step, for the surface that it
/// leaves behind is the one it felt; that it slides shows after two leaves of 0.05 mm.
CAVUM_TUNING(k_slide_mm, 0.1);
CAVUM_TUNING(k_slide_share, 0.5);
/// Share of a step with void tissue ahead, so that the last leaf over a pulp goes in time.
CAVUM_TUNING(k_void_share, 0.25);
/// Leaves. Void tissue gives no recession: it goes as the head sweeps through it, a leaf at a time.
CAVUM_TUNING(k_sweep_leaves, 1.0);

// The handpiece.
/// Share of the pedal's way: a foot that only rests on it must not drill.
CAVUM_TUNING(k_dead_travel, 0.02);
/// Share of the full speed, 2000 of 200,000 rpm: an exponential run-down would never end otherwise.
CAVUM_TUNING(k_still_share, 0.01);

}  // namespace tuning
}  // namespace cavum
