#include "grading/trial/trial_output.h"

#include <nlohmann/json.hpp>

#include "grading/result/result_json.h"

namespace cavum::grading {

Lines trial_text(const Trial& trial) {
  Lines out;
  const auto line = [&](const TrialRow& row, bool wrong) {
    const Message by = !row.caught_by.empty() ? msg("by {}", List{row.caught_by, false})
                       : row.should.empty()   ? Message()
                                              : msg("should: {}", row.should);
    out.row({wrong ? msg("!") : Message(), Name{row.name}, msg("{}", word_of(row.verdict)),
             msg("{} of {}", as_points(row.points), as_points(row.max)), by});
  };
  line(trial.honest, trial.honest.verdict != Verdict::pass);
  for (const auto& row : trial.rows) line(row, row.verdict == Verdict::pass);
  return out;
}

nlohmann::ordered_json trial_json(const Trial& trial) {
  auto rows = nlohmann::ordered_json::array();
  for (const auto& row : trial.rows) {
    auto caught_by = nlohmann::ordered_json::array();
    for (const Message& by : row.caught_by) caught_by.push_back(english_text(by));
    rows.push_back({{"name", row.name},
                    {"what", english_text(row.what)},
                    {"verdict", verdict_name(row.verdict)},
                    {"points", rounded(row.points)},
                    {"max", rounded(row.max)},
                    {"caught_by", caught_by},
                    {"should", english_text(row.should)}});
  }
  return rows;
}

}  // namespace cavum::grading
