// A makeup sitting: another ticket for a candidate who missed his exam, or whose exam was
// interrupted. The first sitting stays on record with what became of it and why; from then on the
// makeup counts in its place, and never both.
#pragma once

#include <string>
#include <vector>

#include "grading/records/ledger.h"
#include "grading/records/ticket.h"

namespace cavum::records {

/// Which of the two may be said of a ticket now; none: it gets no makeup. `why_not` receives the
/// reason, in words.
[[nodiscard]] std::vector<FirstSitting> makeup_reasons(const Registry& registry,
                                                       const IssuedTicket& first,
                                                       std::int64_t now_utc_ns, Message& why_not);

struct MakeupWish {
  std::uint64_t first = 0;  ///< entry of the ticket of the first sitting
  FirstSitting became = FirstSitting::missed;
  std::string reason;  ///< one line, kept for ever
};
/// Issues `ticket` (without candidate and number) as the makeup of another. Returns its signed
/// text. Throws Error when the first gets none, or AnotherTicket when the candidate has a further
/// good ticket for the exam.
[[nodiscard]] std::string issue_makeup(Ledger& ledger, Ticket ticket, const MakeupWish& wish);

}  // namespace cavum::records
