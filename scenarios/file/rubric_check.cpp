#include "scenarios/file/rubric_check.h"

#include <algorithm>

#include "engine/base/text.h"
#include "scenarios/file/checked_toml.h"
#include "scenarios/file/names.h"

namespace cavum {
namespace {

Problem problem_of(const RubricSpec& rubric, Place at, const std::string& what, const std::string& what_to_do) {
  return {rubric.path + ":" + std::to_string(at.line) + ":" + std::to_string(at.column), what, what_to_do, at.line, at.column};
}

/// What a measure needs and this exam lacks; empty when nothing.
std::string lacking(const std::string& metric, const Scenario& s) {
  const auto is = [&](std::initializer_list<const char*> names) { return std::find(names.begin(), names.end(), metric) != names.end(); };
  const MarginSpec &leeway = s.zones.leeway, &container = s.zones.container;
  if (is({"protected_mm3"}) && s.zones.protected_shapes.empty()) return "nothing is protected";
  if (is({"leeway_sides_mm3"}) && !(leeway.sides_mm > 0)) return "there is no leeway at the sides";
  if (is({"leeway_bottom_mm3"}) && !(leeway.bottom_mm > 0)) return "there is no leeway below";
  const bool sides = container.sides_mm > leeway.sides_mm, bottom = container.bottom_mm > leeway.bottom_mm;
  if (is({"container_sides_mm3"}) && !sides) return "there is no container at the sides";
  if (is({"container_bottom_mm3"}) && !bottom) return "there is no container below";
  if (is({"container_mm3"}) && !sides && !bottom) return "there is no container";
  if (is({"overhang_mm3", "canals_covered_percent"}) && s.perforation.aims.empty()) return "no tissue is an aim";
  if (is({"perforated", "perforation_volume_mm3"}) && s.perforation.faults.empty()) return "no tissue is a fault";
  if (is({"force_over_limit_s"}) && !(s.force_limit_n > 0)) return "there is no force limit";
  return "";
}

}  // namespace

std::vector<Problem> not_in_this_exam(const RubricSpec& rubric, const Scenario& scenario, const Tooth& tooth) {
  std::vector<std::string> known;
  for (const auto& t : tooth.tissues) known.push_back("touched_" + t.name + "_mm3");
  std::vector<Problem> problems;
  for (const auto& c : rubric.criteria) {
    if (c.metric.starts_with("touched_") && std::find(known.begin(), known.end(), c.metric) == known.end())
      problems.push_back(problem_of(rubric, c.metric_at, "'" + c.metric + "' measures no tissue of this tooth", suggestion(c.metric, known)));
    if (const std::string what = lacking(c.metric, scenario); !what.empty())
      problems.push_back(problem_of(rubric, c.metric_at, "'" + c.metric + "' measures nothing in this exam: " + what,
                                    "take the criterion out, or choose a measure of what there is"));
  }
  return problems;
}

std::vector<Problem> turned_round(const RubricSpec& rubric) {
  std::vector<Problem> problems;
  for (const auto& c : rubric.criteria) {
    const int better = better_direction(c.metric);
    if (better == 0 || c.full == c.zero || (c.full > c.zero) == (better > 0)) continue;
    problems.push_back(problem_of(rubric, c.zero_at,
                                  "the criterion gives full marks at " + plain_number(c.full) + " and none at " + plain_number(c.zero) + ", but " +
                                      (better > 0 ? "more" : "less") + " of '" + c.metric + "' is better",
                                  "exchange 'full' and 'zero'"));
    problems.back().warning = true;
  }
  return problems;
}

}  // namespace cavum
