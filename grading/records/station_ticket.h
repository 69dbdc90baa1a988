// What a station does with a ticket: reads it, lets it say who sits the exam and with which
// accommodations, and begins nothing that was not promised.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "engine/session/resume.h"
#include "grading/records/ticket.h"
#include "scenarios/exam/exam.h"

namespace cavum::records {

struct HeldTicket {
  Ticket ticket;
  std::string text;  ///< as signed, for the session
  std::string path;
  std::string begin = {};  ///< the ledger's word to begin, as signed; empty without one
};

/// The key in school_public_key_path(), hexadecimal; empty when there is none. Throws Error when
/// that file holds no key.
[[nodiscard]] std::string station_school_key();

/// With the ledger's word to begin, when one lies beside it (begin_path). Throws Error when either
/// file is not what it should be, was changed, or is not of the school in school_public_key_path(),
/// or this station knows no school.
[[nodiscard]] HeldTicket read_ticket(const std::string& path);
/// Candidate and accommodations are the ticket's, and the session will hold it. Throws Error when
/// `options` names another candidate or grants anything itself.
void use_ticket(const HeldTicket& held, scenarios::ExamOptions& options);
/// Throws Error, all reasons in it, when what was prepared is not what the ticket promises, this is
/// not its time, or the ticket asks for the ledger's word to begin and there is none.
void require_promised(const HeldTicket& held, const SessionSetup& setup);

/// $CAVUM_HOME/used_tickets, or below ~/.config/cavum: a line for each exam that was begun here
/// with a ticket.
[[nodiscard]] std::string used_tickets_path();
/// Throws Error when an exam was begun on this station with the ticket: it goes on by resuming, and
/// is not begun again.
void require_unused(const HeldTicket& held);
/// Remembers that the exam recorded at `session` uses the ticket; throws Error as `require_unused`
/// does, and when nothing can be remembered. Before the exam begins: a station that is killed
/// between the two has used the ticket up rather than given it twice.
void remember_use(const HeldTicket& held, const std::string& session);
/// The exam could not be begun: the ticket is good as before.
void forget_use(const HeldTicket& held) noexcept;

/// Remembers that the exam of the ticket in these notes of a session was closed and sealed, or
/// nothing when they hold none.
void remember_closed(const std::vector<std::pair<std::string, std::string>>& notes,
                     const std::string& session) noexcept;
/// Throws Error when that exam was closed at this station: a copy that was left or cut back to
/// before its end is not taken up again. Returns whether this station remembers beginning it
/// (ResumedBy), true where there is no ticket.
[[nodiscard]] bool require_not_closed(const std::vector<std::pair<std::string, std::string>>& notes,
                                      const std::string& session);

/// What `begin` returns, with the ticket used up unless it throws. `held` may be null: nobody asked
/// for a ticket.
template <class Begin>
[[nodiscard]] auto begin_with_ticket(const HeldTicket* held, const std::string& session,
                                     const Begin& begin) {
  if (held == nullptr) return begin();
  remember_use(*held, session);
  try {
    return begin();
  } catch (...) {
    forget_use(*held);
    throw;
  }
}

}  // namespace cavum::records
