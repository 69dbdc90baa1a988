#include "grading/records/history.h"

#include <fmt/core.h>

#include <algorithm>

#include "engine/base/text.h"
#include "engine/session/session.h"
#include "grading/records/ledger_key.h"
#include "grading/records/merkle.h"
#include "grading/records/witness.h"

namespace cavum::records {

History::History(const LedgerContent& c) : id_(c.id), restores_(restores_of(c)) {
  GrowingRoot growing;
  for (const auto& e : c.entries) {
    growing.add(leaf_hash(ledger_bytes(e.text)));
    roots_.push_back(growing.root());
  }
}

std::vector<RestoredHere> restores_of(const LedgerContent& c) {
  std::vector<RestoredHere> out;
  for (const auto& e : c.entries) {
    const auto* restore = e.as<RestoreEntry>();
    if (restore == nullptr) continue;
    RestoredHere& r = out.emplace_back(RestoredHere{e.seq, e.utc_ns, e.by.reason, restore->lost, 0});
    for (const auto& seen : r.lost) r.lost_size = std::max(r.lost_size, seen.size);
  }
  return out;
}

Message in_words(const RestoredHere& r) {
  const Message backup =
      msgn("entry {}: on {} the ledger went on from a backup of {} entry", "entry {}: on {} the ledger went on from a backup of {} entries",
           static_cast<std::int64_t>(r.seq), r.seq, utc_text(r.utc_ns), r.seq);
  if (r.lost_size == 0) return msg("{}; nothing was known to be lost", backup);
  const auto lost = static_cast<std::int64_t>(r.lost_size - std::min(r.lost_size, r.seq));
  return msgn("{}; {} later entry was lost, which the school accepted: {}", "{}; {} later entries were lost, which the school accepted: {}", lost,
              backup, lost, r.reason);
}

const RestoredHere* History::recorded_loss(const Checkpoint& seen) const {
  for (const auto& r : restores_) {
    if (seen.size <= r.seq || seen.size > r.lost_size) continue;
    bool same_size = false, same = false;
    for (const auto& [size, root] : r.lost) {
      same_size = same_size || size == seen.size;
      same = same || (size == seen.size && root == seen.root);
    }
    if (same || !same_size) return &r;
  }
  return nullptr;
}

Standing History::standing_of(const Checkpoint& seen) const {
  if (seen.size > 0 && seen.size <= roots_.size() && roots_[seen.size - 1] == seen.root) return Standing::begins_with_it;
  if (recorded_loss(seen) != nullptr) return Standing::loss_on_record;
  return seen.size > roots_.size() ? Standing::older_copy : Standing::rewritten;
}

Standing check_history(const History& ledger, const std::string& id, const Checkpoint& seen, const Message& what, Findings& findings) {
  if (ledger.ledger_id() != id) {
    findings.push_back({FindingKind::other_ledger, msg("{} is of another ledger", what)});
    return Standing::begins_with_it;
  }
  const Standing standing = ledger.standing_of(seen);
  if (standing == Standing::older_copy)
    findings.push_back({FindingKind::older_copy,
                        msg("the ledger was put back to an older copy: it has {} entries, {} saw {}", ledger.roots().size(), what, seen.size)});
  if (standing == Standing::rewritten)
    findings.push_back({FindingKind::rewritten, msg("the ledger no longer begins with what {} saw: history was rewritten", what)});
  return standing;
}

void check_checkpoints(LedgerContent& c) {
  const History history(c);
  const auto& roots = history.roots();
  if (c.public_key.size() != 64 || c.public_key.find_first_not_of("0123456789abcdef") != std::string::npos) {
    c.findings.push_back({FindingKind::no_beginning, msg("entry 0: names no school's public key"), 0});
    return;
  }
  std::uint64_t expected = 0;
  for (const auto& p : c.checkpoints) {
    const Message name = msg("checkpoint {}", p.size);
    if (p.size != ++expected) {
      c.findings.push_back({FindingKind::checkpoint_missing, msg("checkpoint {}: is missing", expected)});
      expected = p.size;
    }
    if (!is_signed_by_school(c.id, c.key_of(p.size), p))
      c.findings.push_back({FindingKind::signature_invalid, msg("{}: the school's signature does not hold", name)});
    if (p.size > roots.size())
      c.findings.push_back(
          {FindingKind::entry_missing, msg("{}: signed for {} entries, and there are {}: entries were taken out", name, p.size, roots.size())});
    else if (p.size > 0 && roots[p.size - 1] != p.root)
      c.findings.push_back({FindingKind::tree_differs, msg("{}: an entry up to number {} is not what the school signed", name, p.size - 1)});
  }
  if (expected < c.entries.size())
    c.findings.push_back({FindingKind::checkpoint_missing, msg("entry {}: the school has signed nothing from here on", expected), expected});
}

void check_witness(LedgerContent& c, const std::vector<Checkpoint>& witnessed) {
  c.witnessed = !witnessed.empty();
  const History history(c);
  const auto& roots = history.roots();
  const Checkpoint *ahead = nullptr, *other = nullptr;
  for (const auto& w : witnessed) {
    const Standing standing = history.standing_of(w);
    if (standing == Standing::begins_with_it || standing == Standing::loss_on_record) continue;
    if (!is_signed_by_school(c.id, c.key_of(w.size), w)) {
      c.findings.push_back(
          {FindingKind::witness_changed,
           w.size > roots.size()
               ? msg("{}: the witness was changed at entry {}, or an older copy of the ledger was put back, from before the school's key "
                     "was replaced",
                     witness_path(c.id), w.size)
               : msg("{}: the witness was changed at entry {}", witness_path(c.id), w.size)});
      return;
    }
    if (standing == Standing::older_copy && (ahead == nullptr || w.size > ahead->size)) ahead = &w;
    if (standing == Standing::rewritten && other == nullptr) other = &w;
  }
  if (ahead != nullptr)
    c.findings.push_back({FindingKind::older_copy, msg("the ledger was put back to an older copy: it has {} entries, and had {} on {}", roots.size(),
                                                       ahead->size, utc_text(ahead->utc_ns))});
  if (other != nullptr)
    c.findings.push_back({FindingKind::rewritten,
                          msg("the ledger's first {} entries are not those of {}: history was rewritten", other->size, utc_text(other->utc_ns))});
}

}  // namespace cavum::records
