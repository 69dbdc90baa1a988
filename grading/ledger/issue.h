// Issuing tickets: what one promises of an exam that was made ready, its entry in the ledger, and the list of those who get one.
#pragma once

#include <string>
#include <vector>

#include "grading/ledger/ledger.h"
#include "grading/ledger/ticket.h"
#include "scenarios/exam.h"

namespace cavum {

/// A ticket for this exam as it was made ready, without candidate and number.
[[nodiscard]] Ticket promise(const ExamSetup& setup, const LedgerContent& ledger, std::int64_t not_before_utc_ns, std::int64_t not_after_utc_ns);
/// Gives it to a candidate under a number of its own, and enters it. Returns its signed text.
[[nodiscard]] std::string issue(Ledger& ledger, Ticket ticket, const std::string& candidate);

struct Person {
  std::string id;    ///< how the school's other systems name the candidate
  std::string name;  ///< for people; may be empty
};
/// A table (CSV) with a column `id` and, if wanted, `name`; others are passed over. Throws Error(where:line, ...) for one without ids or with one
/// twice.
[[nodiscard]] std::vector<Person> parse_people(const std::string& text, const std::string& where);

}  // namespace cavum
