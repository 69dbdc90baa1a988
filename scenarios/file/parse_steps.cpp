#include "scenarios/file/parse_steps.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>

#include "engine/tooth/tissue_grid.h"
#include "scenarios/file/condition.h"
#include "scenarios/file/expression.h"
#include "scenarios/file/names.h"

namespace cavum::scenarios {
namespace {

void check_condition(CheckedTable& t, const char* key, const std::string& text) {
  if (text.empty()) return;
  std::vector<std::string> names;
  for (const auto& q : k_live_quantities) names.emplace_back(q.name);
  for (const Tissue& tissue : standard_tissues()) names.push_back("touched_" + tissue.name);
  constexpr std::size_t k_longest = 2000;
  if (text.size() > k_longest) {
    t.problem(key, msg("'{}' has {} characters", key, text.size()), msg("write at most 2000"),
              Mistake::too_large);
    return;
  }
  for (const auto& function : functions_in_expression(text))
    if (function != "min" && function != "max" && function != "abs") {
      t.problem(key, msg("'{}' uses the unknown function '{}'", key, function),
                msg("use min, max or abs"), Mistake::condition);
      return;
    }
  try {
    std::vector<std::string> known = names;
    for (const auto& used : names_in_expression(text)) {
      if (std::find(names.begin(), names.end(), used) != names.end()) continue;
      if (used.rfind("touched_", 0) != 0)
        t.problem(key, msg("'{}' uses the unknown quantity '{}'", key, used),
                  suggestion(used, names), Mistake::unknown_quantity);
      known.push_back(used);
    }
    std::vector<double> values(known.size(), 0.0);
    const Expression compiled(text, known, values);
    static_cast<void>(compiled);
    if (const auto fault = condition_fault(text))
      t.problem(key, msg("'{}' {}", key, fault->what), fault->what_to_do, Mistake::condition);
    else if (!is_condition(text))
      t.problem(key, msg("'{}' is a number, not a condition", key),
                msg("compare it with something, for example \"target_removed_percent >= 90\""),
                Mistake::condition);
  } catch (const ExpressionError& e) {
    t.problem(key, msg("'{}' cannot be read ({})", key, e.problem),
              msg("write for example \"target_removed_percent >= 90 && depth_mm < 5\""),
              Mistake::condition);
  }
}

}  // namespace

bool good_id(const std::string& id) {
  return !id.empty() && std::all_of(id.begin(), id.end(), [](unsigned char c) {
    return std::islower(c) != 0 || std::isdigit(c) != 0 || c == '_' || c == '-';
  });
}

std::string read_id(CheckedTable& t, const std::string& fallback) {
  std::string id = t.text("id", fallback, true);
  if (!id.empty() && !good_id(id))
    t.problem("id", msg("'id' is \"{}\"", id), msg("use small letters, digits, _ and -"),
              Mistake::bad_name);
  return id;
}

std::vector<StepSpec> read_steps(CheckedTable& scenario, Places& places, ProblemList& problems) {
  std::vector<StepSpec> steps;
  for (const auto* table : scenario.tables("steps", true)) {
    CheckedTable t(*table, "[[steps]]", problems);
    StepSpec s;
    const std::string at = fmt::format("steps/{}", steps.size());
    s.id = read_id(t, "");
    s.instruction = t.text("instruction", "", true);
    s.complete_when = t.text("complete_when", "", true);
    check_condition(t, "complete_when", s.complete_when);
    t.note(places, "complete_when", at + "/complete_when");
    s.fail_when = t.text("fail_when", "");
    check_condition(t, "fail_when", s.fail_when);
    t.note(places, "fail_when", at + "/fail_when");
    t.note(places, "time_limit_s", at + "/time_limit_s");
    if (t.has("time_limit_s"))
      s.time_limit_s = t.number("time_limit_s", 0.001, 36000, 60);
    else
      t.number("time_limit_s", 0, 0, 0);
    s.failure_ends_exam = t.truth("failure_ends_exam", false);
    t.finish();
    for (const auto& other : steps)
      if (other.id == s.id && !s.id.empty())
        t.problem("id", msg("two steps are called '{}'", s.id), msg("give each its own id"),
                  Mistake::duplicate);
    steps.push_back(std::move(s));
  }
  return steps;
}

void check_pause_button(const Scenario& s, ProblemList& problems) {
  if (s.pauses.count == 0) return;
  const std::string button = fmt::format("button_{}", s.pauses.button);
  for (std::size_t i = 0; i < s.steps.size(); ++i)
    for (const auto& [key, text] : {std::pair("complete_when", s.steps[i].complete_when),
                                    std::pair("fail_when", s.steps[i].fail_when)}) {
      std::vector<std::string> used;
      try {
        if (!text.empty()) used = names_in_expression(text);
      } catch (const ExpressionError&) {
        continue;  // named already
      }
      if (std::find(used.begin(), used.end(), button) == used.end()) continue;
      const Place at = s.places.at(fmt::format("steps/{}/{}", i, key));
      problems.add(at, msg("'{}' asks for {}, which begins and ends pauses", key, button),
                   msg("use the other button, or set 'button' of [pauses]"),
                   Mistake::contradictory);
    }
}

}  // namespace cavum::scenarios
