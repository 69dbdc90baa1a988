#include "grading/records/class_regrade.h"

#include <fmt/core.h>

#include <algorithm>

#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/text.h"
#include "grading/records/reason.h"

namespace cavum::records {
namespace {

using nlohmann::json;

/// Marked anew by the same already.
bool is_entered(const LedgerContent& content, const FiledSession& s, const ClassRegrade& plan,
                const json& result) {
  const Regrade* last = s.regrades.empty() ? nullptr : &s.regrades.back();
  if (last == nullptr || last->seq != s.result_seq || *s.result != result) return false;
  const auto kept = kept_basis(content, *last);
  return kept && kept->rubric_toml == plan.basis.rubric_toml &&
         kept->scenario_toml == plan.basis.scenario_toml && kept->surfaces == plan.basis.surfaces;
}

bool are_the_same(const MarkedAgain& a, const MarkedAgain& b) {
  return a.session == b.session && a.result_seq == b.result_seq && a.file_sha256 == b.file_sha256;
}

}  // namespace

bool MarkedAgain::other_verdict() const {
  return text_in(*before, "verdict") != text_in(after, "verdict");
}
bool MarkedAgain::other_points() const {
  const json &then = member_of(*before, "score"), &now = member_of(after, "score");
  return member_of(then, "points") != member_of(now, "points") ||
         member_of(then, "max") != member_of(now, "max");
}

ClassRegrade plan_class_regrade(const Registry& registry, const std::string& exam,
                                RegradeBasis basis) {
  ClassRegrade plan{exam, std::move(basis), {}, 0};
  for (const auto& s : registry.sessions) {
    if (s.scenario_id != exam) continue;
    if (s.motion_erased_by || !s.result->is_object()) {
      ++plan.left_out;
      continue;
    }
    const Regrade* counts = s.regrade(s.result_seq);
    plan.sessions.push_back({s.seq,
                             s.result_seq,
                             s.candidate,
                             s.file_sha256,
                             counts != nullptr && !counts->person.empty(),
                             s.shown_seq != 0,
                             s.result,
                             {}});
  }
  if (plan.sessions.empty())
    throw Error(msg("exam {}", one_line(exam)), msg("has no session that can be marked"),
                msg("see `cavum ledger show`"));
  return plan;
}

pool::Work work_of(const ClassRegrade& plan, const std::string& ledger_folder) {
  pool::Work work;
  work.what = pool::What::regrade;
  work.folder = ledger_folder;
  work.rubric_toml = plan.basis.rubric_toml, work.scenario_toml = plan.basis.scenario_toml,
  work.surfaces = plan.basis.surfaces;
  for (const auto& s : plan.sessions)
    work.sessions.push_back(fmt::format("sessions/{}.cavum", s.file_sha256));
  return work;
}

void take_lines(ClassRegrade& plan, const std::vector<std::string>& lines,
                const std::string& ledger_folder) {
  for (std::size_t i = 0; i < plan.sessions.size(); ++i) {
    MarkedAgain& s = plan.sessions[i];
    const json line = parse_json_or_null(lines.at(i), k_json_part);
    if (!member_of(line, "result").is_object())
      throw Error(
          msg("entry {}", s.session),
          lines[i].empty() ? msg("could not be marked") : pool::error_in(line),
          msg("nothing was entered; correct the rubric or scenario, or mark the others by --session"));
    if (text_in(line, "sha256") != s.file_sha256)
      throw Error(msg("entry {}", s.session), msg("its recording is another one by now"),
                  msg("see `cavum ledger verify {}`", ledger_folder));
    s.after = member_of(line, "result");
  }
}

std::size_t enter_class_regrade(Ledger& ledger, const ClassRegrade& plan,
                                const std::string& reason) {
  require_reason(reason);
  const StoredParts parts = stored_parts(plan.basis);
  return ledger.append_all(
      [&](const LedgerContent& now) {
        const Registry& registry = ledger.registry();
        const ClassRegrade fresh = plan_class_regrade(registry, plan.exam, {});
        if (!std::equal(fresh.sessions.begin(), fresh.sessions.end(), plan.sessions.begin(),
                        plan.sessions.end(), are_the_same))
          throw Error(msg("exam {}", one_line(plan.exam)),
                      msg("has other sessions or results by now than those that were marked"),
                      msg("nothing was entered; begin anew"));
        std::vector<Entry> entries;
        for (const auto& s : plan.sessions)
          if (!is_entered(now, *registry.session(s.session), plan, s.after))
            entries.emplace_back(RegradeEntry{s.session, make_opening(s.after), parts.by, ""});
        return entries;
      },
      reason, parts.documents);
}

}  // namespace cavum::records
