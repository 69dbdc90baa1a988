#include "grading/ledger/appeal.h"

#include <fmt/core.h>

#include <algorithm>

#include "grading/ledger/regrade.h"

namespace cavum::ledger {
namespace {

using nlohmann::json;

const FiledSession& appealed(const Registry& registry, std::uint64_t session) {
  const auto found = std::find_if(registry.sessions.begin(), registry.sessions.end(), [&](const FiledSession& s) { return s.seq == session; });
  if (found == registry.sessions.end()) throw Error(fmt::format("--session {}", session), "is no session's entry", "see `cavum ledger show`");
  return *found;
}

}  // namespace

const LedgerEntry& open_appeal(Ledger& ledger, std::uint64_t session, const std::string& reason) {
  require_reason(reason);
  return ledger.append("appeal", [&](const LedgerContent& now) {
    const Registry registry = read_registry(now);
    const FiledSession& s = appealed(registry, session);
    const std::string where = fmt::format("--session {}", session);
    if (!s.result.is_object()) throw Error(where, "has no result", "there is nothing to appeal against");
    if (const Appeal* open = s.open_appeal()) throw Error(where, fmt::format("an appeal is open (entry {})", open->seq), "answer that one first");
    return json{{"session", session}, {"reason", reason}};
  });
}

const LedgerEntry& answer_appeal(Ledger& ledger, std::uint64_t session, const std::string& outcome, const std::string& reason) {
  if (outcome != k_stands && outcome != k_changed) throw Error("--outcome " + outcome, "is none", "say stands or changed");
  require_reason(reason);
  return ledger.append("appeal", [&](const LedgerContent& now) {
    const Registry registry = read_registry(now);
    const FiledSession& s = appealed(registry, session);
    const std::string where = fmt::format("--session {}", session);
    const Appeal* open = s.open_appeal();
    if (open == nullptr) throw Error(where, "no appeal is open", "see `cavum ledger appeal` without --session");
    if (outcome == k_changed && s.result_seq < open->seq)
      throw Error(where, "no other result was entered since the appeal", "enter it first: `cavum ledger regrade` or `cavum ledger decide`");
    return json{{"session", session}, {"answers", open->seq}, {"outcome", outcome}, {"reason", reason}};
  });
}

}  // namespace cavum::ledger
