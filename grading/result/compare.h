// Regrading and appeal: a new result beside the one that a session was sealed with, criterion by
// criterion, and what made the difference. The old result is read from the session and never
// written to.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/lines.h"
#include "grading/result/result.h"
#include "scenarios/file/scenario.h"

namespace cavum::grading {

/// What a sealed result says, as far as an appeal needs it.
struct OldCriterion {
  std::string id;
  std::optional<double> value;
  double points = 0.0, max = 0.0;
};
struct OldResult {
  std::string verdict;
  double points = 0.0, max = 0.0;
  std::vector<OldCriterion> criteria;
};
/// None when there is no result in it.
[[nodiscard]] std::optional<OldResult> read_old_result(const std::string& json_text);

/// What differs between a sealed result and a new one, or between their rubrics.
enum class ChangeKind : std::uint8_t {
  metric,
  full,
  zero,
  points,
  band_limits,
  critical_above,
  critical_below,
  value,
  added,             ///< a new criterion
  dropped,           ///< no longer one
  other_scenario,    ///< measured against the new one
  sealed_otherwise,  ///< the sealed figure is not what grading gives
  work_share,        ///< another share of the work counts as done
  pass_percent,
  open_step,     ///< whether an exam whose last step is open may pass
  within_bound,  ///< whether a verdict that bounds leave open stands
  borderline_percent,
  rule,
  bands
};
struct Change {
  ChangeKind kind{};
  std::optional<Value> from = {}, to = {};  ///< both or neither
  [[nodiscard]] Message message() const;
};
using Changes = std::vector<Change>;

struct CriterionChange {
  std::string id, unit;
  std::optional<double> old_points, old_max, old_value, new_points, new_max, new_value;
  Changes why;  ///< empty when nothing changed
  [[nodiscard]] double difference() const {
    return new_points.value_or(0) - old_points.value_or(0);
  }
};

struct Comparison {
  /// What it was marked anew by: these files, or what the ledger keeps with an entry. None of them:
  /// this version of the program.
  std::string rubric, scenario;
  std::optional<std::uint64_t> entry;
  OldResult before;
  std::string verdict;
  double points = 0.0, max = 0.0;
  std::vector<CriterionChange> criteria;  ///< the new rubric's, then those that it has no longer
  Changes rules;                          ///< of pass mark, band and rule
  bool tampered = false;                  ///< the sealed result is not what grading gives
  /// Verdict or points are not those that the session was sealed with.
  [[nodiscard]] bool differs() const;
};

/// `again` is the session graded by this program with its own scenario and rubric: what differs
/// between it and the sealed result comes from the program, the rest from the new rubric or
/// scenario.
[[nodiscard]] Comparison compare(const OldResult& sealed, const Result& again,
                                 const scenarios::RubricSpec& old_rubric, const Result& now,
                                 const scenarios::RubricSpec& new_rubric);

/// One sentence after the other.
[[nodiscard]] Message all_of(const Changes& changes);
/// "+1.5", "-0.3", "+0.0".
[[nodiscard]] Number signed_points(double difference);
/// Says that a result is a regrade, by what, and what the session was sealed with: one sentence.
[[nodiscard]] Message regrade_text(const Comparison& comparison);
/// {by{rubric,scenario,entry}, old{verdict,points,max}, new{verdict,points,max}, criteria[]{id,
/// old_points, old_max, old_value, new_points, new_max, new_value, unit, difference, changed[]},
/// rules[]}; a change is {kind, from, to, text}
[[nodiscard]] nlohmann::ordered_json to_json(const Comparison& comparison);
[[nodiscard]] Lines to_text(const Comparison& comparison);

}  // namespace cavum::grading
