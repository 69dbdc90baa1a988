#include "grading/measures/grade_input.h"

#include <algorithm>

namespace cavum::grading {

std::int64_t counted_ticks(std::int64_t recorded, std::span<const TimedEvent> events) {
  for (const auto& e : events)
    if (e.as<Finished>() != nullptr) recorded = std::min(recorded, e.tick + 1);
  return recorded;
}

}  // namespace cavum::grading
