// What can be said of a condition without running it: whether it is a condition at all, and whether
// it can come true at all. Reads the grammar of expression.h from the outside in.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "engine/base/message.h"

namespace cavum::scenarios {

/// Values that a live quantity can have.
struct ValueRange {
  double low = 0.0, high = 0.0;
};

enum class Outlook { never, perhaps, always };

/// False for an expression whose value is a number ("target_removed_percent"): the exam would take
/// any but 0 for yes. Quantities that are 0 or 1, and the numbers 0 and 1 themselves, are
/// conditions.
[[nodiscard]] bool is_condition(const std::string& text);

/// What a condition means otherwise than it reads, and what to write instead.
struct ConditionFault {
  enum class Kind : std::uint8_t { comma, chain, zero, zero_at_first };
  Kind kind = Kind::comma;
  Message what, what_to_do;
};
/// A chain of comparisons (0 < x < 10 compares yes or no with 10), a comma outside a function (only
/// what follows the last one would count), a division by 0 or by what is 0 when an exam begins.
/// None for a text without. The text must be one that Expression takes.
[[nodiscard]] std::optional<ConditionFault> condition_fault(const std::string& text);

/// Whether a condition can be true when each quantity keeps to its range. Judges comparisons of one
/// quantity with a number, joined by && and ||; everything else is `perhaps`.
[[nodiscard]] Outlook judge_condition(const std::string& text,
                                      const std::map<std::string, ValueRange>& ranges);

}  // namespace cavum::scenarios
