// Volumes by zone and tissue, counted leaf by leaf.
#pragma once

#include "grading/grade.h"
#include "grading/removed_map.h"

namespace cavum {

[[nodiscard]] VolumeMeasures measure_volumes(const GradeInput& input, const RemovedMap& removed, std::int64_t last_tick);

}  // namespace cavum
