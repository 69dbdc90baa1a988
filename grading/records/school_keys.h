// The school's keys as the ledger names them. Each signs from the entry that introduces it on, and
// the one before it signs that entry's word, so that nobody without it can go on in its place. A
// key may run out: nothing is entered after that until another one took over.
#pragma once

#include <optional>
#include <string>

#include "grading/records/ledger_content.h"

namespace cavum::records {

class Ledger;

/// Reads `keys` and `public_key` from the entries; adds findings for a key that the one before it
/// has not signed, and for what was entered after a key ran out.
void read_school_keys(LedgerContent& content);
/// The key that an entry's text introduces in a ledger, when `present` (hexadecimal) has signed for
/// it; else nothing.
[[nodiscard]] std::optional<std::string> successor_named_by(const std::string& entry_text,
                                                            const std::string& ledger_id,
                                                            const std::string& present);
/// Throws Error when the school's key has run out by `now_utc_ns`.
void require_key_in_time(const LedgerContent& content, std::int64_t now_utc_ns);

/// From this entry on `next` signs, good until `until_utc_ns` (0 = without end). `present` signs
/// that.
[[nodiscard]] KeyEntry school_key_entry(const LedgerContent& content, const SigningKey& present,
                                        const SigningKey& next, std::int64_t until_utc_ns);

/// Where the next key waits while it takes the place of the one at `path`: PATH.next.
[[nodiscard]] std::string next_key_path(const std::string& path);
/// Where a key lies that was replaced: PATH and the first digits of its public half.
[[nodiscard]] std::string old_key_path(const std::string& path, const std::string& public_key);
/// Replaces the school's key at `key_path` by a new one, drawn now: enters it, seals the identities
/// with it, and puts it in the place of the old one, which is kept beside it. Run again after it
/// was cut off, it goes on from there. Returns the new public key, which it writes to
/// `public_path`, too, unless that is empty. Throws Error.
std::string replace_school_key(const std::string& folder, const std::string& key_path,
                               std::int64_t until_utc_ns, const std::string& reason,
                               const std::string& public_path = {});
/// Enters until when the present key is good (0 = without end). Throws Error.
void limit_school_key(Ledger& ledger, std::int64_t until_utc_ns, const std::string& reason);

}  // namespace cavum::records
