#include "grading/records/erasure.h"

#include <filesystem>

#include "engine/base/write_file.h"
#include "grading/records/entry_text.h"
#include "grading/records/reason.h"

namespace cavum::records {
namespace {

/// What an entry has that can be erased.
bool has_part(const LedgerEntry& e, Part part) {
  if (!e.what) return false;
  return part == Part::motion ? e.as<SessionEntry>() != nullptr
                              : openings_of(*e.what).contains(part);
}

void add(std::vector<ErasedPart>& list, const LedgerContent& c, const LedgerEntry& e, Part part) {
  if (has_part(e, part) && !erased_by(c.erased, e.seq, part)) list.push_back({e.seq, part});
}

/// What of the session of entry `seq` is still there.
void add_session(std::vector<ErasedPart>& list, const LedgerContent& c, const ErasureCommand& wish,
                 std::uint64_t seq) {
  if (wish.motion) add(list, c, c.entries[seq], Part::motion);
  if (!wish.results) return;
  for (const auto& e : c.entries)
    if (const auto* regrade = e.as<RegradeEntry>();
        e.seq == seq || (regrade != nullptr && regrade->session == seq))
      for (const Part part : {Part::result, Part::sealed}) add(list, c, e, part);
}

/// What of it is still there.
std::vector<ErasedPart> select_erasures(const LedgerContent& c, const ErasureCommand& wish) {
  std::set<std::uint64_t> sessions(wish.sessions.begin(), wish.sessions.end());
  for (const auto seq : sessions)
    if (seq >= c.entries.size() || c.entries[seq].as<SessionEntry>() == nullptr)
      throw Error(msg("entry {}", seq), msg("is no session's entry"),
                  msg("see `cavum ledger show`"));
  if (wish.received_before)
    for (const auto& e : c.entries)
      if (e.as<SessionEntry>() != nullptr && e.utc_ns < *wish.received_before)
        sessions.insert(e.seq);
  std::vector<ErasedPart> list;
  for (const auto seq : sessions) add_session(list, c, wish, seq);
  return list;
}

}  // namespace

const std::vector<ErasedPart>& erased_parts(const LedgerEntry& e) {
  static const std::vector<ErasedPart> k_none;
  const auto* erase = e.as<EraseEntry>();
  const auto* forget = e.as<ForgetEntry>();
  return erase != nullptr ? erase->erased : forget != nullptr ? forget->erased : k_none;
}

Erased read_erased(const std::vector<LedgerEntry>& entries, Findings& findings) {
  Erased out;
  for (const auto& e : entries)
    for (const auto& [seq, part] : erased_parts(e)) {
      if (seq == 0 || seq >= e.seq || seq >= entries.size() || !has_part(entries[seq], part))
        findings.push_back(
            finding<FindingKind::erases_void>(Term{word_of(part)}, seq).in_entry(e.seq));
      else
        out[seq].emplace(part, e.seq);
    }
  return out;
}

std::optional<std::uint64_t> erased_by(const Erased& erased, std::uint64_t seq, Part what) {
  const auto of = erased.find(seq);
  if (of == erased.end()) return {};
  const auto found = of->second.find(what);
  return found == of->second.end() ? std::nullopt : std::optional(found->second);
}

std::vector<std::string> taken_out_by(const LedgerContent& c, const LedgerEntry& by) {
  std::vector<std::string> out;
  for (const auto& [seq, part] : erased_parts(by)) {
    if (seq >= c.entries.size() || !c.entries[seq].what) continue;  // read_erased names it
    const auto openings = openings_of(*c.entries[seq].what);
    if (const auto found = openings.find(part); found != openings.end())
      out.push_back(found->second->sha256);
  }
  return out;
}

std::vector<ErasedPart> erase(Ledger& ledger, const ErasureCommand& wish,
                              const std::string& reason) {
  require_reason(reason);
  std::vector<ErasedPart> erased;
  ledger.append_all(
      [&](const LedgerContent& now) -> std::vector<Entry> {
        erased = select_erasures(now, wish);
        if (erased.empty()) return {};
        return {EraseEntry{erased}};
      },
      reason);
  remove_erased_recordings(ledger.content(), ledger.places());
  return erased;
}

void forget(Ledger& ledger, const std::vector<std::string>& pseudonyms,
            const ErasureCommand& wish) {
  for (const auto& pseudonym : pseudonyms)
    ledger.append([&](const LedgerContent& now) {
      ErasureCommand of = wish;
      of.sessions.clear();
      for (const auto& e : now.entries)
        if (const auto* session = e.as<SessionEntry>();
            session != nullptr && session->candidate == pseudonym)
          of.sessions.push_back(e.seq);
      ForgetEntry entry{pseudonym, select_erasures(now, of)};
      for (const auto& e :
           now.entries)  // what was said of him is about a person whom nobody knows any more
        if (const auto* incident = e.as<IncidentEntry>();
            incident != nullptr && incident->candidate == pseudonym)
          add(entry.erased, now, e, Part::words);
      return entry;
    });
  remove_erased_recordings(ledger.content(), ledger.places());
}

std::size_t remove_forgotten(const LedgerContent& c, Identities& identities) {
  std::size_t removed = 0;
  for (const auto& e : c.entries)
    if (const auto* forgotten = e.as<ForgetEntry>();
        forgotten != nullptr && identities.forget(forgotten->candidate))
      ++removed;
  return removed;
}

Identities sound_identities(const Ledger& ledger) {
  Identities identities(ledger.places().identities());
  if (const auto wrong = identities.check(ledger.key()); !wrong.empty())
    throw Error(ledger.places().identities(), wrong[0].message(),
                msg("restore the file from its backup: marks would go to somebody else"));
  remove_forgotten(ledger.content(), identities);
  return identities;
}

std::set<std::string> erased_recordings(const LedgerContent& c) {
  std::set<std::string> gone,
      kept;  // the same file can be filed twice, the second time with findings
  for (const auto& e : c.entries)
    if (const auto* session = e.as<SessionEntry>())
      (erased_by(c.erased, e.seq, Part::motion) ? gone : kept).insert(session->file_sha256);
  std::erase_if(gone,
                [&](const std::string& hash) { return kept.contains(hash) || hash.size() != 64; });
  return gone;
}

std::size_t remove_erased_recordings(const LedgerContent& c, const LedgerPaths& places) {
  std::size_t removed = 0;
  for (const auto& hash : erased_recordings(c)) {
    const std::string path = places.session(hash);
    std::error_code none;
    if (!std::filesystem::exists(path, none)) continue;
    std::error_code why;
    std::filesystem::remove(path, why);  // somebody else may have been quicker
    if (why)
      throw Error(path, msg("is erased and cannot be removed"),
                  msg("make the folder writable, and run `cavum ledger erase` again"));
    sync_folder_of(path);
    ++removed;
  }
  return removed;
}

}  // namespace cavum::records
