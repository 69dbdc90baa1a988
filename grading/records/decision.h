// What the program leaves to a person: results whose verdict is `review`. A person decides each
// one; the decision is an entry of its own, a new result beside the one that it decides, and waits
// for its release as a regrade does.
#pragma once

#include <string>
#include <vector>

#include "engine/base/fact.h"
#include "grading/records/ledger.h"
#include "grading/records/registry.h"
#include "grading/result/result.h"

namespace cavum::records {

/// One that waits for a person.
struct ToDecide {
  std::uint64_t session = 0;  ///< its entry
  std::string candidate, scenario_id;
  double points = 0.0, max = 0.0;
  Facts reasons;  ///< why the program does not decide, both opinions where force and tissue differ
};
/// In the order of the ledger. One of several endings of an exam that was not chosen is left out.
[[nodiscard]] std::vector<ToDecide> review_queue(const Registry& registry);

/// Who decides, in at most this many bytes.
inline constexpr std::size_t k_longest_person = 200;
struct Decision {
  grading::Verdict verdict = grading::Verdict::fail;  ///< pass or fail
  std::string person;                                 ///< who decides: one line, kept for ever
  std::string reason;                                 ///< why: one line, kept for ever
};
/// Throws Error for another word than pass or fail.
[[nodiscard]] grading::Verdict decided_verdict(const std::string& word);
/// Enters the decision on the result that counts of the session of entry `session`. Throws Error
/// when that is not `review` (any more) and no appeal against it is open, a makeup sitting counts
/// in its place, or a text is empty, too long or no plain line.
const LedgerEntry& enter_decision(Ledger& ledger, std::uint64_t session, const Decision& decision);

/// The verdict that the program gave to the result in `entry`, below all that persons decided on it
/// since it was marked; empty without a result.
[[nodiscard]] std::string verdict_by_program(const FiledSession& session, std::uint64_t entry);

}  // namespace cavum::records
