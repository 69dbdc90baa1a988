#include "grading/battery/battery_output.h"

#include <fmt/core.h>

#include "engine/base/text.h"
#include "grading/result/result_json.h"

namespace cavum::grading {

std::string battery_text(const Battery& battery) {
  std::string s;
  const auto line = [&](const BatteryRow& row, const char* mark) {
    std::string by;
    for (const auto& id : row.caught_by) by += (by.empty() ? "" : ", ") + id;
    s += fmt::format("{} {:<34} {:<6} {:>5} of {}  {}\n", mark, row.name, verdict_name(row.verdict), fixed(row.points, 1), fixed(row.max, 1),
                     by.empty() ? (row.should.empty() ? "" : "should: " + row.should) : "by " + by);
  };
  line(battery.honest, battery.honest.verdict == Verdict::pass ? " " : "!");
  for (const auto& row : battery.rows) line(row, row.verdict == Verdict::pass ? "!" : " ");
  return s;
}

nlohmann::ordered_json battery_json(const Battery& battery) {
  auto rows = nlohmann::ordered_json::array();
  for (const auto& row : battery.rows)
    rows.push_back({{"name", row.name},
                    {"what", row.what},
                    {"verdict", verdict_name(row.verdict)},
                    {"points", rounded(row.points)},
                    {"max", rounded(row.max)},
                    {"caught_by", row.caught_by},
                    {"should", row.should}});
  return rows;
}

}  // namespace cavum::grading
