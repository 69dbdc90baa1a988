#include "grading/records/cosign.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <sstream>

#include "engine/base/file.h"
#include "grading/records/folder_lock.h"
#include "grading/records/ledger_error.h"
#include "grading/records/ledger_key.h"
#include "grading/records/merkle.h"
#include "grading/records/school_keys.h"

namespace cavum::records {
namespace {

constexpr std::size_t k_longest_proof = 63;
constexpr std::string_view k_old = "old ";

struct Request {
  std::uint64_t since = 0;
  std::vector<Sha256> proof;
  std::string note;
};

[[noreturn]] void no_request(const std::string& where, const Message& why) {
  throw Error(where, msg("is no checkpoint to be cosigned: {}", why),
              msg("name a file that `cavum ledger checkpoint` wrote, unchanged"));
}

Request parse_request(const std::string& text, const std::string& where) {
  Request out;
  const auto gap = text.find("\n\n");
  if (!text.starts_with(k_old) || gap == std::string::npos)
    no_request(where, msg("it does not begin with 'old SIZE', a proof and an empty line"));
  std::istringstream lines(text.substr(0, gap + 1));
  std::string line;
  std::getline(lines, line);
  const auto [end, error] =
      std::from_chars(line.data() + k_old.size(), line.data() + line.size(), out.since);
  if (error != std::errc() || line != std::string(k_old) + std::to_string(out.since))
    no_request(where, msg("its old size is no whole number"));
  while (std::getline(lines, line)) {
    const auto hash = from_base64(line);
    if (!hash || hash->size() != 32 || out.proof.size() == k_longest_proof)
      no_request(where, msg("its proof is not at most 63 hashes in base64"));
    std::copy(hash->begin(), hash->end(), out.proof.emplace_back().begin());
  }
  out.note = text.substr(gap + 2);
  return out;
}

/// What is remembered of a ledger.
struct Memory {
  std::string school_key;  // hexadecimal
  Checkpoint last;
};

std::optional<Memory> remembered(const std::string& path, const std::string& ledger_id) {
  if (!std::filesystem::exists(path)) return {};
  const std::string text = read_text_file(path);
  const auto first = text.find('\n');
  const NoteKey key = parse_key_line(text.substr(0, first), path);
  Memory m{to_hex(key.public_key), {}};
  const ReadCheckpoint read = parse_checkpoint(text.substr(first + 1), m.school_key, path);
  m.last = read.checkpoint;
  if (read.ledger_id != ledger_id || key.name != ledger_origin(ledger_id) ||
      !is_signed_by_school(ledger_id, m.school_key, m.last))
    throw Error(LedgerError::another_state, Name{path},
                msg("what was cosigned of this ledger was changed"),
                msg("restore it from its backup"));
  return m;
}

/// The key that the school has now, by entries in which each key before it signs for the next.
std::string successor_of(std::string key, const std::string& ledger_id,
                         const std::vector<std::string>& key_entries) {
  for (std::size_t i = 0; i < key_entries.size(); ++i)  // in whatever order they are given
    for (const auto& entry : key_entries)
      if (const auto next = successor_named_by(entry, ledger_id, key); next && *next != key) {
        key = *next;
        break;
      }
  return key;
}

Message entries(std::uint64_t n) {
  return msgn("{} entry", "{} entries", static_cast<std::int64_t>(n), n);
}

/// Why the checkpoint does not go on from what is remembered.
Findings fork_of(const Memory& m, const Checkpoint& p, const Request& r, const std::string& path) {
  if (p.size < m.last.size)
    return {finding<FindingKind::older_than_cosigned>(p.size, m.last.size, path)};
  if (is_consistent(m.last.size, m.last.root, p.size, p.root, r.proof)) return {};
  if (p.size == m.last.size) return {finding<FindingKind::rewritten_cosigned>(path)};
  return {finding<FindingKind::rewritten_proof>(m.last.size, path)};
}

}  // namespace

std::uint64_t last_cosigned(const LedgerContent& c) {
  std::uint64_t last = 0;
  for (const auto& s : c.cosignatures) last = std::max(last, s.size);
  return last;
}

std::string cosign_request(const LedgerContent& c, std::uint64_t since) {
  const Checkpoint& p = c.checkpoints.back();
  if (since > p.size)
    throw Error(fmt::format("--since {}", since), msg("the ledger has {}", entries(p.size)),
                msg("name a size that it has had"));
  std::string out = fmt::format("{}{}\n", k_old, since);
  if (since > 0)
    for (const auto& h : consistency_proof(leaves_of(c), since)) out += to_base64(h) + "\n";
  return fmt::format("{}\n{}", out,
                     checkpoint_note(c.id, c.key_of(p.size), p, cosignatures_of(c, p.size)));
}

std::string cosigner_memory_path() { return station_path("cosigned"); }

Cosigned cosign(const Cosigner& cosigner, const std::string& text, const std::string& where,
                std::uint64_t utc_s) {
  require_note_name(cosigner.name, "--name");
  const Request request = parse_request(text, where);
  const std::string no_key(64, '0');
  const std::string id = parse_checkpoint(request.note, no_key, where).ledger_id,
                    path = fmt::format("{}/{}", cosigner.memory, id);
  make_private_folder(cosigner.memory);
  const FolderLock lock(cosigner.memory, msg("the cosigner's memory cannot be kept there"),
                        msg("name a folder with --state"));
  const auto memory = remembered(path, id);
  if (!memory && cosigner.school_key.empty())
    throw Error(LedgerError::unknown, Name{where},
                msg("is of a ledger that this cosigner does not know"),
                msg("name its school's public key with --school-key, from the school itself"));
  if (memory && !cosigner.school_key.empty() && cosigner.school_key != memory->school_key)
    throw Error(
        LedgerError::another_key, Name{"--school-key"},
        msg("is not the key of the ledger that was cosigned before"),
        msg("leave it out; that the school replaced its key is shown by the receipt of that entry (--key-receipt)"));
  const std::string school =
      memory ? successor_of(memory->school_key, id, cosigner.key_entries) : cosigner.school_key;
  const ReadCheckpoint read = parse_checkpoint(request.note, school, where);
  const Checkpoint& p = read.checkpoint;
  Cosigned out{{}, id, p.size, {}};
  if (!is_signed_by_school(id, school, p)) {
    out.findings.push_back(memory ? finding<FindingKind::request_or_key>()
                                  : finding<FindingKind::request_signature>());
    return out;
  }
  const std::uint64_t last = memory ? memory->last.size : 0;
  if (memory && p.size < last) {
    out.findings = fork_of(*memory, p, request, path);
    return out;
  }
  if (request.since != last)
    throw Error(LedgerError::another_state, Name{where},
                msg("proves what was added since {}, and this cosigner has signed {}",
                    entries(request.since), entries(last)),
                msg("ask for `cavum ledger checkpoint LEDGER --since {}`", last));
  if (memory) out.findings = fork_of(*memory, p, request, path);
  if (!memory && !request.proof.empty())
    no_request(where, msg("it proves something of no earlier entries"));
  if (!out.findings.empty()) return out;
  SignedNote note{read.note.text, {}};
  const NoteKey own{cosigner.name, NoteKind::cosignature, cosigner.key.public_key};
  std::copy_if(read.note.signatures.begin(), read.note.signatures.end(),
               std::back_inserter(note.signatures),
               [&](const NoteSignature& s) { return !is_of(s, own); });
  note.signatures.push_back(cosign_note(note.text, cosigner.name, cosigner.key, utc_s));
  out.note = write_note(note);
  write_text_file(path, fmt::format("{}\n{}", key_line(checkpoint_key(id, school)), out.note));
  sync_folder_of(cosigner.memory);
  return out;
}

std::string known_cosigners_path() { return station_path("cosigners"); }

std::vector<NoteKey> read_cosigners(const std::string& path) {
  std::vector<NoteKey> out;
  if (!std::filesystem::exists(path)) return out;
  std::istringstream lines(read_text_file(path));
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.empty() || line[0] == '#') continue;
    const std::string where = fmt::format("{}:{}", path, number);
    out.push_back(parse_key_line(line, where));
    if (out.back().kind != NoteKind::cosignature)
      throw Error(where, msg("is no cosigner's key"),
                  msg("copy the line that `cavum ledger cosign` shows"));
  }
  return out;
}

CosignedNoteCheck check_cosigned(const std::string& text, const std::vector<NoteKey>& known,
                                 const LedgerContent& ledger) {
  CosignedNoteCheck out;
  try {
    const std::string key_then = ledger.key_of(
        parse_checkpoint(text, ledger.public_key, msg("cosigned note")).checkpoint.size);
    const ReadCheckpoint read = parse_checkpoint(text, key_then, msg("cosigned note"));
    const auto school = check_note(read.note, checkpoint_key(read.ledger_id, key_then));
    if (school != NoteVerdict::holds)
      out.findings.push_back(school == NoteVerdict::absent
                                 ? finding<FindingKind::note_unsigned>()
                                 : finding<FindingKind::signature_invalid>());
    else
      out.checkpoint = read.checkpoint;
    for (const auto& key : known) {
      const auto verdict = check_note(read.note, key);
      if (verdict == NoteVerdict::broken)
        out.findings.push_back(finding<FindingKind::cosignature_invalid>(key.name));
      if (verdict != NoteVerdict::holds) continue;
      std::copy_if(read.note.signatures.begin(), read.note.signatures.end(),
                   std::back_inserter(out.cosignatures),
                   [&](const NoteSignature& s) { return is_of(s, key); });
    }
    if (out.cosignatures.empty())
      out.not_checked.push_back(finding<FindingKind::cosignature_none>());
    if (out.checkpoint)
      check_history(ledger, read.ledger_id, read.checkpoint, msg("the cosigned note"),
                    out.findings);
  } catch (const Error& e) {
    out.findings.push_back(finding<FindingKind::malformed>(e.where_and_problem()));
  }
  return out;
}

void check_cosignatures(const LedgerContent& ledger, const std::vector<NoteKey>& known,
                        Findings& findings, Findings& not_checked) {
  std::size_t strange = 0;
  for (const auto& s : ledger.cosignatures) {
    const auto p = std::find_if(ledger.checkpoints.rbegin(), ledger.checkpoints.rend(),
                                [&](const Checkpoint& c) { return c.size == s.size; });
    const auto key =
        std::find_if(known.begin(), known.end(), [&](const NoteKey& k) { return is_of(s.by, k); });
    if (p == ledger.checkpoints.rend())
      findings.push_back(finding<FindingKind::cosignature_stray>(s.by.name, s.size));
    else if (key == known.end())
      ++strange;
    else if (!holds(s.by, *key, checkpoint_text(ledger.id, *p)))
      findings.push_back(finding<FindingKind::cosignature_invalid>(s.by.name));
  }
  if (strange > 0)
    not_checked.push_back(
        finding<FindingKind::cosignature_unknown>(strange, known_cosigners_path()));
}

}  // namespace cavum::records
