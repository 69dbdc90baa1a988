#include "ui/cli/marked_session.h"

#include "engine/base/file.h"
#include "scenarios/file/parse.h"
#include "scenarios/file/rubric_check.h"
#include "ui/parts/say.h"
#include "ui/parts/scenario_words.h"

namespace cavum::ui {

MarkedSession marked_session(const std::string& path, const MarkingOptions& o,
                             grading::ExamContexts& grounds) {
  Marking m;
  m.another_task = o.another_task;
  if (!o.scenario.empty()) m.scenario = scenarios::load_scenario(o.scenario);
  if (!o.rubric.empty()) m.rubric = scenarios::parse_rubric(read_text_file(o.rubric), o.rubric);
  m.rubric_file = o.rubric;
  m.scenario_file = o.scenario;
  return marked_session(path, std::move(m), grounds);
}

MarkedSession marked_session(const std::string& path, Marking by, grading::ExamContexts& grounds) {
  MarkedSession g;
  g.session = grading::load_for_grading(path, grounds);
  grading::GradedSession& s = *g.session;
  const auto old = grading::read_old_result(s.sealed_result_json);
  const scenarios::RubricSpec old_rubric = s.rubric;
  const bool anew = by.anew(), same_zones = !by.scenario;
  std::optional<grading::Result> again;
  if (anew && old) again = grading::grade(s.input(), old_rubric);
  if (by.scenario) grading::use_scenario(s, std::move(*by.scenario), by.another_task);
  if (by.rubric)
    grading::use_rubric(s, std::move(*by.rubric));
  else if (!same_zones)
    grading::use_rubric(s, s.scenario.rubric);
  g.rubric = s.rubric;
  show_texts_of(s.scenario);
  if (again && same_zones) {
    g.result = *again;
    grading::mark(g.result, g.rubric);
  } else {
    g.result = grading::grade(s.input(), g.rubric);
  }
  if (!old) return g;
  g.comparison = grading::compare(*old, again ? *again : g.result, old_rubric, g.result, g.rubric);
  g.comparison->rubric = by.rubric_file;
  g.comparison->scenario = by.scenario_file;
  g.comparison->entry = by.entry;
  g.regrade = anew || g.comparison->differs();
  return g;
}

void require_sound_marking(const MarkingOptions& o) {
  const auto warn = [](const scenarios::RubricSpec& rubric) {
    for (const auto& p : scenarios::turned_round(rubric)) say_error(p.message());
  };
  if (!o.rubric.empty()) warn(scenarios::parse_rubric(read_text_file(o.rubric), o.rubric));
  if (o.scenario.empty()) return;
  const scenarios::Scenario s = scenarios::load_scenario(o.scenario);
  if (o.rubric.empty()) warn(s.rubric);
}

}  // namespace cavum::ui
