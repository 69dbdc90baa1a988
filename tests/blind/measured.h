// What the last long run counted, so that a sample fails when things get worse, and says which promises are not kept yet.
// Rates in the order of `rates()`; replace them after every long run (`./dev blind`), never by wish.
#pragma once

#include <array>

namespace cavum::blind {

struct Counted {
  int successes = 0, trials = 0;
};

// 177 recordings of 790, what 40 minutes of two busy cores held: `CAVUM_TEST_SEED=1303307822 blind CAVUM --table --draws 10 --minutes 40`, program
// and generator of commit 50f7728. Kinds are mixed evenly, 1 to 7 draws of each mechanism: a part of the whole table, not all of it.
inline constexpr const char* k_measured_by = "seed 1303307822, commit 50f7728, 177 recordings";
inline constexpr std::array<Counted, 16> k_measured{{
    {53, 54},    // recall, size 1.0
    {50, 54},    // exact name, size 1.0
    {44, 45},    // recall, size 0.35, quantum 0 and 0.01
    {19, 21},    // recall, size 0.35, quantum 0.055
    {116, 118},  // precision
    {72, 74},    // parameter within 10 %, size 1.0
    {70, 74},    // interval covers, size 1.0
    {6, 9},      // pairs, both
    {6, 6},      // clean, quantum 0
    {6, 6},      // clean, quantum 0.01
    {8, 8},      // clean, quantum 0.055
    {9, 9},      // outside the library
    {6, 7},      // crosshead
    {11, 11},    // fault
    {106, 117},  // gain
    {1, 1},      // gain_error
}};

}  // namespace cavum::blind
