// What the last long run counted, so that a sample fails when things get worse, and says which
// promises are not kept yet. Rates in the order of `rates()`; replace them after every long run
// (`./dev blind`), never by wish.
#pragma once

#include <array>

namespace cavum::blind {

struct Counted {
  int successes = 0, trials = 0;
};

// All 790 recordings: `CAVUM_TEST_SEED=4226272569 blind CAVUM --table --draws 10`, program and
// generator of commit e056d2a.
inline constexpr const char* k_measured_by = "seed 4226272569, commit e056d2a, 790 recordings";
inline constexpr std::array<Counted, 16> k_measured{{
    {258, 260},  // recall, size 1.0
    {244, 260},  // exact name, size 1.0
    {172, 174},  // recall, size 0.35, quantum 0 and 0.01
    {84, 86},    // recall, size 0.35, quantum 0.055
    {514, 522},  // precision
    {329, 349},  // parameter within 10 %, size 1.0
    {336, 349},  // interval covers, size 1.0
    {36, 40},    // pairs, both
    {30, 30},    // clean, quantum 0
    {30, 30},    // clean, quantum 0.01
    {30, 30},    // clean, quantum 0.055
    {37, 40},    // outside the library
    {53, 54},    // crosshead, with 24 of seed 4248291567 (commit 680ff6f): one was `unexplained`
    {50, 50},    // fault
    {476, 518},  // gain
    {20, 20},    // gain_error
}};

}  // namespace cavum::blind
