// Dishonest and lazy ways to sit an exam.
#pragma once

#include <cstdint>

#include "tests/games/sitting.h"

namespace cavum::games {

/// What a fair examiner would say of it at best.
enum class Fair { fail, not_pass, any };

struct Game {
  std::string name;
  std::function<void(Sitting&)> play;
  Fair fair = Fair::any;
};

/// Those that can be played in a task.
[[nodiscard]] std::vector<Game> games_of(const Task& task);
/// Walls a millimetre and more beside the target, all of them or the floor alone; everything above
/// the floor taken off.
[[nodiscard]] std::vector<Game> gross_overcuts_of(const Task& task);
/// The way into the pulp, but over the mouth of every canal 0.6 mm of the chamber's roof stay. Of
/// tasks with an aim.
[[nodiscard]] Game lips_over_the_canals(const Task& task);
/// Drawn at random from parts of honest work and what may be wrong with it.
[[nodiscard]] std::vector<Game> mixtures_of(const Task& task, std::uint64_t seed, int count);
/// The target, cut exactly, in twenty seconds.
void honest(Sitting& sitting);

}  // namespace cavum::games
