#include "grading/ledger/erasure.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "engine/base/json_fields.h"
#include "engine/base/text.h"
#include "engine/base/write_file.h"

namespace cavum::ledger {
namespace {

using nlohmann::json;

/// What an entry has that can be erased.
std::set<std::string> erasable_of(const LedgerEntry& e) {
  std::set<std::string> out;
  if (e.kind == "session") out.insert(k_motion);
  if (!tells_of_people(e.kind)) return out;
  for (const char* name : {k_result, k_sealed, k_words})
    if (member_of(e.body, "opens").contains(name)) out.insert(name);
  if (!text_in(e.body, "result_sha256").empty()) out.insert(k_result);
  return out;
}

void add(json& list, const LedgerContent& c, const LedgerEntry& e, const char* what) {
  if (erasable_of(e).contains(what) && !erased_by(c.erased, e.seq, what)) list.push_back({{"entry", e.seq}, {"what", what}});
}

/// What of the session of entry `seq` is still there.
void add_session(json& list, const LedgerContent& c, const ErasureWish& wish, std::uint64_t seq) {
  if (wish.motion) add(list, c, c.entries[seq], k_motion);
  if (!wish.results) return;
  for (const auto& e : c.entries)
    if (e.seq == seq || (e.kind == "regrade" && whole_in(e.body, "session") == static_cast<std::int64_t>(seq)))
      for (const char* what : {k_result, k_sealed}) add(list, c, e, what);
}

}  // namespace

Erased read_erased(const std::vector<LedgerEntry>& entries, std::vector<std::string>& findings) {
  Erased out;
  for (const auto& e : entries) {
    if (e.kind != "erase" && e.kind != "forget") continue;
    for (const json& one : member_of(e.body, "erased")) {
      const std::int64_t seq = whole_in(one, "entry");
      const std::string what = text_in(one, "what");
      if (seq <= 0 || seq >= static_cast<std::int64_t>(e.seq) || !erasable_of(entries.at(static_cast<std::size_t>(seq))).contains(what))
        findings.push_back(fmt::format("entry {}: erases what is not there: '{}' of entry {}", e.seq, one_line(what), seq));
      else
        out[static_cast<std::uint64_t>(seq)].emplace(what, e.seq);
    }
  }
  return out;
}

std::optional<std::uint64_t> erased_by(const Erased& erased, std::uint64_t seq, const std::string& what) {
  const auto of = erased.find(seq);
  if (of == erased.end()) return {};
  const auto found = of->second.find(what);
  return found == of->second.end() ? std::nullopt : std::optional(found->second);
}

TakenOut taken_out_by(const LedgerContent& c, const json& body) {
  TakenOut out;
  for (const json& one : member_of(body, "erased")) {
    const std::int64_t seq = whole_in(one, "entry");
    if (seq < 0 || seq >= static_cast<std::int64_t>(c.entries.size())) continue;  // read_erased names it
    const auto& e = c.entries[static_cast<std::size_t>(seq)];
    const std::string what = text_in(one, "what"), hash = text_in(member_of(e.body, "opens"), what.c_str());
    if (!hash.empty())
      out.openings.push_back(hash);
    else if (what == k_result)
      out.attachments.push_back(e.seq);
  }
  return out;
}

json select_erasures(const LedgerContent& c, const ErasureWish& wish) {
  std::set<std::uint64_t> sessions(wish.sessions.begin(), wish.sessions.end());
  for (const auto seq : sessions)
    if (seq >= c.entries.size() || c.entries[seq].kind != "session")
      throw Error(fmt::format("--session {}", seq), "is no session's entry", "see `cavum ledger show`");
  if (wish.received_before)
    for (const auto& e : c.entries)
      if (e.kind == "session" && e.utc_ns < *wish.received_before) sessions.insert(e.seq);
  json list = json::array();
  for (const auto seq : sessions) add_session(list, c, wish, seq);
  return list;
}

json erase(Ledger& ledger, const ErasureWish& wish, const std::string& reason) {
  constexpr std::size_t k_longest = 2000;
  if (reason.size() > k_longest || !is_seen_text(reason))
    throw Error("--reason", "is no line of text of at most 2000 bytes", "say why, without names: it is kept for ever");
  json erased;
  struct Nothing {};
  try {
    ledger.append("erase", [&](const LedgerContent& now) -> json {
      erased = select_erasures(now, wish);
      if (erased.empty()) throw Nothing();
      return {{"erased", erased}, {"reason", reason}};
    });
  } catch (const Nothing&) {
  }
  remove_erased_recordings(ledger.content(), ledger.places());
  return erased;
}

void forget(Ledger& ledger, const std::vector<std::string>& pseudonyms, const ErasureWish& wish) {
  for (const auto& pseudonym : pseudonyms)
    ledger.append("forget", [&](const LedgerContent& now) -> json {
      ErasureWish of = wish;
      of.sessions.clear();
      for (const auto& e : now.entries)
        if (e.kind == "session" && text_in(e.body, "candidate") == pseudonym) of.sessions.push_back(e.seq);
      json erased = select_erasures(now, of);
      for (const auto& e : now.entries)  // what was said of him is about a person whom nobody knows any more
        if (e.kind == "incident" && text_in(e.body, "candidate") == pseudonym) add(erased, now, e, k_words);
      return {{"candidate", pseudonym}, {"erased", erased}};
    });
  remove_erased_recordings(ledger.content(), ledger.places());
}

std::size_t remove_forgotten(const LedgerContent& c, Identities& identities) {
  std::size_t removed = 0;
  for (const auto& e : c.entries)
    if (e.kind == "forget" && identities.forget(text_in(e.body, "candidate"))) ++removed;
  return removed;
}

Identities sound_identities(const Ledger& ledger) {
  Identities identities(ledger.places().identities());
  if (const auto wrong = identities.check(ledger.key()); !wrong.empty())
    throw Error(ledger.places().identities(), wrong[0], "restore the file from its backup: marks would go to somebody else");
  remove_forgotten(ledger.content(), identities);
  return identities;
}

std::set<std::string> erased_recordings(const LedgerContent& c) {
  std::set<std::string> gone, kept;  // the same file can be filed twice, the second time with findings
  for (const auto& e : c.entries)
    if (e.kind == "session") (erased_by(c.erased, e.seq, k_motion) ? gone : kept).insert(text_in(e.body, "file_sha256"));
  std::erase_if(gone, [&](const std::string& hash) { return kept.contains(hash) || hash.size() != 64; });
  return gone;
}

std::size_t remove_erased_recordings(const LedgerContent& c, const LedgerPlaces& places) {
  std::size_t removed = 0;
  for (const auto& hash : erased_recordings(c)) {
    const std::string path = places.session(hash);
    std::error_code none;
    if (!std::filesystem::exists(path, none)) continue;
    std::error_code why;
    std::filesystem::remove(path, why);  // somebody else may have been quicker
    if (why) throw Error(path, "is erased and cannot be removed", "make the folder writable, and run `cavum ledger erase` again");
    sync_folder_of(path);
    ++removed;
  }
  return removed;
}

}  // namespace cavum::ledger
