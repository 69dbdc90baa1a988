#include "grading/records/receipt.h"

#include <fmt/core.h>

#include <algorithm>

#include "engine/base/json_fields.h"
#include "engine/base/message_from.h"
#include "engine/session/session.h"
#include "grading/records/entry_text.h"
#include "grading/records/history.h"
#include "grading/records/ledger_key.h"
#include "grading/records/merkle.h"

namespace cavum::records {
namespace {

using nlohmann::json;

json hex_list(const std::vector<Sha256>& hashes) {
  json out = json::array();
  for (const auto& h : hashes) out.push_back(to_hex(h));
  return out;
}

std::vector<Sha256> hashes_in(const json& list, const std::string& where) {
  std::vector<Sha256> out;
  for (const auto& h : list) out.push_back(fixed_from_hex<32>(h, where));
  return out;
}

std::string told(const LedgerContent& c, const Checkpoint& p) {
  return checkpoint_note(c.id, c.key_of(p.size), p, cosignatures_of(c, p.size));
}

/// The entry that holds the same session as the text of a lost one.
bool is_filed_again(const LedgerContent& ledger, const std::string& lost) {
  const LedgerEntry entry = read_entry_or_none(lost);
  const auto* session = entry.as<SessionEntry>();
  return session != nullptr &&
         std::any_of(ledger.entries.begin(), ledger.entries.end(), [&](const LedgerEntry& e) {
           const auto* other = e.as<SessionEntry>();
           return other != nullptr && other->file_sha256 == session->file_sha256;
         });
}

}  // namespace

json make_receipt(const LedgerContent& content, std::uint64_t seq, std::uint64_t from_size) {
  const auto leaves = leaves_of(content);
  json receipt = {{"ledger", content.id},
                  {"public_key", content.public_key},
                  {"entry", content.entries.at(seq).text},
                  {"seq", seq},
                  {"inclusion", hex_list(inclusion_proof(leaves, seq))},
                  {"checkpoint", told(content, content.checkpoints.back())}};
  if (from_size == 0) return receipt;
  const auto from = std::find_if(content.checkpoints.rbegin(), content.checkpoints.rend(),
                                 [&](const Checkpoint& p) { return p.size == from_size; });
  if (from == content.checkpoints.rend()) throw std::out_of_range("no such checkpoint");
  if (content.key_of(from_size) != content.public_key)
    throw Error(
        fmt::format("--from-size {}", from_size),
        msg("was signed with a key that the school has replaced, and a receipt names one key"),
        msg("show the note of that time beside it: `cavum ledger verify --cosigned`, or the earlier receipt"));
  receipt["consistency"] = {{"from", told(content, *from)},
                            {"proof", hex_list(consistency_proof(leaves, from_size))}};
  return receipt;
}

Findings check_receipt(const json& receipt, const std::string& public_key,
                       const LedgerContent* ledger) {
  Findings findings;
  if (!receipt.is_object()) return {finding<FindingKind::no_receipt>()};
  try {
    const std::string id = receipt.at("ledger"), key = receipt.at("public_key"),
                      entry = receipt.at("entry");
    const Checkpoint p = checkpoint_in(receipt.at("checkpoint"), id, key, "receipt");
    const auto path = hashes_in(receipt.at("inclusion"), "receipt: inclusion");
    if (ledger != nullptr ? key != ledger->key_of(p.size)
                          : !public_key.empty() && key != public_key)
      findings.push_back(finding<FindingKind::receipt_other_school>());
    if (!is_signed_by_school(id, key, p))
      findings.push_back(finding<FindingKind::receipt_signature>());
    if (!is_included(leaf_hash(ledger_bytes(entry)),
                     require_whole<std::uint64_t>(receipt, "seq", "receipt"), p.size, path, p.root))
      findings.push_back(finding<FindingKind::receipt_entry>());
    if (const json& consistency = member_of(receipt, "consistency"); !consistency.is_null()) {
      const Checkpoint from =
          checkpoint_in(consistency.at("from"), id, key, "receipt: consistency");
      if (!is_signed_by_school(id, key, from))
        findings.push_back(finding<FindingKind::receipt_earlier_signature>());
      if (!is_consistent(from.size, from.root, p.size, p.root,
                         hashes_in(consistency.at("proof"), "receipt: consistency")))
        findings.push_back(finding<FindingKind::receipt_earlier>());
    }
    if (ledger != nullptr) {
      const History history(*ledger);
      if (check_history(history, id, p, msg("the receipt"), findings) == Standing::loss_on_record &&
          !is_filed_again(*ledger, entry))
        findings.push_back(finding<FindingKind::receipt_lost>(history.recorded_loss(p)->seq));
    }
  } catch (const json::exception&) {
    findings.push_back(finding<FindingKind::receipt_part>());
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    findings.push_back(finding<FindingKind::receipt_unreadable>(message_from(e)));
  }
  return findings;
}

}  // namespace cavum::records
