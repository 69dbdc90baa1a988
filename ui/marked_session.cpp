#include "ui/marked_session.h"

#include <iostream>

#include "engine/base/file.h"
#include "engine/base/text.h"
#include "scenarios/parse.h"
#include "scenarios/rubric_check.h"

namespace cavum {

MarkedSession marked_session(const std::string& path, const MarkingOptions& o) {
  MarkedSession g;
  g.session = load_for_grading(path);
  GradedSession& s = *g.session;
  const auto old = read_old_result(s.sealed_result_json);
  const RubricSpec old_rubric = s.rubric;
  std::optional<Result> again;
  if (o.anew() && old) again = grade(s.input(), old_rubric);
  if (!o.scenario.empty()) use_scenario(s, load_scenario(o.scenario), o.another_task);
  if (!o.rubric.empty())
    use_rubric(s, parse_rubric(read_text_file(o.rubric), o.rubric));
  else if (!o.scenario.empty())
    use_rubric(s, s.scenario.rubric);
  g.rubric = s.rubric;
  if (again && o.scenario.empty()) {
    g.result = *again;
    mark(g.result, g.rubric);
  } else {
    g.result = grade(s.input(), g.rubric);
  }
  if (!old) return g;
  g.comparison = compare(*old, again ? *again : g.result, old_rubric, g.result, g.rubric);
  g.comparison->by = o.rubric.empty() ? "" : "the rubric " + o.rubric;
  if (!o.scenario.empty()) g.comparison->by += (o.rubric.empty() ? "" : " and ") + ("the scenario " + o.scenario);
  if (!o.anew()) g.comparison->by = "this version of the program";
  g.regrade = o.anew() || g.comparison->differs();
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
