// A ticket is the school's promise of one exam to one candidate: this scenario, tooth and rubric,
// these accommodations, within this time, once. The station reads it before the exam and keeps it
// in the session; the ledger checks it again and takes each ticket only once.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/where.h"
#include "engine/session/session.h"
#include "engine/session/station_key.h"
#include "grading/records/finding.h"

namespace cavum::records {

/// Note of a session that holds its ticket's text.
inline constexpr char k_ticket_note[] = "ticket";

struct Ticket {
  std::string ledger;     ///< id of the ledger that issued it
  std::string exam;       ///< id of the scenario
  std::string candidate;  ///< pseudonym
  std::string nonce;      ///< 32 hexadecimal digits, of this ticket alone
  std::int64_t not_before_utc_ns = 0, not_after_utc_ns = 0;
  std::map<std::string, std::string>
      artifacts;  ///< SHA-256 (hexadecimal) by name of all that is examined: scenario, tooth,
                  ///< rubric, burs, force model
  std::vector<std::pair<std::string, std::string>>
      grant;  ///< accommodations as notes of the session (scenarios/file/accommodations.h)
  std::string grant_sha256;      ///< of the opening that holds them, hexadecimal; set on signing
  bool begun_at_ledger = false;  ///< the exam begins only when the ledger lets it (begin.h)
  std::string public_key;        ///< of the school, hexadecimal
};

/// What a ticket fixes of a session: all its artifacts but the servo's settings, which are the
/// device's.
[[nodiscard]] std::map<std::string, std::string> examined_artifacts(const SessionSetup& setup);

/// The notes of a session that grant something to its candidate, sorted.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> accommodations_in(
    const SessionSetup& setup);

struct SignedTicket {
  Ticket ticket;
  std::string signature;  ///< hexadecimal, over "CVTICKET" and the text of `ticket`, keys in order
  std::string text;       ///< the ticket's file, one line of JSON {"grant", "signature", "ticket"}
};
/// `grant` is the opening of the accommodations: they stand with the candidate and in the
/// recording, and the ledger knows their hash alone.
[[nodiscard]] SignedTicket sign_ticket(Ticket ticket, const SigningKey& school);
/// Throws Error(`where`, ...) when the signature does not hold. `public_key` (hexadecimal): the
/// school's; empty = whoever signed.
void require_signed(const Ticket& ticket, const std::string& signature,
                    const std::string& public_key, const Where& where);
/// Throws Error(`where`, ...) when the text is no ticket or its signature does not hold.
[[nodiscard]] Ticket parse_ticket(const std::string& text, const std::string& public_key,
                                  const Where& where);

/// What about the exam is not as promised: another candidate, another scenario, tooth or rubric,
/// other accommodations, or begun outside its time.
[[nodiscard]] Findings check_ticket(const Ticket& ticket, const SessionSetup& setup,
                                    std::int64_t begun_utc_ns);

/// "2026-11-21T09:00Z" or "2026-11-21T09:00:00Z" in ns since 1970; throws Error(`where`, ...).
[[nodiscard]] std::int64_t parse_utc(const std::string& text, const Where& where);

}  // namespace cavum::records
