// Scores for the gradebook of a learning platform (LTI Assignment and Grade Services 2.0): what
// each candidate's score is by what was released, what was sent before, and what is due. Each score
// that a platform has answered is an entry. The entry names the result and not the points, so that
// an erased result is gone from here, too.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "grading/records/exported_grade.h"
#include "grading/records/identities.h"
#include "grading/records/ledger.h"
#include "grading/records/registry.h"

namespace cavum::records {

/// A score that is due in one column of a gradebook.
struct ScoreDue {
  std::uint64_t session = 0;  ///< entry of the session that counts, or whose score is taken back
  std::uint64_t result = 0;   ///< entry of the result; 0: there is none any more, and the platform
                              ///< is to clear its score
  std::string id;             ///< the school's own number of the candidate
  nlohmann::json score;       ///< as AGS wants it, without `userId`
};

/// Of the candidates of `exam`, whoever has a released result, or had one that was sent to this
/// column and was taken back since; what was answered before, with the same result, is left out,
/// and with `again` only what was accepted. Simulated operators are left out. A result that waits
/// for a person's decision has no points here, even where it was released as it is.
[[nodiscard]] std::vector<ScoreDue> scores_due(const LedgerContent& content,
                                               const Registry& registry, Identities& identities,
                                               const std::string& exam,
                                               const std::string& line_item, Wording say,
                                               bool again = false);

/// Enters what a platform has answered: `status` of HTTP, and its words, one line.
const LedgerEntry& enter_passback(Ledger& ledger, const ScoreDue& sent, const std::string& platform,
                                  const std::string& line_item, int status,
                                  const std::string& answer);

}  // namespace cavum::records
