// Issuing tickets: what one promises of an exam that was made ready, its entry in the ledger, and
// seats.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "grading/records/class_list.h"
#include "grading/records/identities.h"
#include "grading/records/ledger.h"
#include "grading/records/ticket.h"
#include "scenarios/exam/exam.h"

namespace cavum::records {

/// A ticket for this exam as it was made ready, without candidate and number.
[[nodiscard]] Ticket promise(const scenarios::ExamSetup& setup, const LedgerContent& ledger,
                             std::int64_t not_before_utc_ns, std::int64_t not_after_utc_ns);
/// Thrown by issue(): the candidate has a ticket for the exam already, or has sat it.
class AnotherTicket : public Error {
 public:
  using Error::Error;
};
/// Does a candidate get a second ticket for an exam?
enum class Another { refuse, allow };
/// Gives it to a candidate under a number of its own, and enters it. Returns its signed text.
/// Throws AnotherTicket when the candidate has one for the exam that is still good (live_ticket),
/// or a session of it is filed (of several attempts the last one that is released counts, so a
/// second one may take the place of a released result), unless `another` allows it.
[[nodiscard]] std::string issue(Ledger& ledger, Ticket ticket, const std::string& candidate,
                                Another another = Another::refuse);
/// Enters that the ticket of entry `seq` does not count. Throws Error when it is no ticket's entry,
/// was used or cancelled before, or `reason` is no line of text.
const LedgerEntry& cancel_ticket(Ledger& ledger, std::uint64_t seq, const std::string& reason);

/// Enters seats, all in one entry. Throws Error when one is of no ticket that is good, at no
/// station that is enrolled, or at one where another candidate is to sit at that time.
const LedgerEntry& seat_candidates(Ledger& ledger, const std::vector<Seat>& seats);

/// A time within which exams begin: of a ticket, or of a sitting.
struct TimeSpan {
  std::int64_t from_utc_ns = 0, until_utc_ns = 0;
};
/// The keys of the stations that a list names, in its order; empty where it names none. With
/// `when`, one for each, also none where somebody else is to sit then. Throws ListMistakes for
/// names of no station or of several, and seats that are taken: up to 20 at once, each with its
/// line.
[[nodiscard]] std::vector<std::string> stations_of(const Registry& registry, Identities& identities,
                                                   const std::vector<Person>& people,
                                                   const std::vector<TimeSpan>& when,
                                                   const std::string& where);
/// The ticket of another candidate, good at this time or later, whose seat is this station within a
/// time that meets `when`; null: none.
[[nodiscard]] const IssuedTicket* seated_there(const Registry& registry, const std::string& station,
                                               const TimeSpan& when, std::uint64_t but_ticket,
                                               std::int64_t now_utc_ns);

/// Tickets for a list.
struct ListCommand {
  Ticket ticket;                   ///< as it was promised
  std::vector<Person> people;      ///< all of the list
  std::vector<TimeSpan> times;     ///< of each
  std::string where;               ///< the list, for mistakes
  std::size_t first = 0, end = 0;  ///< who of the list gets one now
  scenarios::Grant grant = {};     ///< for all; what is granted to one of them goes before
  Another another = Another::refuse;
};
struct Issued {
  Person person;
  std::string candidate;               ///< pseudonym
  Ticket ticket;                       ///< with its accommodations
  std::optional<std::uint64_t> entry;  ///< none: refused
  std::optional<AnotherTicket> refused;
};
/// Is told each ticket's text as soon as it is entered.
using KeepTicket = std::function<void(const Issued& issued, const std::string& text)>;
/// Issues them one after the other, then enters the seats that the list names. Who has a ticket
/// already, or has sat, is refused, and the others get theirs. Throws as stations_of().
[[nodiscard]] std::vector<Issued> issue_list(Ledger& ledger, Identities& identities,
                                             const ListCommand& wish, const KeepTicket& keep);

}  // namespace cavum::records
