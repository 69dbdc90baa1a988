// What a person who drills knows, and what he does with it, a thousand times a second. Hands are
// written by authors who know practice.md and this page alone: nothing of the tooth's inside, of
// the force law or of the detector that their recordings will try.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "engine/base/random.h"
#include "engine/base/vec.h"

namespace cavum::hands {

/// What was agreed before he begins. Tooth frame, mm.
struct Task {
  Vec3 entry_mm;                  ///< a place on the tooth's surface
  Vec3 into;                      ///< unit; the planned axis, into the tooth
  double depth_mm = 1.0;          ///< how deep the cavity shall be along `into`, from `entry_mm`
  double width_mm = 1.5;          ///< how wide about the axis
  bool into_the_chamber = false;  ///< he means to open the pulp chamber, and feels for it; else he
                                  ///< means to stop at `depth_mm`, whatever he meets
  double head_radius_mm = 0.5;    ///< of the bur
  double head_length_mm = 2.0;
};

/// What he feels, hears and sees in this millisecond.
struct Felt {
  double t_s = 0.0;
  Vec3 force_n;  ///< on the hand: out of the tooth while he presses
  Vec3 tip_mm;   ///< where the bur's tip is, as he sees it: the tooth holds it up
  Vec3 hand_mm;  ///< where his hand has the tip: pressed in further than it is seen, by 0.3 to 2 mm
                 ///< at usual forces, for the device is soft
  double rpm = 0.0;      ///< of the handpiece; it takes 0.15 s to follow the pedal
  bool cutting = false;  ///< he hears it: turning, and in contact
};

/// What he does. The fingers are a mass of 0.1 kg on a spring and a damper between where they are
/// (`hand_mm`) and where he wants the tip; to press with a force F along a direction d, want it at
/// `hand_mm` + d F/stiffness. The device's joints rub with 0 to 0.45 N.
struct Doing {
  Vec3 wanted_mm;                    ///< where he wants his hand to have the tip
  double stiffness_n_per_mm = 1.0;   ///< 0.1 (loose) to 3 (braced on a finger rest)
  double damping_n_s_per_mm = 0.05;  ///< 0.02 to 0.2
  double pedal = 0.0;                ///< 0..1
  Vec3 handle{0, 0, 1};              ///< unit, along the tool from the tip to the hand
  bool done = false;                 ///< he has taken the tool away and says so
};

class Hand {
 public:
  virtual ~Hand() = default;
  /// Called once a millisecond, from the beginning (the tip 3 mm above `entry_mm`, everything at
  /// rest) until `done` or 60 s have gone.
  virtual Doing act(const Felt& felt) = 0;
  /// A word for what it is doing in this session (steady, pecking, ...), for tables.
  [[nodiscard]] virtual std::string style() const = 0;
};

/// A hand by its name. `random` is its own: equal seeds, equal hands. Everything that differs
/// between persons and days is drawn at the beginning.
struct HandKind {
  const char* name;
  std::unique_ptr<Hand> (*make)(const Task& task, Random random);
};
[[nodiscard]] std::span<const HandKind> all_hands();

}  // namespace cavum::hands
