#include "grading/records/checkpoint.h"

#include <fmt/core.h>

#include <charconv>
#include <vector>

#include "engine/session/session.h"
#include "grading/records/ledger_key.h"

namespace cavum::records {
namespace {

constexpr std::string_view k_origin = "cavum.ledger/", k_time = "utc_ns ";
constexpr std::size_t k_id_digits = 32;

[[noreturn]] void no_checkpoint(const Where& where, const Message& why) {
  throw Error(where, msg("is no checkpoint of a ledger: {}", why),
              msg("name a note that `cavum ledger` wrote, unchanged"));
}

template <class Whole>
Whole whole(std::string_view digits, const Where& where, const Message& what) {
  Whole out{};
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), out);
  if (error != std::errc() || end != digits.data() + digits.size()) no_checkpoint(where, what);
  return out;
}

}  // namespace

std::string ledger_origin(const std::string& id) { return std::string(k_origin) + id; }

NoteKey checkpoint_key(const std::string& id, const std::string& public_key) {
  return {ledger_origin(id), NoteKind::signature,
          fixed_from_hex<32>(public_key, msg("public key"))};
}

std::string checkpoint_text(const std::string& id, const Checkpoint& p) {
  return fmt::format("{}\n{}\n{}\n{}{}\n", ledger_origin(id), p.size, to_base64(p.root), k_time,
                     p.utc_ns);
}

Checkpoint sign_checkpoint(const std::string& id, std::uint64_t size, const Sha256& root,
                           std::int64_t utc_ns, const SigningKey& key) {
  Checkpoint p{size, root, utc_ns, {}};
  const std::string text = checkpoint_text(id, p);
  p.signature = key.sign({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  return p;
}

bool is_signed_by_school(const std::string& id, const std::string& public_key,
                         const Checkpoint& p) {
  const auto key = fixed_from_hex<32>(public_key, msg("public key"));
  const std::string text = checkpoint_text(id, p);
  return is_signed_by(key, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()},
                      p.signature);
}

std::string checkpoint_note(const std::string& id, const std::string& public_key,
                            const Checkpoint& p, std::span<const NoteSignature> cosignatures) {
  const NoteKey key = checkpoint_key(id, public_key);
  SignedNote note{checkpoint_text(id, p),
                  {{key.name, key_id_of(key), Bytes(p.signature.begin(), p.signature.end())}}};
  note.signatures.insert(note.signatures.end(), cosignatures.begin(), cosignatures.end());
  return write_note(note);
}

ReadCheckpoint parse_checkpoint(const std::string& text, const std::string& public_key,
                                const Where& where) {
  ReadCheckpoint out{{}, {}, parse_note(text, where)};
  std::vector<std::string> lines;
  for (std::size_t from = 0; from < out.note.text.size();) {
    const auto end = out.note.text.find('\n', from);
    lines.push_back(out.note.text.substr(from, end - from));
    from = end + 1;
  }
  if (lines.size() != 4 || !lines[0].starts_with(k_origin) || !lines[3].starts_with(k_time))
    no_checkpoint(where, msg("its text is not the four lines origin, size, root and time"));
  out.ledger_id = lines[0].substr(k_origin.size());
  if (out.ledger_id.size() != k_id_digits ||
      out.ledger_id.find_first_not_of("0123456789abcdef") != std::string::npos)
    no_checkpoint(where, msg("its origin names no ledger"));
  Checkpoint& p = out.checkpoint;
  p.size = whole<std::uint64_t>(lines[1], where, msg("its size is no whole number"));
  p.utc_ns = whole<std::int64_t>(std::string_view(lines[3]).substr(k_time.size()), where,
                                 msg("its time is no whole number"));
  const auto root = from_base64(lines[2]);
  if (!root || root->size() != p.root.size())
    no_checkpoint(where, msg("its root is not base64 of 32 bytes"));
  std::copy(root->begin(), root->end(), p.root.begin());
  if (checkpoint_text(out.ledger_id, p) != out.note.text)
    no_checkpoint(where, msg("its numbers are not written as the school writes them"));
  const NoteKey key = checkpoint_key(out.ledger_id, public_key);
  for (const auto& s : out.note.signatures)
    if (is_of(s, key) && s.signature.size() == p.signature.size())
      std::copy(s.signature.begin(), s.signature.end(), p.signature.begin());
  return out;
}

Checkpoint checkpoint_in(const std::string& note, const std::string& id,
                         const std::string& public_key, const Where& where) {
  const ReadCheckpoint read = parse_checkpoint(note, public_key, where);
  if (read.ledger_id != id)
    throw Error(where, msg("its checkpoint is of another ledger"), msg("use an intact copy"));
  return read.checkpoint;
}

}  // namespace cavum::records
