// What a coach at the chair would say now. For practice only: an exam is silent.
#pragma once

#include "scenarios/exam/live_exam.h"

namespace cavum::station {

/// One short sentence, or empty: pressing too hard, turning in the air for long, beside the target,
/// near its floor, below it.
[[nodiscard]] Message coaching_hint(const scenarios::ExamSetup& setup,
                                    const scenarios::LiveView& view);

}  // namespace cavum::station
