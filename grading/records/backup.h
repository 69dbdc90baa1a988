// A copy of a ledger that can be taken while others add to it, and how a ledger goes on from one.
// Both say what they do not hold.
#pragma once

#include <string>
#include <vector>

#include "grading/records/ledger.h"

namespace cavum::records {

struct Backup {
  std::string ledger_id;
  Checkpoint checkpoint;  ///< of the copy
  std::size_t sessions = 0,
              copied = 0;  ///< in the copy; of these copied now, the others were there
  std::vector<std::string>
      missing;  ///< filed sessions, by SHA-256, that could not be copied: gone or changed
  bool identities = false;        ///< copied now
  bool older_identities = false;  ///< not copied now, and those of an earlier backup stay, without
                                  ///< who was forgotten meanwhile
};
/// Copies the ledger into `folder`: the database as it is at one moment, its checkpoint, and the
/// sessions' files, each compared with its hash; the identities only when asked for. A backup of
/// the same ledger that is there is brought up to date. Files are the user's alone. Throws Error
/// when the ledger does not hold, or `folder` holds something else, or entries that this ledger has
/// not; what was there then still stands.
[[nodiscard]] Backup back_up(const LedgerPaths& ledger, const std::string& folder,
                             bool with_identities);

/// What somebody outside the backup had seen of the ledger.
struct Seen {
  Message what;  ///< "the witness", "receipt.json"
  Checkpoint checkpoint;
};
/// What a backup lacks, as far as anything at hand tells.
struct RestorePlan {
  LedgerContent content;
  Findings findings;  ///< the backup does not hold, or is another history than what was seen: it is
                      ///< not restored
  std::vector<std::string>
      missing_sessions;               ///< filed in it, and their files are gone or changed: SHA-256
  std::vector<Message> lost_entries;  ///< in words: entries after the backup
  std::vector<Checkpoint> lost;       ///< every checkpoint that was seen of them
  std::optional<Seen> last_seen;      ///< the one with most entries
  bool identities = false;
  bool compared = false;  ///< a witness, receipt or note was at hand
};
/// Looks at a backup with this computer's witness, and receipts and cosigned notes, paths of files.
/// Changes nothing. Throws Error when it is no ledger, or a file cannot be read.
[[nodiscard]] RestorePlan plan_restore(const std::string& backup,
                                       const std::vector<std::string>& receipts,
                                       const std::vector<std::string>& notes);
/// Makes the ledger anew in `folder`, which must not be there, and enters there that it goes on
/// from a backup and what was lost: body {backup{root, size}, lost[{root, size}],
/// missing_sessions[], reason}. Throws Error when the plan has findings, or entries were lost and
/// `reason` does not say why the school accepts it; one line of UTF-8, 1000 bytes at most.
void restore(const std::string& backup, const std::string& folder, const RestorePlan& plan,
             const std::string& reason, const SigningKey& key);

}  // namespace cavum::records
