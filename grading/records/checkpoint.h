// The school's word that a ledger's first entries have a certain root: a C2SP checkpoint
// (c2sp.org/tlog-checkpoint), which any program can check and others can cosign.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "engine/base/bytes.h"
#include "engine/base/hash.h"
#include "engine/base/where.h"
#include "grading/records/signed_note.h"

namespace cavum::records {

struct Checkpoint {
  std::uint64_t size = 0;  ///< number of entries
  Sha256 root{};           ///< of the tree over them
  std::int64_t utc_ns = 0;
  std::array<std::uint8_t, 64> signature{};
};

/// First line of a ledger's checkpoints, and the name under which its school signs them:
/// "cavum.ledger/ID".
[[nodiscard]] std::string ledger_origin(const std::string& ledger_id);
/// The school's key for a ledger's checkpoints. Throws Error when `public_key` is not 64
/// hexadecimal digits.
[[nodiscard]] NoteKey checkpoint_key(const std::string& ledger_id, const std::string& public_key);
/// What is signed: four lines, origin, size, root in base64, "utc_ns" and the time.
[[nodiscard]] std::string checkpoint_text(const std::string& ledger_id,
                                          const Checkpoint& checkpoint);

[[nodiscard]] Checkpoint sign_checkpoint(const std::string& ledger_id, std::uint64_t size,
                                         const Sha256& root, std::int64_t utc_ns,
                                         const SigningKey& key);
/// True when the school signed it. Throws Error when `public_key` is not 64 hexadecimal digits.
[[nodiscard]] bool is_signed_by_school(const std::string& ledger_id, const std::string& public_key,
                                       const Checkpoint& checkpoint);

/// The checkpoint as a note, with what others have signed of it.
[[nodiscard]] std::string checkpoint_note(const std::string& ledger_id,
                                          const std::string& public_key,
                                          const Checkpoint& checkpoint,
                                          std::span<const NoteSignature> cosignatures = {});
/// A note that is a ledger's checkpoint.
struct ReadCheckpoint {
  std::string ledger_id;
  Checkpoint checkpoint;  ///< its signature: that of `public_key`'s line, zeros when there is none
  SignedNote note;
};
/// Throws Error(`where`, ...) when `note` is no checkpoint of a ledger. The signature is not
/// checked.
[[nodiscard]] ReadCheckpoint parse_checkpoint(const std::string& note,
                                              const std::string& public_key, const Where& where);

/// The same of a ledger's own. Throws Error(`where`, ...) also when it is of another one.
[[nodiscard]] Checkpoint checkpoint_in(const std::string& note, const std::string& ledger_id,
                                       const std::string& public_key, const Where& where);

}  // namespace cavum::records
