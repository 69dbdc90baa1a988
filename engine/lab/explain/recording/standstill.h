// Instruments that did not record: a sensor or an encoder that stands still while the other moves,
// a clock that jumps, columns in each other's place.
#pragma once

#include <string>
#include <vector>

#include "engine/lab/explain/recording/faults.h"
#include "engine/lab/explain/recording/recording.h"

namespace cavum::explain {

/// In words, each with what to do; empty when there is none. `standstill_faults`: f_n keeps one
/// value, not its largest or least, over 20 rows and 0.2 s or more while x goes where the force of
/// all other rows differs by a quarter of all it does; x_mm keeps one value while the measured
/// speed goes on.
[[nodiscard]] std::vector<DataFault> standstill_faults(const Recording& recording);
/// An interval above 0.3 s, twenty times as long as 99 of 100 others, over which the tool moves no
/// further than in one of those: the clock jumped. Rows that are missing while the clock and the
/// motion go on are no fault.
[[nodiscard]] std::vector<DataFault> jump_faults(const Recording& recording);
/// x_mm over f_n bends as a force over a position does, f_n over x_mm does not, and f_n is the
/// smoother of the two by far.
[[nodiscard]] std::vector<DataFault> swap_faults(const Recording& recording);

}  // namespace cavum::explain
