// A signed note: a text with signature lines under it, as c2sp.org/signed-note specifies it, and
// the timestamped cosignatures of c2sp.org/tlog-cosignature. Any program that knows these formats
// can check what the ledger signs.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/base/where.h"
#include "engine/session/station_key.h"

namespace cavum::records {

/// One line under a note: "— NAME base64(key id, signature)". A cosignature begins with its time, 8
/// bytes, big-endian.
struct NoteSignature {
  std::string name;
  std::array<std::uint8_t, 4> key_id{};
  Bytes signature;
};
struct SignedNote {
  std::string text;  ///< ends in a line end
  std::vector<NoteSignature> signatures;
};

/// What a key signs: the text itself, or a cosigner's word that it saw it at a time. The values
/// stand in key ids.
enum class NoteKind : std::uint8_t { signature = 0x01, cosignature = 0x04 };
/// Whose signature is looked for. Its id is the first 4 bytes of SHA-256(name, 0x0A, kind, public
/// key).
struct NoteKey {
  std::string name;
  NoteKind kind = NoteKind::signature;
  std::array<std::uint8_t, 32> public_key{};
};
[[nodiscard]] std::array<std::uint8_t, 4> key_id_of(const NoteKey& key);
/// A key on one line, as C2SP writes verifier keys: "NAME+hexadecimal key id+base64(kind, public
/// key)".
[[nodiscard]] std::string key_line(const NoteKey& key);
/// Throws Error(`where`, ...) when `line` is none, or its id is not its key's.
[[nodiscard]] NoteKey parse_key_line(const std::string& line, const Where& where);
/// Throws Error(`where`, ...) unless `name` is text without spaces and plus signs, 1 to 254 bytes.
void require_note_name(const std::string& name, const Where& where);

/// Throws Error(`where`, ...) when `note` is no signed note, is longer than 1 MB, or has more than
/// 100 signatures.
[[nodiscard]] SignedNote parse_note(const std::string& note, const Where& where);
/// Throws Error(`where`, ...) when it is no line of a signature with its line end.
[[nodiscard]] NoteSignature parse_signature_line(const std::string& line, const Where& where);
[[nodiscard]] std::string signature_line(const NoteSignature& signature);
[[nodiscard]] std::string write_note(const SignedNote& note);

/// The signature of `key` under `text`.
[[nodiscard]] NoteSignature sign_note(const std::string& text, const std::string& name,
                                      const SigningKey& key);
/// A cosignature/v1 of `key` under `text` at `utc_s`, seconds since 1970.
[[nodiscard]] NoteSignature cosign_note(const std::string& text, const std::string& name,
                                        const SigningKey& key, std::uint64_t utc_s);
/// When it was cosigned, seconds since 1970; nothing for what has not the length of an Ed25519
/// cosignature.
[[nodiscard]] std::optional<std::uint64_t> cosigned_at(const NoteSignature& signature);

/// True for a signature line of this key, by name and key id. Another one may share either.
[[nodiscard]] bool is_of(const NoteSignature& signature, const NoteKey& key);
/// True when the line was made by this key under this text.
[[nodiscard]] bool holds(const NoteSignature& signature, const NoteKey& key,
                         const std::string& text);
/// Is there a signature of this key, and does every one hold?
enum class NoteVerdict { absent, holds, broken };
[[nodiscard]] NoteVerdict check_note(const SignedNote& note, const NoteKey& key);

/// Standard base64 with padding (RFC 4648, section 4; libsodium).
[[nodiscard]] std::string to_base64(std::span<const std::uint8_t> bytes);
/// Nothing when it is not canonical: other characters, padding left out, bits set that stand for
/// nothing.
[[nodiscard]] std::optional<Bytes> from_base64(const std::string& text);

}  // namespace cavum::records
