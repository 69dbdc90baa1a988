// Small true things that the targets start from: a tooth of a few leaves, a session of some ticks
// drilled into it, a school with one ticket.
#pragma once

#include <string>

#include "engine/session/session.h"
#include "engine/session/session_reader.h"
#include "engine/tooth/tooth.h"
#include "grading/records/ledger.h"
#include "grading/records/ticket.h"

namespace cavum::fuzz {

/// 0.8 x 0.8 x 0.8 mm of enamel over dentin over pulp, leaf 0.1 mm.
[[nodiscard]] Tooth small_tooth();
[[nodiscard]] SessionSetup small_setup();
/// Bytes of a closed session: two chunks, five events, a ticket among its notes. Made once.
[[nodiscard]] const Bytes& small_session();
/// Reads the ticks of each second by itself, then all that was removed. Throws Error when the
/// session is damaged.
void read_all_ticks(const SessionReader& session);
/// The station that closed it.
[[nodiscard]] const SigningKey& station_key();
/// The school that issued the ticket, and what its ledger holds.
[[nodiscard]] const SigningKey& school_key();
[[nodiscard]] const records::LedgerContent& school_ledger();
[[nodiscard]] const std::string& small_ticket();
[[nodiscard]] const records::SignedTicket& signed_ticket();
/// A result as grading writes it, with two criteria.
[[nodiscard]] std::string small_result();
/// A folder in memory (/dev/shm, else the usual one for temporary files) that goes with the
/// process.
[[nodiscard]] const std::string& work_folder();
/// A file that ships, below data/.
[[nodiscard]] std::string data_text(const std::string& name);

[[nodiscard]] inline Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }
[[nodiscard]] inline std::string text_of(std::span<const std::uint8_t> data) {
  return {data.begin(), data.end()};
}

}  // namespace cavum::fuzz
