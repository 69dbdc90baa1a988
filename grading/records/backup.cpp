#include "grading/records/backup.h"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "engine/base/file.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/text.h"
#include "engine/session/session_image.h"
#include "grading/records/entry_text.h"
#include "grading/records/erasure.h"
#include "grading/records/folder_lock.h"
#include "grading/records/history.h"
#include "grading/records/identities.h"
#include "grading/records/ledger_file.h"
#include "grading/records/merkle.h"

namespace cavum::records {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t k_longest_acceptance = 1000;

std::string checkpoint_path(const std::string& folder) { return folder + "/checkpoint"; }

/// A database at one moment, whoever writes to it, under another name first. One file without a
/// log, synced with its name.
void copy_database(const std::string& from, const std::string& to) {
  const std::string fresh = temporary_name_next_to(to);
  make_private_file(fresh);
  try {
    Database copy = Database::open(fresh, false);
    copy.run("PRAGMA synchronous = FULL");
    try {
      Database source = Database::open(from, false);
      source.copy_to(copy);
    } catch (const DatabaseError& e) {
      if (e.refusal().fault == DiskFault::full || e.refusal().fault == DiskFault::input_output)
        throw;
      Damages findings;  // a folder that may only be read
      Database source = Database::from_image(read_session_image(from, findings), from);
      source.copy_to(copy);
    }
    copy.run("PRAGMA journal_mode = DELETE");
    copy.close();
    fs::rename(fresh, to);
  } catch (const std::exception&) {
    std::error_code ignored;
    for (const char* end : {"", "-wal", "-shm", "-journal"}) fs::remove(fresh + end, ignored);
    throw;
  }
  sync_folder_of(to);
}

/// SHA-256 of the files of all filed sessions that are not erased, each once.
std::set<std::string> filed_sessions(const LedgerContent& c) {
  const auto gone = erased_recordings(c);
  std::set<std::string> out;
  for (const auto& e : c.entries) {
    const auto* session = e.as<SessionEntry>();
    const std::string hash = session == nullptr ? "" : session->file_sha256;
    if (hash.size() == 64 && hash.find_first_not_of("0123456789abcdef") == std::string::npos &&
        !gone.contains(hash))
      out.insert(hash);
  }
  return out;
}

bool has_session(const LedgerPaths& places, const std::string& hash) {
  const std::string path = places.session(hash);
  std::error_code none;
  return fs::is_regular_file(path, none) && to_hex(sha256(read_file(path))) == hash;
}

/// Those that are not in `from`, or changed there. `copied` counts those that were not in `to`
/// before.
std::vector<std::string> copy_sessions(const LedgerContent& c, const LedgerPaths& from,
                                       const LedgerPaths& to, std::size_t& copied) {
  std::vector<std::string> missing;
  make_private_folder(to.folder + "/sessions");
  for (const auto& hash : filed_sessions(c)) {
    if (has_session(to, hash)) continue;
    std::error_code none;
    const Bytes bytes =
        fs::is_regular_file(from.session(hash), none) ? read_file(from.session(hash)) : Bytes();
    if (to_hex(sha256(bytes)) != hash) {
      missing.push_back(hash);
      continue;
    }
    write_file(to.session(hash), bytes);
    ::chmod(to.session(hash).c_str(), 0600);
    ++copied;
  }
  return missing;
}

/// The identities, without those whom the ledger says were forgotten.
bool copy_identities(const LedgerContent& c, const LedgerPaths& from, const LedgerPaths& to) {
  if (!fs::exists(from.identities())) return false;
  copy_database(from.identities(), to.identities());
  Identities identities(to.identities());
  remove_forgotten(c, identities);
  return true;
}

/// Throws Error unless what is in the folder is an earlier state of the same ledger, or nothing.
void require_place_for(const LedgerContent& content, const std::string& folder) {
  std::error_code none;
  if (!fs::exists(folder, none) || fs::is_empty(folder, none)) return;
  if (!fs::exists(checkpoint_path(folder))) {  // a first backup may have been cut short
    for (const auto& f : fs::directory_iterator(folder)) {
      const std::string name = f.path().filename().string();
      if (name != "ledger.db" && name != "identities.db" && name != "sessions" &&
          !name.starts_with(".cavum-"))
        throw Error(folder, msg("holds something else than a backup"), msg("name a new folder"));
    }
    if (!fs::exists(LedgerPaths{folder}.database())) return;
  }
  const LedgerContent before = read_ledger({folder}, AskWitness::no);
  Findings findings;
  if (!before.checkpoints.empty())
    check_history(content, before.id, before.checkpoints.back(), msg("the backup that is there"),
                  findings);
  if (before.checkpoints.empty() || !findings.empty())
    throw Error(
        folder,
        findings.empty() ? msg("holds a backup that cannot be read") : findings[0].message(),
        msg("keep it, and name a new folder"));
}

/// Adds what a checkpoint from outside tells of the backup.
void compare(RestorePlan& plan, const History& history, const std::string& id,
             const Checkpoint& seen, const Message& what, const Message& entry) {
  plan.compared = true;
  Findings wrong;
  const Standing standing = check_history(history, id, seen, what, wrong);
  if (standing != Standing::older_copy) {
    append(plan.findings, wrong);
    return;
  }
  if (!entry.empty()) plan.lost_entries.push_back(entry);
  plan.lost.push_back(seen);
  if (!plan.last_seen || seen.size > plan.last_seen->checkpoint.size)
    plan.last_seen = Seen{what, seen};
}

/// What the backup itself says that it held: entries may have been cut off since. It may hold more:
/// the next backup into the same folder was cut short before it said so.
void check_own_checkpoint(RestorePlan& plan, const History& history, const std::string& path) {
  const LedgerContent& c = plan.content;
  if (!fs::exists(path)) return;
  try {
    const std::string told = read_text_file(path);
    const Checkpoint& own = c.checkpoints.back();
    const std::string key_then = c.key_of(checkpoint_in(told, c.id, c.public_key, path).size);
    const Checkpoint p = checkpoint_in(told, c.id, key_then, path);
    if (!is_signed_by_school(c.id, key_then, p))
      plan.findings.push_back(finding<FindingKind::backup_signature>());
    else if (p.size == 0 || p.size > history.roots().size() ||
             history.roots()[static_cast<std::size_t>(p.size) - 1] != p.root)
      plan.findings.push_back(finding<FindingKind::backup_changed>(p.size, own.size));
  } catch (const Error& e) {
    plan.findings.push_back(finding<FindingKind::malformed>(e.where_and_problem()));
  }
}

}  // namespace

Backup back_up(const LedgerPaths& from, const std::string& folder, bool with_identities) {
  const LedgerPaths to{folder};
  if (!fs::exists(from.database()))
    throw Error(from.folder, msg("holds no ledger"), instead_of_none(from.database()));
  std::error_code none;
  if (fs::weakly_canonical(folder, none) == fs::weakly_canonical(from.folder, none))
    throw Error(folder, msg("is the ledger itself"), msg("name another folder"));
  const LedgerContent now = read_ledger(from);
  if (!now.findings.empty())
    throw Error(
        from.folder,
        msg("the ledger does not hold ({}), and a backup of it would be taken for one that does",
            now.findings[0].message()),
        msg("see `cavum ledger verify`; to keep it as evidence, copy the folder"));
  make_private_folder(folder);
  const FolderLock lock(folder, msg("cannot be kept to this backup alone"),
                        msg("name another folder"));
  require_place_for(
      read_ledger(from),
      folder);  // as it is by now: whoever held the folder may have put a later state there
  Backup out;
  LedgerContent copy;
  for (bool erased_meanwhile = true;
       erased_meanwhile;) {  // then the entry that erases belongs to the backup too
    copy_database(from.database(), to.database());
    copy = read_ledger(to, AskWitness::no);
    if (!copy.findings.empty())
      throw Error(to.database(), msg("the copy does not hold ({})", copy.findings[0].message()),
                  msg("check the disk, and take it again"));
    out.missing = copy_sessions(copy, from, to, out.copied);
    const auto gone =
        out.missing.empty() ? std::set<std::string>() : erased_recordings(read_ledger(from));
    erased_meanwhile = std::any_of(out.missing.begin(), out.missing.end(),
                                   [&](const std::string& hash) { return gone.contains(hash); });
  }
  out.ledger_id = copy.id;
  out.checkpoint = copy.checkpoints.back();
  remove_erased_recordings(copy, to);
  out.sessions = filed_sessions(copy).size() - out.missing.size();
  if (with_identities) out.identities = copy_identities(copy, from, to);
  out.older_identities = !out.identities && fs::exists(to.identities(), none);
  if (out.older_identities) {
    Identities older(to.identities());
    remove_forgotten(copy, older);
  }
  write_text_file(checkpoint_path(folder),
                  checkpoint_note(copy.id, copy.key_of(out.checkpoint.size), out.checkpoint,
                                  cosignatures_of(copy, out.checkpoint.size)));
  sync_folder_of(folder);
  return out;
}

RestorePlan plan_restore(const std::string& backup, const std::vector<std::string>& receipts,
                         const std::vector<std::string>& notes) {
  const LedgerPaths places{backup};
  RestorePlan plan;
  plan.content = read_ledger(places, AskWitness::no);
  plan.findings = plan.content.findings;
  if (!plan.findings.empty()) return plan;
  const LedgerContent& c = plan.content;
  const History history(c);
  for (const auto& hash : filed_sessions(c))
    if (!has_session(places, hash)) plan.missing_sessions.push_back(hash);
  plan.identities = fs::exists(places.identities());
  check_own_checkpoint(plan, history, checkpoint_path(backup));
  Findings changed;
  for (const auto& w : read_witness(c.id, changed)) {
    if (!is_signed_by_school(c.id, c.key_of(w.size), w))
      changed.push_back(finding<FindingKind::witness_changed>(witness_path(c.id), w.size));
    else
      compare(plan, history, c.id, w, msg("the witness"), {});
  }
  append(plan.findings, changed);
  for (const auto& path : receipts) {
    const json receipt = parse_json_or_null(read_text_file(path));
    const std::string signer = text_in(receipt, "public_key");
    if (const auto wrong =
            check_receipt(receipt, c.has_key(signer) ? signer : c.public_key, nullptr);
        !wrong.empty())
      throw Error(path, wrong[0].message(), msg("use an intact copy"));
    const std::string id = receipt.at("ledger"), text = receipt.at("entry");
    const LedgerEntry entry = read_entry_or_none(text);
    const auto* session = entry.as<SessionEntry>();
    const auto seq = receipt.at("seq").get<std::uint64_t>();
    Message told;
    if (seq >= c.entries.size())
      told = !entry.what
                 ? msg("entry {}: of a kind that this version does not know ({})", seq, path)
             : session == nullptr
                 ? msg("entry {}: {} ({})", seq, kind_name(*entry.what), path)
                 : msg("entry {}: {} of {}, file {} ({})", seq, kind_name(*entry.what),
                       session->candidate, session->file_sha256, path);
    compare(plan, history, id, checkpoint_in(receipt.at("checkpoint"), id, signer, path),
            msg("{}", path), told);
  }
  for (const auto& path : notes) {
    const std::string text = read_text_file(path),
                      key_then =
                          c.key_of(parse_checkpoint(text, c.public_key, path).checkpoint.size);
    const ReadCheckpoint read = parse_checkpoint(text, key_then, path);
    if (!is_signed_by_school(read.ledger_id, key_then, read.checkpoint))
      throw Error(path, msg("the school's signature on it does not hold"),
                  msg("use an intact copy"));
    compare(plan, history, read.ledger_id, read.checkpoint, msg("{}", path), {});
  }
  if (plan.last_seen) {
    const auto first = c.entries.size(),
               last = static_cast<std::size_t>(plan.last_seen->checkpoint.size - 1);
    plan.lost_entries.insert(
        plan.lost_entries.begin(),
        first == last ? msg("entry {}: seen by {}", first, plan.last_seen->what)
                      : msg("entries {} to {}: seen by {}", first, last, plan.last_seen->what));
  }
  return plan;
}

void restore(const std::string& backup, const std::string& folder, const RestorePlan& plan,
             const std::string& reason, const SigningKey& key) {
  if (!plan.findings.empty())
    throw Error(backup, plan.findings[0].message(), msg("restore another backup"));
  if (plan.last_seen &&
      (reason.empty() || reason.size() > k_longest_acceptance || !is_plain_text(reason)))
    throw Error(
        "--accept-loss", msg("gives no reason"),
        msg("say in one line of UTF-8, 1000 bytes at most, why the school accepts the loss; it is kept for ever, so no names"));
  std::error_code none;
  if (fs::exists(folder, none))
    throw Error(folder, msg("is there already"), msg("name a new folder"));
  if (plan.content.public_key != to_hex(key.public_key))
    throw Error(backup, msg("belongs to another school's key"),
                msg("name that key's file with --key, or restore it"));
  const LedgerPaths from{backup}, to{folder};
  make_private_folder(folder);
  std::size_t copied = 0;
  static_cast<void>(copy_sessions(plan.content, from, to, copied));
  static_cast<void>(copy_identities(plan.content, from, to));
  copy_database(from.database(), to.database());
  std::map<std::pair<std::uint64_t, Sha256>, SizeAndRoot> lost;  // each once, by size
  for (const auto& p : plan.lost) lost[{p.size, p.root}] = {p.size, p.root};
  Ledger ledger(folder, key, LedgerUse::restore);
  ledger.append(
      [&](const LedgerContent& c) {
        RestoreEntry entry{
            {c.entries.size(), merkle_root(leaves_of(c))}, {}, plan.missing_sessions};
        for (const auto& [size, one] : lost) entry.lost.push_back(one);
        return entry;
      },
      reason);
  sync_folder_of(folder);
}

}  // namespace cavum::records
