#include "grading/records/makeup.h"

#include <algorithm>

#include "grading/records/issue.h"
#include "grading/records/ledger_error.h"
#include "grading/records/reason.h"

namespace cavum::records {

std::vector<FirstSitting> makeup_reasons(const Registry& registry, const IssuedTicket& first,
                                         std::int64_t now, Message& why_not) {
  const auto no = [&](Message why) {
    why_not = std::move(why);
    return std::vector<FirstSitting>();
  };
  if (first.made_up_by) return no(msg("has a makeup already (entry {})", *first.made_up_by));
  if (first.cancelled_by && first.begins.empty())
    return no(msg("was cancelled before it was begun: issue a new ticket"));
  if (now < first.ticket.not_before_utc_ns)
    return no(msg("is for a sitting that is still to come"));
  for (const auto& s : registry.sessions)
    if (s.nonce == first.ticket.nonce && s.shown_seq != 0)
      return no(msg("has a released result (entry {}): take it back first", s.shown_seq));
  std::vector<FirstSitting> out;
  if (now > first.ticket.not_after_utc_ns && !first.used_by && first.begins.empty())
    out.push_back(FirstSitting::missed);
  out.push_back(FirstSitting::interrupted);
  return out;
}

std::string issue_makeup(Ledger& ledger, Ticket ticket, const MakeupWish& wish) {
  require_reason(wish.reason);
  std::string text;
  ledger.append(
      [&](const LedgerContent&) {
        const Registry& registry = ledger.registry();  // as it is under the lock
        const Message where = msg("the ticket of entry {}", wish.first);
        const IssuedTicket* first = registry.ticket(wish.first);
        if (first == nullptr)
          throw Error(LedgerError::unknown, where, msg("is none"),
                      msg("look at the list of tickets again"));
        if (first->ticket.exam != ticket.exam)
          throw Error(where, msg("is of another exam"), msg("a makeup is of the same exam"));
        Message why_not;
        const std::int64_t now = read_clocks().utc_ns;
        const auto may = makeup_reasons(registry, *first, now, why_not);
        if (std::find(may.begin(), may.end(), wish.became) == may.end())
          throw Error(
              LedgerError::not_now, where,
              may.empty() ? why_not : msg("was not missed: it was begun, or its time is not over"),
              msg("look at the list of tickets again"));
        for (const auto& t : registry.tickets)
          if (t.seq != first->seq && t.ticket.candidate == first->ticket.candidate &&
              t.ticket.exam == ticket.exam && t.live(now))
            throw AnotherTicket(msg("candidate {}", first->ticket.candidate),
                                msg("has another ticket that is good (entry {})", t.seq),
                                msg("cancel that one first"));
        ticket.candidate = first->ticket.candidate;
        ticket.nonce = random_hex(16);
        SignedTicket signed_ticket = sign_ticket(std::move(ticket), ledger.key());
        text = std::move(signed_ticket.text);
        return TicketEntry{std::move(signed_ticket.ticket), std::move(signed_ticket.signature),
                           MakesUp{wish.first, wish.became}};
      },
      wish.reason);
  return text;
}

}  // namespace cavum::records
