#include "grading/records/decision.h"

#include "engine/base/json_fields.h"
#include "engine/base/text.h"
#include "grading/records/ledger_error.h"
#include "grading/records/reason.h"
#include "grading/result/finding.h"

namespace cavum::records {
namespace {

using nlohmann::json;

void require_person(const std::string& text) {
  if (text.empty() || text.size() > k_longest_person || !is_plain_text(text))
    throw Error("--person",
                text.size() > k_longest_person ? msg("is longer than {} bytes", k_longest_person)
                                               : msg("is no line of text"),
                msg("say in one line of UTF-8 who decides: it is kept for ever"));
}

/// The result of a session that a person has to decide. Throws Error.
const FiledSession& undecided_session(const Registry& registry, std::uint64_t session) {
  const Message where = msg("entry {}", session);
  const FiledSession* found = registry.session(session);
  if (found == nullptr)
    throw Error(where, msg("is no session's entry"),
                msg("see `cavum ledger decide` without --session"));
  if (found->made_up_by)
    throw Error(LedgerError::contested, where,
                msg("does not count: the makeup sitting of entry {} counts in its place",
                    *found->made_up_by),
                msg("decide the makeup sitting's own result"));
  if (found->undecided() || (found->open_appeal() != nullptr && found->result->is_object()))
    return *found;
  if (const Regrade* r = found->regrade(found->result_seq); r != nullptr && !r->person.empty())
    throw Error(LedgerError::twice, where,
                msg("was decided by {} (entry {}): {}", r->person, r->seq,
                    found->result->value("verdict", "")),
                msg("nothing was changed; after an appeal it can be decided anew"));
  throw Error(LedgerError::not_now, where,
              found->result->is_object()
                  ? msg("its verdict is {}: the program leaves nothing to a person",
                        found->result->value("verdict", ""))
                  : msg("has no result"),
              msg("nothing was changed; after an appeal it can be decided anew"));
}

}  // namespace

std::vector<ToDecide> review_queue(const Registry& registry) {
  std::vector<ToDecide> queue;
  for (const FiledSession& s : registry.sessions) {
    if (!s.undecided() || s.made_up_by || registry.chosen_instead_of(s) != nullptr) continue;
    const json& score = s.result->at("score");
    ToDecide d{s.seq,
               s.candidate,
               s.scenario_id,
               score.at("points").get<double>(),
               score.at("max").get<double>(),
               {}};
    for (const grading::Finding& f : grading::findings_in(member_of(*s.result, "verdict_reasons")))
      d.reasons.push_back(grading::fact_of(f));
    queue.push_back(std::move(d));
  }
  return queue;
}

grading::Verdict decided_verdict(const std::string& word) {
  for (const auto verdict : {grading::Verdict::pass, grading::Verdict::fail})
    if (word == grading::verdict_name(verdict)) return verdict;
  throw Error("--verdict " + one_line(word), msg("is none that a person gives"),
              msg("say pass or fail"));
}

const LedgerEntry& enter_decision(Ledger& ledger, std::uint64_t session, const Decision& decision) {
  static_cast<void>(decided_verdict(grading::verdict_name(decision.verdict)));
  require_person(decision.person);
  require_reason(decision.reason);
  return ledger.append(
      [&](const LedgerContent&) {
        const FiledSession& s = undecided_session(ledger.registry(), session);
        json result = *s.result;
        result["decision"] = {{"verdict_before", result.at("verdict")},
                              {"person", decision.person}};
        result["verdict"] = grading::verdict_name(decision.verdict);
        RegradeEntry entry{session, make_opening(result), {}, decision.person};
        if (const Regrade* before = s.regrade(s.result_seq))
          entry.by = before->documents;  // what the decided result was marked by, this one is, too
        return entry;
      },
      decision.reason);
}

std::string verdict_by_program(const FiledSession& session, std::uint64_t entry) {
  const json* marked = &*session.filed;
  for (const Regrade& r : session.regrades)
    if (r.seq <= entry && r.person.empty()) marked = &*r.result;
  return text_in(*marked, "verdict");
}

}  // namespace cavum::records
