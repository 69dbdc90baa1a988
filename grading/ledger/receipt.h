// A receipt: what a candidate can show without the ledger. It holds an entry's text, the way from it to the tree's root, and the school's signature
// under that root.
#pragma once

#include "grading/ledger/ledger_content.h"

namespace cavum {

/// {ledger, public_key, entry, seq, inclusion[], checkpoint}: shows without the ledger that entry `seq` is in it.
[[nodiscard]] nlohmann::json make_receipt(const LedgerContent& content, std::uint64_t seq);
/// What a receipt does not show, in words; empty when it holds. `public_key` (hexadecimal): the school's; empty = the receipt's own. With a ledger's
/// content also whether that still begins with what the receipt saw.
[[nodiscard]] std::vector<std::string> check_receipt(const nlohmann::json& receipt, const std::string& public_key, const LedgerContent* ledger);
/// Adds to `findings` what is wrong when the ledger is not `id`, or no longer begins with the entries of the checkpoint `seen`. `what`: what bears
/// it ("the receipt").
void check_history(const LedgerContent& ledger, const std::string& id, const Checkpoint& seen, const std::string& what,
                   std::vector<std::string>& findings);

}  // namespace cavum
