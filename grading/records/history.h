// Is the ledger still what somebody saw of it? It was put back to an older copy, its history was
// rewritten, or it was continued from a backup and says so itself in a `restore` entry.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grading/records/ledger_content.h"

namespace cavum::records {

/// Where a ledger goes on from a backup: what its `restore` entry says.
struct RestoredHere {
  std::uint64_t seq = 0;  ///< of the entry; the backup held the entries before it
  std::int64_t utc_ns = 0;
  std::string
      reason;  ///< why the school accepted the loss; empty when nothing was known to be lost
  /// What anything at hand had seen of the lost entries: sizes and roots, a size twice when two
  /// histories were lost.
  std::vector<SizeAndRoot> lost;
  std::uint64_t lost_size = 0;  ///< the largest of them; 0: nothing was known to be lost
};
[[nodiscard]] std::vector<RestoredHere> restores_of(const LedgerContent& content);
/// For people who check the ledger.
[[nodiscard]] Finding finding_of(const RestoredHere& restored);
/// How a ledger stands to a checkpoint that somebody saw.
enum class Standing { begins_with_it, older_copy, rewritten, loss_on_record };
/// A ledger's roots at every size, and what it says was lost; made once for many questions.
class History {
 public:
  History(const LedgerContent& content);  // NOLINT(google-explicit-constructor): a ledger's content
                                          // is asked as it is
  [[nodiscard]] Standing standing_of(const Checkpoint& seen) const;
  /// The restore that says that `seen` was lost: with this root, or, of a size that nobody had seen
  /// then, among smaller ones; null when none does.
  [[nodiscard]] const RestoredHere* recorded_loss(const Checkpoint& seen) const;
  [[nodiscard]] const std::string& ledger_id() const noexcept { return id_; }
  [[nodiscard]] const std::vector<Sha256>& roots() const noexcept {
    return roots_;
  }  ///< of the first 1, 2, 3 … entries

 private:
  std::string id_;
  std::vector<Sha256> roots_;
  std::vector<RestoredHere> restores_;
};
/// Adds to `findings` what is wrong when the ledger is not `id`, or no longer begins with the
/// entries of the checkpoint `seen`, and no `restore` entry says so. `what`: what bears it ("the
/// receipt"). Returns how it stands; begins_with_it for another ledger.
Standing check_history(const History& ledger, const std::string& id, const Checkpoint& seen,
                       const Message& what, Findings& findings);

/// Adds findings to `content`: checkpoints whose signature does not hold, that miss, or that are
/// not of its entries.
void check_checkpoints(LedgerContent& content);
/// The same of what this computer's witness remembers.
void check_witness(LedgerContent& content, const std::vector<Checkpoint>& witnessed);

}  // namespace cavum::records
