// A receipt: what a candidate can show without the ledger. It holds an entry's text, the way from
// it to the tree's root, and the school's signature under that root.
#pragma once

#include "grading/records/ledger_content.h"

namespace cavum::records {

/// {ledger, public_key, entry, seq, inclusion[], checkpoint}: shows without the ledger that entry
/// `seq` is in it. With `from_size`, 1 to the number of entries, also {consistency: {from,
/// proof[]}}: that the first `from_size` entries are the beginning of it. Throws std::out_of_range.
[[nodiscard]] nlohmann::json make_receipt(const LedgerContent& content, std::uint64_t seq,
                                          std::uint64_t from_size = 0);
/// What a receipt does not show; empty when it holds. `public_key` (hexadecimal): the school's;
/// empty = the receipt's own. With a ledger's content also whether that still begins with what the
/// receipt saw.
[[nodiscard]] Findings check_receipt(const nlohmann::json& receipt, const std::string& public_key,
                                     const LedgerContent* ledger);

}  // namespace cavum::records
