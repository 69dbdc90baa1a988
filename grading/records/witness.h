// The witness of a ledger: a file outside the ledger's folder that remembers every checkpoint, so
// that a ledger which was put back to an older copy is found.
#pragma once

#include "grading/records/ledger_content.h"

namespace cavum::records {

/// $CAVUM_HOME/witness/ID, or below ~/.config/cavum: one line for each checkpoint, "size root
/// utc_ns signature", root in hexadecimal digits. The signature, in base64, is the one under the
/// checkpoint's note.
[[nodiscard]] std::string witness_path(const std::string& ledger_id);

/// What it remembers, the oldest first; nothing when this computer has none. A root that is none is
/// a finding; a line that a power cut left short is left out.
[[nodiscard]] std::vector<Checkpoint> read_witness(const std::string& ledger_id,
                                                   Findings& findings);
/// Holds room on the disk for so many lines, before entries are made that it is told of. Throws
/// DatabaseError when there is none.
void make_room_for_witness(const std::string& ledger_id, std::size_t lines);
/// Adds a line, synced. Throws Error when that cannot be done; the next entry tells it again.
void tell_witness(const std::string& ledger_id, const Checkpoint& checkpoint);

}  // namespace cavum::records
