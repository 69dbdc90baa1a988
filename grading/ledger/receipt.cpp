#include "grading/ledger/receipt.h"

#include "engine/base/json_fields.h"
#include "engine/session/session.h"
#include "grading/ledger/ledger_key.h"
#include "grading/ledger/merkle.h"

namespace cavum {

using nlohmann::json;

json make_receipt(const LedgerContent& content, std::uint64_t seq) {
  const auto leaves = leaves_of(content);
  const Checkpoint& p = content.checkpoints.back();
  json path = json::array();
  for (const auto& h : inclusion_proof(leaves, seq)) path.push_back(to_hex(h));
  return {{"ledger", content.id},
          {"public_key", content.public_key},
          {"entry", content.entries.at(seq).text},
          {"seq", seq},
          {"inclusion", path},
          {"checkpoint",
           {{"size", p.size}, {"root", to_hex(p.root)}, {"utc", utc_text(p.utc_ns)}, {"utc_ns", p.utc_ns}, {"signature", to_hex(p.signature)}}}};
}

void check_history(const LedgerContent& ledger, const std::string& id, const Checkpoint& seen, const std::string& what,
                   std::vector<std::string>& findings) {
  if (ledger.id != id) {
    findings.push_back(what + " is of another ledger");
  } else if (ledger.entries.size() < seen.size) {
    findings.push_back("the ledger was put back to an older copy: it has " + std::to_string(ledger.entries.size()) + " entries, " + what + " saw " +
                       std::to_string(seen.size));
  } else {
    std::vector<Sha256> leaves;
    for (const auto& e : ledger.entries) leaves.push_back(leaf_hash(ledger_bytes(e.text)));
    if (!is_consistent(seen.size, seen.root, leaves.size(), merkle_root(leaves), consistency_proof(leaves, seen.size)))
      findings.push_back("the ledger no longer begins with what " + what + " saw: history was rewritten");
  }
}

std::vector<std::string> check_receipt(const json& receipt, const std::string& public_key, const LedgerContent* ledger) {
  std::vector<std::string> findings;
  if (!receipt.is_object()) return {"is no receipt, for it is not JSON text of an object: name a file that `cavum ledger add --receipts` wrote"};
  try {
    const std::string id = receipt.at("ledger"), key = receipt.at("public_key"), entry = receipt.at("entry");
    const json& c = receipt.at("checkpoint");
    const Checkpoint p{require_whole<std::uint64_t>(c, "size", "receipt"), fixed_from_hex<32>(c.at("root"), "receipt: root"),
                       require_whole<std::int64_t>(c, "utc_ns", "receipt"), fixed_from_hex<64>(c.at("signature"), "receipt: signature")};
    std::vector<Sha256> path;
    for (const auto& h : receipt.at("inclusion")) path.push_back(fixed_from_hex<32>(h, "receipt: inclusion"));
    if (!public_key.empty() && key != public_key) findings.emplace_back("the receipt is of another school's key");
    if (!is_signed_by(fixed_from_hex<32>(key, "receipt: public_key"), checkpoint_message(id, p), p.signature))
      findings.emplace_back("the school's signature on the receipt does not hold");
    if (!is_included(leaf_hash(ledger_bytes(entry)), require_whole<std::uint64_t>(receipt, "seq", "receipt"), p.size, path, p.root))
      findings.emplace_back("the entry on the receipt is not the one that the school signed");
    if (ledger != nullptr) check_history(*ledger, id, p, "the receipt", findings);
  } catch (const json::exception&) {
    findings.emplace_back("is no receipt: a part of it is missing or of another kind than `cavum ledger add --receipts` writes");
  } catch (const std::exception& e) {
    findings.push_back(std::string("is no receipt: ") + e.what());
  }
  return findings;
}

}  // namespace cavum
