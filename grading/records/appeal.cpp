#include "grading/records/appeal.h"

#include "engine/base/json_fields.h"
#include "grading/records/ledger_error.h"
#include "grading/records/reason.h"

namespace cavum::records {
namespace {

using nlohmann::json;

const FiledSession& appealed(const Registry& registry, std::uint64_t session) {
  const FiledSession* found = registry.session(session);
  if (found == nullptr)
    throw Error(msg("entry {}", session), msg("is no session's entry"),
                msg("see `cavum ledger show`"));
  return *found;
}

/// What a candidate reads first of a result.
json essence(const json& result) {
  if (!result.is_object()) return {};
  return {member_of(result, "verdict"), member_of(member_of(result, "score"), "points")};
}

}  // namespace

bool changed_since(const FiledSession& session, const Appeal& appeal) {
  const json* then = &*session.filed;
  for (const auto& r : session.regrades)
    if (r.seq < appeal.seq) then = &*r.result;
  return session.result_seq > appeal.seq && essence(*session.result) != essence(*then);
}

const LedgerEntry& open_appeal(Ledger& ledger, std::uint64_t session, const std::string& reason) {
  require_reason(reason);
  return ledger.append(
      [&](const LedgerContent&) {
        const FiledSession& s = appealed(ledger.registry(), session);
        const Message where = msg("entry {}", session);
        if (!s.result->is_object())
          throw Error(where, msg("has no result"), msg("there is nothing to appeal against"));
        if (const Appeal* open = s.open_appeal())
          throw Error(LedgerError::twice, where, msg("an appeal is open (entry {})", open->seq),
                      msg("answer that one first"));
        return AppealEntry{session};
      },
      reason);
}

const LedgerEntry& answer_appeal(Ledger& ledger, std::uint64_t session, Outcome outcome,
                                 const std::string& reason) {
  require_reason(reason);
  return ledger.append(
      [&](const LedgerContent&) {
        const FiledSession& s = appealed(ledger.registry(), session);
        const Message where = msg("entry {}", session);
        const Appeal* open = s.open_appeal();
        if (open == nullptr)
          throw Error(LedgerError::unknown, where, msg("no appeal is open"),
                      msg("see `cavum ledger appeal` without --session"));
        const bool changed = changed_since(s, *open);
        if (outcome == Outcome::changed && !changed)
          throw Error(LedgerError::not_now, where,
                      msg("no other result was entered since the appeal"),
                      msg("enter it first: `cavum ledger regrade` or `cavum ledger decide`"));
        if (outcome == Outcome::stands && changed)
          throw Error(LedgerError::another_state, where,
                      msg("another result was entered since the appeal"),
                      msg("look at that one; if it is right, answer that the result was changed"));
        return AnswerEntry{session, open->seq, outcome};
      },
      reason);
}

}  // namespace cavum::records
