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
    RestoredHere& r =
        out.emplace_back(RestoredHere{e.seq, e.utc_ns, e.by.reason, restore->lost, 0});
    for (const auto& seen : r.lost) r.lost_size = std::max(r.lost_size, seen.size);
  }
  return out;
}

Finding finding_of(const RestoredHere& r) {
  const std::string utc = utc_text(r.utc_ns);
  return (r.lost_size == 0 ? finding<FindingKind::restored>(utc, r.seq)
                           : finding<FindingKind::restored_with_loss>(
                                 utc, r.seq, r.lost_size - std::min(r.lost_size, r.seq), r.reason))
      .in_entry(r.seq);
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
  if (seen.size > 0 && seen.size <= roots_.size() && roots_[seen.size - 1] == seen.root)
    return Standing::begins_with_it;
  if (recorded_loss(seen) != nullptr) return Standing::loss_on_record;
  return seen.size > roots_.size() ? Standing::older_copy : Standing::rewritten;
}

Standing check_history(const History& ledger, const std::string& id, const Checkpoint& seen,
                       const Message& what, Findings& findings) {
  if (ledger.ledger_id() != id) {
    findings.push_back(finding<FindingKind::other_ledger>(what));
    return Standing::begins_with_it;
  }
  const Standing standing = ledger.standing_of(seen);
  if (standing == Standing::older_copy)
    findings.push_back(finding<FindingKind::older_copy>(ledger.roots().size(), what, seen.size));
  if (standing == Standing::rewritten) findings.push_back(finding<FindingKind::rewritten>(what));
  return standing;
}

void check_checkpoints(LedgerContent& c) {
  const History history(c);
  const auto& roots = history.roots();
  if (c.public_key.size() != 64 ||
      c.public_key.find_first_not_of("0123456789abcdef") != std::string::npos) {
    c.findings.push_back(finding<FindingKind::no_school_key>().in_entry(0));
    return;
  }
  std::uint64_t expected = 0;
  for (const auto& p : c.checkpoints) {
    if (p.size != ++expected) {
      c.findings.push_back(finding<FindingKind::checkpoint_missing>(expected));
      expected = p.size;
    }
    if (!is_signed_by_school(c.id, c.key_of(p.size), p))
      c.findings.push_back(finding<FindingKind::checkpoint_signature>(p.size));
    if (p.size > roots.size())
      c.findings.push_back(finding<FindingKind::entries_taken_out>(p.size, p.size, roots.size()));
    else if (p.size > 0 && roots[p.size - 1] != p.root)
      c.findings.push_back(finding<FindingKind::tree_differs>(p.size, p.size - 1));
  }
  if (expected < c.entries.size())
    c.findings.push_back(finding<FindingKind::checkpoint_none>().in_entry(expected));
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
      c.findings.push_back(w.size > roots.size()
                               ? finding<FindingKind::witness_or_older>(witness_path(c.id), w.size)
                               : finding<FindingKind::witness_changed>(witness_path(c.id), w.size));
      return;
    }
    if (standing == Standing::older_copy && (ahead == nullptr || w.size > ahead->size)) ahead = &w;
    if (standing == Standing::rewritten && other == nullptr) other = &w;
  }
  if (ahead != nullptr)
    c.findings.push_back(finding<FindingKind::older_than_witness>(roots.size(), ahead->size,
                                                                  utc_text(ahead->utc_ns)));
  if (other != nullptr)
    c.findings.push_back(
        finding<FindingKind::rewritten_witness>(other->size, utc_text(other->utc_ns)));
}

}  // namespace cavum::records
