#include "scenarios/file/rubric_check.h"

#include <algorithm>
#include <stdexcept>

#include "engine/base/text.h"
#include "engine/tooth/adjacent.h"
#include "scenarios/file/checked_toml.h"
#include "scenarios/file/measures.h"

namespace cavum::scenarios {
namespace {

Problem problem_of(const RubricSpec& rubric, Place at, const Message& what,
                   const Message& what_to_do, Mistake mistake) {
  return {{rubric.path, at.line, at.column}, what, what_to_do, false, mistake};
}

bool any_of(const TissueSet& set) {
  return std::any_of(set.begin(), set.end(), [](bool in) { return in; });
}

/// What a measure needs and this exam lacks; empty when nothing.
Message lacking(Needs needs, const Scenario& s, const Tooth& tooth) {
  const MarginSpec &leeway = s.zones.leeway, &container = s.zones.container;
  const bool sides = container.sides_mm > leeway.sides_mm,
             bottom = container.bottom_mm > leeway.bottom_mm;
  switch (needs) {
    case Needs::nothing:
      return {};
    case Needs::protection:
      return s.zones.protected_shapes.empty() ? msg("nothing is protected") : Message();
    case Needs::leeway_sides:
      return leeway.sides_mm > 0 ? Message() : msg("there is no leeway at the sides");
    case Needs::leeway_bottom:
      return leeway.bottom_mm > 0 ? Message() : msg("there is no leeway below");
    case Needs::container_sides:
      return sides ? Message() : msg("there is no container at the sides");
    case Needs::container_bottom:
      return bottom ? Message() : msg("there is no container below");
    case Needs::container:
      return sides || bottom ? Message() : msg("there is no container");
    case Needs::aim:
      return s.perforation.aims.empty() ? msg("no tissue is an aim") : Message();
    case Needs::fault:
      return s.perforation.faults.empty() ? msg("no tissue is a fault") : Message();
    case Needs::force_limit:
      return s.force_limit_n > 0 ? Message() : msg("there is no force limit");
    case Needs::pulp:
      return any_of(tissues_of(tooth, TissueKind::pulp)) ? Message() : msg("the tooth has no pulp");
    case Needs::neighbour:
      return any_of(tissues_of(tooth, TissueKind::neighbour))
                 ? Message()
                 : msg("no tooth stands beside this one");
    case Needs::gum:
      return any_of(tissues_of(tooth, TissueKind::gum)) ? Message() : msg("the tooth has no gum");
  }
  throw std::logic_error("rubric_check: a need that nothing is said of");
}

}  // namespace

std::vector<Problem> not_in_this_exam(const RubricSpec& rubric, const Scenario& scenario,
                                      const Tooth& tooth) {
  std::vector<std::string> known;
  for (const auto& t : tooth.tissues) known.push_back(tissue_measure(t.name).name);
  std::vector<Problem> problems;
  for (const auto& c : rubric.criteria) {
    const Measure measure = known_measure(c.metric);
    if (!measure.tissue.empty() && std::find(known.begin(), known.end(), c.metric) == known.end())
      problems.push_back(problem_of(rubric, c.metric_at,
                                    msg("'{}' measures no tissue of this tooth", c.metric),
                                    suggestion(c.metric, known), Mistake::unknown_tissue));
    if (const Message what = lacking(measure.needs, scenario, tooth); !what.empty())
      problems.push_back(problem_of(
          rubric, c.metric_at, msg("'{}' measures nothing in this exam: {}", c.metric, what),
          msg("take the criterion out, or choose a measure of what there is"),
          Mistake::unknown_measure));
  }
  return problems;
}

std::vector<Problem> turned_round(const RubricSpec& rubric) {
  std::vector<Problem> problems;
  for (const auto& c : rubric.criteria) {
    const Better better = known_measure(c.metric).better;
    if (better == Better::by_task || c.full == c.zero ||
        (c.full > c.zero) == (better == Better::more))
      continue;
    problems.push_back(problem_of(
        rubric, c.zero_at,
        better == Better::more
            ? msg("the criterion gives full marks at {} and none at {}, but more of '{}' is better",
                  as_number(c.full), as_number(c.zero), c.metric)
            : msg("the criterion gives full marks at {} and none at {}, but less of '{}' is better",
                  as_number(c.full), as_number(c.zero), c.metric),
        msg("exchange 'full' and 'zero'"), Mistake::contradictory));
    problems.back().warning = true;
  }
  return problems;
}

std::vector<Problem> charged_twice(const RubricSpec& rubric) {
  std::vector<Problem> problems;
  const auto names = [](const CriterionSpec& c, const std::string& id) {
    return std::find(c.shares_with.begin(), c.shares_with.end(), id) != c.shares_with.end();
  };
  for (std::size_t i = 0; i < rubric.criteria.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const CriterionSpec &first = rubric.criteria[j], &second = rubric.criteria[i];
      if (!(first.points > 0) || !(second.points > 0) || names(first, second.id) ||
          names(second, first.id))
        continue;
      const unsigned both =
          known_measure(first.metric).counts & known_measure(second.metric).counts;
      if (both == 0) continue;
      problems.push_back(problem_of(
          rubric, second.metric_at,
          msg("'{}' charges what '{}' charges, too: {} and {} both count {}", second.id, first.id,
              second.metric, first.metric, counts_text(both)),
          msg("take one of them out, or say that it is meant: shares_with = [\"{}\"]", first.id),
          Mistake::contradictory));
      problems.back().warning = true;
    }
  return problems;
}

}  // namespace cavum::scenarios
