// Other parties' word for a ledger. A cosigner, on another computer, remembers the last checkpoint
// that it has signed of each ledger, and signs only one that goes on from there: nobody can then
// put the ledger and its witness back to an older copy, or rewrite it, unseen by whoever holds the
// note.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grading/records/history.h"

namespace cavum::records {

/// What goes to a cosigner: the body of C2SP's tlog-witness request, "old SIZE", the consistency
/// proof from there, an empty line, the checkpoint's note. `since` 0 for a first one. Throws Error
/// when the ledger has not so many entries.
[[nodiscard]] std::string cosign_request(const LedgerContent& content, std::uint64_t since);
/// The largest size that somebody has cosigned; 0 for none.
[[nodiscard]] std::uint64_t last_cosigned(const LedgerContent& content);

/// A cosigner on its computer.
struct Cosigner {
  std::string name;  ///< stands in its signatures
  SigningKey key;
  std::string memory;  ///< folder with a file for each ledger, ID: the school's key line, then the
                       ///< last note that was cosigned
  std::string school_key{};  ///< 64 hexadecimal digits; needed for a ledger that it does not
                             ///< remember, and compared for one that it does
  std::vector<std::string> key_entries{};  ///< texts of entries `key` by which the school replaced
                                           ///< the key that is remembered
};
struct Cosigned {
  Findings findings;  ///< why it was refused; then nothing is signed or remembered
  std::string ledger_id;
  std::uint64_t size = 0;
  std::string note;  ///< with the cosignature
};
/// Signs what `request` asks for, after the memory of it is on disk. Throws Error when the request
/// cannot be read, the ledger's school is not known, or the proof does not begin at what is
/// remembered.
[[nodiscard]] Cosigned cosign(const Cosigner& cosigner, const std::string& request,
                              const std::string& where, std::uint64_t utc_s);
/// $CAVUM_HOME/cosigned.
[[nodiscard]] std::string cosigner_memory_path();

/// $CAVUM_HOME/cosigners: the key line of each cosigner whose word counts here, one a line; empty
/// lines and those with # are left out.
[[nodiscard]] std::string known_cosigners_path();
/// Nothing when there is no such file. Throws Error at a line that is no cosigner's key.
[[nodiscard]] std::vector<NoteKey> read_cosigners(const std::string& path);

/// What a cosigned note shows.
struct CosignedNoteCheck {
  Findings findings;
  Findings not_checked;
  std::optional<Checkpoint>
      checkpoint;  ///< what it saw, when it can be read and the school signed it
  std::vector<NoteSignature> cosignatures;  ///< those of known cosigners
};
/// Checks a note against the ledger: the school's signature, those of known cosigners, and whether
/// the ledger still begins with what it saw.
[[nodiscard]] CosignedNoteCheck check_cosigned(const std::string& note,
                                               const std::vector<NoteKey>& known,
                                               const LedgerContent& ledger);
/// The same of the cosignatures that the ledger holds.
void check_cosignatures(const LedgerContent& ledger, const std::vector<NoteKey>& known,
                        Findings& findings, Findings& not_checked);

}  // namespace cavum::records
