// A new rubric, or a corrected scenario, over all of an exam: who is marked anew, what would come
// of it, and all of it entered at once or nothing.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "grading/pool/work.h"
#include "grading/records/regrade.h"

namespace cavum::records {

/// One session of the exam.
struct MarkedAgain {
  std::uint64_t session = 0,
                result_seq = 0;  ///< its entry, and the entry of the result that counts
  std::string candidate, file_sha256;
  bool decided = false;  ///< a person has decided the result that counts
  bool shown = false;    ///< one of its results is released
  SharedJson before;     ///< the result that counts
  nlohmann::json after;  ///< by the basis; null until it is marked
  [[nodiscard]] bool other_verdict() const;
  [[nodiscard]] bool other_points() const;
};
struct ClassRegrade {
  std::string exam;
  RegradeBasis basis;
  std::vector<MarkedAgain> sessions;  ///< in the order of their entries
  std::size_t left_out = 0;           ///< whose recording or result is erased
};
/// Who would be marked anew. Throws Error when the exam has no session that can be marked.
[[nodiscard]] ClassRegrade plan_class_regrade(const Registry& registry, const std::string& exam,
                                              RegradeBasis basis);
/// What is to be made for it of the sessions in the ledger's folder, line by line in the plan's
/// order.
[[nodiscard]] pool::Work work_of(const ClassRegrade& plan, const std::string& ledger_folder);
/// Takes the lines that were made. Throws Error for the first that could not be, or that is of
/// other bytes than were filed.
void take_lines(ClassRegrade& plan, const std::vector<std::string>& lines,
                const std::string& ledger_folder);
/// Enters all results in one transaction: all of them count from then on, or none. A session that
/// was marked anew by the same before is left as it is. Returns how many were entered; they are the
/// ledger's last. Throws Error when the exam has other sessions or results by now than the plan.
std::size_t enter_class_regrade(Ledger& ledger, const ClassRegrade& plan,
                                const std::string& reason);

}  // namespace cavum::records
