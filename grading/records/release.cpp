#include "grading/records/release.h"

#include <algorithm>

#include "grading/records/ledger_error.h"
#include "grading/records/reason.h"

namespace cavum::records {
namespace {

template <class T>
bool holds(const std::vector<T>& list, const T& wanted) {
  return std::find(list.begin(), list.end(), wanted) != list.end();
}

std::string entries_of(const FiledSession& s) {
  std::vector<std::uint64_t> all = s.contested_by;
  all.push_back(s.seq);
  std::sort(all.begin(), all.end());
  std::string out;
  for (std::size_t i = 0; i < all.size(); ++i)
    out += (i == 0 ? "" : i + 1 == all.size() ? " and " : ", ") + std::to_string(all[i]);
  return out;
}

/// An entry that was named by its number is released, or it is said why not.
void require_releasable(const Registry& registry, const ReleaseCommand& wish,
                        const FiledSession& s) {
  const Message where = msg("entry {}", s.seq);
  for (const auto other : s.contested_by)
    if (holds(wish.sessions, other))
      throw Error(LedgerError::contested, where,
                  msg("is an ending of the same exam as entry {}, and one counts", other),
                  msg("choose one of them"));
  if (const FiledSession* other = registry.chosen_instead_of(s))
    throw Error(LedgerError::contested, where,
                msg("entry {}, another ending of the same exam, was chosen before and alone counts",
                    other->seq),
                msg("it stays unreleased"));
  if (s.made_up_by)
    throw Error(where, msg("a makeup sitting was given in its place (entry {})", *s.made_up_by),
                msg("the makeup's result is released"));
  if (const FiledSession* other = registry.shown_adjacent(s))
    throw Error(where, msg("entry {}, another sitting of the same exam, is released", other->seq),
                msg("take that one back first"));
  if (s.result_erased_by)
    throw Error(LedgerError::erased, where,
                msg("its result was erased (entry {})", *s.result_erased_by),
                msg("there is nothing left to release"));
  if (s.questioned() && !wish.with_findings)
    throw Error(LedgerError::questioned, where,
                s.contested_by.empty()
                    ? msg("was filed with findings")
                    : msg("is one of several endings of the same exam (entries {})", entries_of(s)),
                msg("look at it; to release it all the same, add --with-findings"));
}

}  // namespace

Release select_results(const Registry& registry, const ReleaseCommand& wish) {
  for (const auto seq : wish.sessions)
    if (registry.session(seq) == nullptr)
      throw Error(LedgerError::unknown, msg("entry {}", seq), msg("is no session's entry"),
                  msg("see `cavum ledger show`"));
  for (const auto& c : wish.candidates)
    if (std::none_of(registry.sessions.begin(), registry.sessions.end(),
                     [&](const FiledSession& s) { return s.candidate == c; }))
      throw Error("--candidate " + c, msg("has no session in this ledger"),
                  msg("see `cavum ledger show`"));
  Release out;
  const auto otherwise = registry.marked_otherwise();
  for (const auto& s : registry.sessions) {
    const bool by_entry = holds(wish.sessions, s.seq),
               by_candidate = holds(wish.candidates, s.candidate);
    if (by_entry) require_releasable(registry, wish, s);
    const bool undecided =
        !s.contested_by.empty() && !s.chosen && registry.chosen_instead_of(s) == nullptr;
    if (by_candidate && undecided && !by_entry)
      throw Error(
          LedgerError::contested, Name{"--candidate " + s.candidate},
          msg("several endings of one exam are filed, entries {}, and one counts", entries_of(s)),
          msg("choose it with --session and --with-findings"));
    if (s.made_up_by) continue;
    // what was released before somebody contested it is not chosen yet
    if ((!wish.all && !by_entry && !by_candidate) || (s.released && !(by_entry && s.doubtful())) ||
        s.result_erased_by)
      continue;
    const bool by_name = (by_entry || by_candidate) && wish.with_findings;
    if ((wish.all && (s.taken_back() || otherwise.contains(s.seq))) ||
        (s.questioned() && !by_name) || registry.chosen_instead_of(s) != nullptr ||
        registry.shown_adjacent(s) != nullptr)
      ++out.withheld;
    else if (s.undecided() && !wish.undecided)
      ++out.to_decide;
    else
      out.results.push_back(s.result_seq);
  }
  return out;
}

Release release_results(Ledger& ledger, const ReleaseCommand& wish) {
  Release out;
  ledger.append_all([&](const LedgerContent&) -> std::vector<Entry> {
    out = select_results(ledger.registry(), wish);
    if (out.results.empty()) return {};
    return {ReleaseEntry{out.results}};
  });
  return out;
}

const LedgerEntry& retract_results(Ledger& ledger, const std::vector<std::uint64_t>& sessions,
                                   const std::string& reason) {
  if (sessions.empty())
    throw Error("--session", msg("is missing"),
                msg("name the entries of the sessions whose results are taken back"));
  require_reason(reason);
  return ledger.append(
      [&](const LedgerContent&) {
        RetractEntry entry;
        for (const auto seq : sessions) {
          const FiledSession* s = ledger.registry().session(seq);
          const Message where = msg("entry {}", seq);
          if (s == nullptr)
            throw Error(where, msg("is no session's entry"), msg("see `cavum ledger show`"));
          if (s->shown_seq == 0)
            throw Error(LedgerError::not_now, where, msg("has no released result"),
                        msg("there is nothing to take back"));
          entry.results.push_back(s->shown_seq);
        }
        return entry;
      },
      reason);
}

}  // namespace cavum::records
