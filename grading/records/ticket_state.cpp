#include "grading/records/ticket_state.h"

#include <array>

namespace cavum::records {
namespace {

/// Of the ticket alone.
TicketState own_state(const IssuedTicket& t, std::int64_t now) {
  if (t.used_by) return {TicketStatus::filed, msg("filed, entry {}", *t.used_by)};
  if (t.cancelled_by) return {TicketStatus::cancelled, msg("cancelled, entry {}", *t.cancelled_by)};
  if (!t.begins.empty()) return {TicketStatus::begun, msg("begun, entry {}", t.begins.back().seq)};
  if (now > t.ticket.not_after_utc_ns) return {TicketStatus::run_out, msg("run out")};
  return {TicketStatus::live, now < t.ticket.not_before_utc_ns ? msg("not yet") : msg("live")};
}

}  // namespace

std::string_view name_of(TicketStatus group) noexcept {
  constexpr std::array<std::string_view, 6> names{"live",  "begun",     "run out",
                                                  "filed", "cancelled", "made up"};
  return names[static_cast<std::size_t>(group)];
}

TicketState state_of(const IssuedTicket& t, std::int64_t now_utc_ns) {
  TicketState state = own_state(t, now_utc_ns);
  if (t.makes_up)
    state.words =
        t.makes_up->became == FirstSitting::missed
            ? msg("{}; makeup of entry {}, which was missed", state.words, t.makes_up->ticket)
            : msg("{}; makeup of entry {}, which was interrupted", state.words, t.makes_up->ticket);
  if (t.made_up_by) {
    const bool open = state.group == TicketStatus::live ||
                      state.group == TicketStatus::run_out;  // it is neither any more
    state = {TicketStatus::made_up,
             open ? msg("made up by entry {}", *t.made_up_by)
                  : msg("{}; made up by entry {}", state.words, *t.made_up_by)};
  }
  return state;
}

}  // namespace cavum::records
