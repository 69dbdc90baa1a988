// The ledger's word that an exam may begin: a number drawn at that moment by the ledger's own
// clock. A recording that bears it was made afterwards, whatever its station's clock says, and of a
// ticket only the recording with the last such word is sound: an exam that was begun at two
// stations is seen.
#pragma once

#include <string>

#include "engine/base/where.h"
#include "grading/records/ledger.h"
#include "grading/records/ticket.h"

namespace cavum::records {

/// Note of a session that holds the word it was begun with.
inline constexpr char k_begin_note[] = "begin";

/// The word, one line of JSON {"begin","signature"}.
[[nodiscard]] std::string begin_text(const BeginEntry& entry);
/// Throws Error(`where`, ...) when the signature does not hold. `public_key`: as parse_ticket().
void require_signed(const Begin& begin, const std::string& signature, const std::string& public_key,
                    const Where& where);
/// Throws Error(`where`, ...) when the text is none or its signature does not hold.
[[nodiscard]] Begin parse_begin(const std::string& text, const std::string& public_key,
                                const Where& where);
/// Enters that the exam of a ticket's number may begin, and returns the word. Throws Error when the
/// ledger has not issued the ticket, it was cancelled or used, this is not its time, or it was
/// begun before and `again` gives no reason.
[[nodiscard]] std::string let_begin(Ledger& ledger, const std::string& ticket_nonce,
                                    const std::string& again);
/// Where the word lies for a station: beside the ticket, NAME.begin for NAME.ticket.
[[nodiscard]] std::string begin_path(const std::string& ticket_path);

}  // namespace cavum::records
