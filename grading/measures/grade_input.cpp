#include "grading/measures/grade_input.h"

#include <algorithm>

#include "scenarios/exam/runner.h"

namespace cavum::grading {

std::int64_t counted_ticks(std::int64_t recorded, std::span<const SessionEvent> events) {
  for (const auto& e : events)
    if (e.kind == scenarios::event_name(scenarios::ExamEventKind::finished)) recorded = std::min(recorded, e.tick + 1);
  return recorded;
}

}  // namespace cavum::grading
