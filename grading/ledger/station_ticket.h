// What a station does with a ticket: reads it, lets it say who sits the exam and with which accommodations, and begins nothing that was not promised.
#pragma once

#include <string>

#include "grading/ledger/ticket.h"
#include "scenarios/exam.h"

namespace cavum {

struct HeldTicket {
  Ticket ticket;
  std::string text;  ///< as signed, for the session
  std::string path;
};

/// Throws Error when the file is no ticket, was changed, or is not of the school in school_public_key_path(), or this station knows no school.
[[nodiscard]] HeldTicket read_ticket(const std::string& path);
/// Candidate and accommodations are the ticket's, and the session will hold it. Throws Error when `options` names another candidate or grants
/// anything itself.
void use_ticket(const HeldTicket& held, ExamOptions& options);
/// Throws Error, all reasons in it, when what was prepared is not what the ticket promises, or this is not its time.
void require_promised(const HeldTicket& held, const SessionSetup& setup);

}  // namespace cavum
