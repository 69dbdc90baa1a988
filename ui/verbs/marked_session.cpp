#include "ui/verbs/marked_session.h"

#include <iostream>

#include "engine/base/file.h"
#include "engine/base/text.h"
#include "scenarios/file/parse.h"
#include "scenarios/file/rubric_check.h"

namespace cavum {

MarkedSession marked_session(const std::string& path, const MarkingOptions& o) {
  Marking m;
  m.another_task = o.another_task;
  if (!o.scenario.empty()) m.scenario = load_scenario(o.scenario);
  if (!o.rubric.empty()) m.rubric = parse_rubric(read_text_file(o.rubric), o.rubric);
  m.by = o.rubric.empty() ? "" : "the rubric " + o.rubric;
  if (!o.scenario.empty()) m.by += (o.rubric.empty() ? "" : " and ") + ("the scenario " + o.scenario);
  return marked_session(path, std::move(m));
}

MarkedSession marked_session(const std::string& path, Marking by) {
  MarkedSession g;
  g.session = load_for_grading(path);
  GradedSession& s = *g.session;
  const auto old = read_old_result(s.sealed_result_json);
  const RubricSpec old_rubric = s.rubric;
  const bool anew = by.anew(), same_zones = !by.scenario;
  std::optional<Result> again;
  if (anew && old) again = grade(s.input(), old_rubric);
  if (by.scenario) use_scenario(s, std::move(*by.scenario), by.another_task);
  if (by.rubric)
    use_rubric(s, std::move(*by.rubric));
  else if (!same_zones)
    use_rubric(s, s.scenario.rubric);
  g.rubric = s.rubric;
  if (again && same_zones) {
    g.result = *again;
    mark(g.result, g.rubric);
  } else {
    g.result = grade(s.input(), g.rubric);
  }
  if (!old) return g;
  g.comparison = compare(*old, again ? *again : g.result, old_rubric, g.result, g.rubric);
  g.comparison->by = anew ? by.by : "this version of the program";
  g.regrade = anew || g.comparison->differs();
  return g;
}

void require_sound_marking(const MarkingOptions& o) {
  const auto warn = [](const RubricSpec& rubric) {
    for (const auto& p : turned_round(rubric)) std::cerr << "cavum: " << one_line(p.text()) << "\n";
  };
  if (!o.rubric.empty()) warn(parse_rubric(read_text_file(o.rubric), o.rubric));
  if (o.scenario.empty()) return;
  const Scenario s = load_scenario(o.scenario);
  if (o.rubric.empty()) warn(s.rubric);
}

}  // namespace cavum
