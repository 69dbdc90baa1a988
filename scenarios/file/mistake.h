// What can be wrong, or unwise, in a scenario or rubric file, for whoever has to tell one from
// another.
#pragma once

#include "engine/base/named_enum.h"

namespace cavum::scenarios {

// clang-format off
#define CAVUM_MISTAKES(MISTAKE) \
  MISTAKE(other) \
  MISTAKE(not_toml)            /* or no text */ \
  MISTAKE(missing)             /* or empty */ \
  MISTAKE(wrong_type) \
  MISTAKE(out_of_range) \
  MISTAKE(too_large)           /* beyond a limit */ \
  MISTAKE(unknown_key) \
  MISTAKE(unknown_name)        /* the word of a key is none of those there are */ \
  MISTAKE(unknown_tissue) \
  MISTAKE(unknown_measure)     /* or one of what the exam does not have */ \
  MISTAKE(unknown_criterion) \
  MISTAKE(unknown_gauge) \
  MISTAKE(unknown_quantity)    /* of a condition */ \
  MISTAKE(unknown_bur) \
  MISTAKE(unknown_tooth)       /* its file */ \
  MISTAKE(unknown_language) \
  MISTAKE(bad_name) \
  MISTAKE(duplicate) \
  MISTAKE(contradictory)       /* two things that do not go together */ \
  MISTAKE(condition)           /* cannot be read, or does not mean what it reads */ \
  MISTAKE(outline)             /* crosses itself, or encloses nothing */ \
  MISTAKE(surface)             /* an STL file */ \
  MISTAKE(trespass)            /* target or leeway reach what must not be cut, or the air */ \
  MISTAKE(unreachable)         /* a buried target, a condition that never holds, a bur that does not fit, points that nobody can win */ \
  MISTAKE(idle)                /* changes nothing: a condition that always holds, points that nobody can lose, a fault that costs nothing */ \
  MISTAKE(faulty_preparations) /* passes, or gains points where it grows */
// clang-format on
CAVUM_NAMED_ENUM(Mistake, CAVUM_MISTAKES)

}  // namespace cavum::scenarios
