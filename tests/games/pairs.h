// Pairs of sessions of which one is worse in a single respect, and rubrics drawn at random that
// both are marked by.
#pragma once

#include "engine/base/random.h"
#include "tests/games/bodies.h"
#include "tests/games/sitting.h"

namespace cavum::games {

/// What a candidate does, and how.
struct Work {
  Body body;
  Body core;  ///< of it what of the target goes
  double seconds = 20.0, idle_s = 0.0;
  Hand hand;
  bool breaks_a_rule = false;  ///< mounts a bur that is not allowed and turns too fast, for 50 ms
  bool walks_out = false;      ///< with the pedal pressed: the last step stays open
  std::string words;
};
void play(const Work& work, Sitting& sitting);

/// Honest work, done more or less well.
[[nodiscard]] Work drawn_work(const Task& task, Random& random);

enum class Respect {
  overcut_wall,
  less_target,
  deeper,
  thinner_floor,
  fault_opened,
  larger_perforation,
  rough_wall,
  protected_cut,
  cut_elsewhere,
  longer,
  longer_idle,
  more_force,
  longer_way,
  step_left_open,
  rule_broken
};
inline constexpr int k_respects = 15;
[[nodiscard]] const char* respect_name(Respect respect);
/// `a` worse in that respect alone. `a` may be changed so that it can be: it is what the result is
/// to be held against.
[[nodiscard]] Work worse(const Task& task, Work& a, Respect respect, Random& random);

/// Criteria on measures that say more or less of something; figures of a surface (mean, 95th
/// percentile, taper) may move either way (docs/grading.md) and are left out.
[[nodiscard]] scenarios::RubricSpec drawn_rubric(const Task& task, Random& random);

}  // namespace cavum::games
