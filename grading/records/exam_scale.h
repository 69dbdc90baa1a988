// What an exam is marked out of and passed with, as its candidates sat it: a regrade by another
// rubric changes nothing of it. Gradebook and class are on this one scale.
#pragma once

#include <map>
#include <string>

#include "grading/records/registry.h"

namespace cavum::records {

struct ExamScale {
  double max = 0, pass_percent = 0, borderline_percent = 0;
  bool operator==(const ExamScale&) const = default;
};
/// Of one result; max is 0 where it has none.
[[nodiscard]] ExamScale scale_in(const nlohmann::json& result);
/// Of each exam's sealed results the most frequent scale, the first filed of two as frequent; an
/// exam without any is left out.
[[nodiscard]] std::map<std::string, ExamScale> own_scales(const Registry& registry);

}  // namespace cavum::records
