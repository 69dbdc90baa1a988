// The detector of breakthroughs. It sees what a device gives - rendered or measured force, pose,
// pedal, speed, which bur is mounted - and nothing of the tissue, so that it would work on a real
// tooth as well.
//
// A breakthrough is a loss of force that the tip's own motion does not explain: the hand presses
// on, solid tissue would give the force G (ExpectedForce), and hardly anything of it is left. A tip
// that goes on in the fall would press further in: G then grows beyond what was felt before. How
// sure it is, is a likelihood ratio of two stories about the share F / G that is left: a cavity
// leaves next to nothing (half normal with the scale `void_rest`, widened by the force's noise,
// which is estimated on the way); softer tissue leaves any share of it (uniform), and is met
// `soft_odds` times as often.
//
// What else makes a force fall, and what tells it apart:
//
//   lift-off, retreat for a look    the tip goes back: G falls with F (k · way; F = k X)
//   easing off after saturation     the same, slowly
//   a pause, a tip held by friction the surface recedes from the tip: G decays with F (τ); and the
//   tip does not advance pedal released, bur changed   nothing can be cut: the observer starts anew
//   enamel to dentin, soft lesion   a share of the force is left, k·τ against k·τ: 0.3 to 1, and
//   0.2 to 0.45 slip off a wall or an edge      the tip leaves sideways, or from a place where it
//   has hardly cut (`slips_mm_s`, `strays_mm`, `dwell_s`) milling, a bur pulled out of  the push is
//   across the handle, or towards it (`least_axial`); a cavity in a wall that is milled away is
//   left to a bind                          the tissue's word breaking into an earlier cut    the
//   way leads to where the tip was with little force before (FreedSites) chatter the mean force
//   vanishes, its scatter is many times the noise
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "grading/perforation/expected_force.h"

namespace cavum::grading {

struct BreakthroughSettings {
  double sure_from = 0.5;  ///< events below this probability are left out, 0..1
  ExpectedForceSettings expected;

  // the likelihood ratio
  double void_rest =
      0.15;  ///< scale of the share of G that a cavity leaves: the rim of the hole still touches
  double soft_odds =
      2.4;  ///< softer tissue is so many times as likely beforehand: at F / G = 0.19 it is even
  double least_n = 0.05;  ///< a force below it tells nothing: 30 ms of noise of 0.05 N per tick are
                          ///< a third of it
  double presses_on =
      0.5;  ///< a fall counts while the tip's motion explains no more than half of it
  double confirm_s = 0.02;  ///< it has to be so sure for so long
  double chatter =
      0.5;  ///< of G: a force that scatters by more than that, beyond its noise, is not gone
  double least_advance_mm =
      0.1;  ///< a cavity lets the tip on: by two steps of the encoder at least

  // the fall
  double opens_at = 0.5;    ///< of G: a fall is watched from there ...
  double closes_at = 0.7;   ///< ... until the force is back
  double returns_at = 0.3;  ///< ... or, once it was told, rises again: one fall is one event
  double dated_at = 0.77;   ///< of G: the event's time is the last moment the force still had it

  // other explanations
  double least_axial = 0.2;  ///< cosine of push against the handle's axis: a push across the handle
                             ///< mills a wall, one towards it pulls out
  double slips_mm_s = 1.2;   ///< a tip that wanders sideways faster than that before the fall slips
  double strays_mm = 0.35;   ///< one that has gone sideways by more than that ...
  double strays_share =
      0.5;  ///< ... and this share of its advance, when the force is gone, fell off something
  double dwell_s = 0.38;  ///< it must have cut so long ...
  double dwell_mm = 0.5;  ///< ... within this distance: about the radius of a head
  double freed_n =
      0.12;  ///< where the force was below that, the tooth's surface is known to within 0.2 mm
  double springs_mm_s = 100.0;  ///< a tip that moves faster springs out of the hole or back: where
                                ///< it has passed says nothing
  double near_freed_mm =
      0.5;  ///< a way that leads so near to such a place leads into an earlier cut
};

/// One fall of the force.
struct Breakthrough {
  std::int64_t tick = 0;  ///< when it began
  std::int64_t seen_tick =
      0;  ///< when the detector could say so: it was more likely than not, or as sure as it got
  double probability = 0.0;  ///< 0..1; 0.5 = as likely as not; 0.69 when nothing at all is left of
                             ///< the force, for very soft tissue leaves little
  double force_before_n = 0.0;  ///< while the tissue still held
  double force_after_n = 0.0;   ///< the least mean over 30 ms in the fall
  double advance_mm = 0.0;      ///< of the tip along the push in the fall
};

/// In order of time. `inputs` and `records` have equal length, one entry per tick of 1 ms.
[[nodiscard]] std::vector<Breakthrough> find_breakthroughs(
    std::span<const TickInput> inputs, std::span<const TickRecord> records,
    const BreakthroughSettings& settings = {});

}  // namespace cavum::grading
