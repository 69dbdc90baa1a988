// What the last long run counted, so that a sample fails when things get worse, and says which promises are not kept yet.
// Rates in the order of `rates()`; replace them after every long run (`./dev blind`), never by wish.
#pragma once

#include <array>

namespace cavum::blind {

struct Counted {
  int successes = 0, trials = 0;
};

// 184 recordings of 790, what 13 minutes of two cores held: `CAVUM_TEST_SEED=764299356 blind CAVUM --table --draws 10 --minutes 13`, program
// and generator of commit fec9c67. Kinds are mixed evenly, a few draws of each mechanism: a part of the whole table, not all of it.
inline constexpr const char* k_measured_by = "seed 764299356, commit fec9c67, 184 recordings";
inline constexpr std::array<Counted, 16> k_measured{{
    {55, 56},    // recall, size 1.0
    {52, 56},    // exact name, size 1.0
    {45, 45},    // recall, size 0.35, quantum 0 and 0.01
    {17, 17},    // recall, size 0.35, quantum 0.055
    {117, 118},  // precision
    {70, 73},    // parameter within 10 %, size 1.0
    {72, 73},    // interval covers, size 1.0
    {8, 9},      // pairs, both
    {8, 8},      // clean, quantum 0
    {7, 7},      // clean, quantum 0.01
    {6, 6},      // clean, quantum 0.055
    {10, 10},    // outside the library
    {30, 31},    // crosshead, with 24 of seed 4248291567 (commit 680ff6f): one was `unexplained`
    {12, 12},    // fault
    {107, 118},  // gain
    {7, 7},      // gain_error
}};

}  // namespace cavum::blind
