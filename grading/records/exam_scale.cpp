#include "grading/records/exam_scale.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "engine/base/json_fields.h"

namespace cavum::records {

using nlohmann::json;

ExamScale scale_in(const json& result) {
  const json& score = member_of(result, "score");
  if (!member_of(score, "max").is_number()) return {};
  return {score.at("max").get<double>(), score.value("pass_percent", 0.0),
          score.value("borderline_percent", 0.0)};
}

std::map<std::string, ExamScale> own_scales(const Registry& registry) {
  std::map<std::string, std::vector<std::pair<ExamScale, std::size_t>>> found;
  for (const auto& s : registry.sessions) {
    const ExamScale scale = scale_in(*s.filed);
    if (scale.max <= 0) continue;
    auto& of_exam = found[s.scenario_id];
    const auto at = std::find_if(of_exam.begin(), of_exam.end(),
                                 [&](const auto& f) { return f.first == scale; });
    if (at == of_exam.end())
      of_exam.emplace_back(scale, 1);
    else
      ++at->second;
  }
  std::map<std::string, ExamScale> out;
  for (const auto& [exam, scales] : found)
    out[exam] = std::max_element(scales.begin(), scales.end(), [](const auto& a, const auto& b) {
                  return a.second < b.second;
                })->first;
  return out;
}

}  // namespace cavum::records
