#include "grading/records/passback.h"

#include <fmt/core.h>

#include <algorithm>

#include "engine/base/json_fields.h"
#include "engine/base/text.h"
#include "engine/session/session.h"

namespace cavum::records {
namespace {

using nlohmann::json;

constexpr std::size_t k_longest_answer = 300;

/// What is known of one candidate.
struct Candidate {
  const FiledSession* counts = nullptr;  // the last attempt that is released; null: none is
  std::uint64_t last_session = 0;
  std::int64_t changed_utc_ns = 0;      // when something was last released, or taken back
  const PassbackEntry* sent = nullptr;  // the last one to this column
};

json score_of(const Candidate& c, const std::map<std::string, ExamScale>& scales, Wording say) {
  json score = {{"timestamp", utc_ms_text(c.changed_utc_ns)}, {"activityProgress", "Completed"}};
  if (c.counts == nullptr) {
    score["gradingProgress"] = "Pending";  // without scoreGiven: the platform clears what it has
  } else if (const ExportedGrade grade = exported_grade(*c.counts, scales); grade.grade.is_null()) {
    score["gradingProgress"] = "PendingManual";
  } else {
    score["gradingProgress"] = "FullyGraded";
    score["scoreGiven"] = grade.grade;
    score["scoreMaximum"] = grade.max;
    score["comment"] = feedback_text(grade, say);
  }
  return score;
}

}  // namespace

std::vector<ScoreDue> scores_due(const LedgerContent& content, const Registry& registry,
                                 Identities& identities, const std::string& exam,
                                 const std::string& line_item, Wording say, bool again) {
  std::map<std::string, Candidate> candidates;
  std::map<std::uint64_t, std::string> whose;
  for (const auto& s : registry.sessions) {
    whose[s.seq] = s.candidate;
    if (s.scenario_id != exam || !s.simulated.empty()) continue;
    Candidate& c = candidates[s.candidate];
    c.last_session = s.seq;
    if (s.shown->is_object()) c.counts = &s;
    c.changed_utc_ns = std::max(c.changed_utc_ns, s.released_utc_ns);
    if (s.retracted_by)
      c.changed_utc_ns = std::max(c.changed_utc_ns, content.entries.at(*s.retracted_by).utc_ns);
  }
  for (const auto& p : registry.passbacks)
    if (const auto found = whose.find(p.session);
        p.line_item == line_item && found != whose.end() && candidates.contains(found->second))
      candidates[found->second].sent = &p;
  const auto scales = own_scales(registry);
  std::vector<ScoreDue> out;
  for (const auto& [pseudonym, c] : candidates) {
    const std::uint64_t result = c.counts == nullptr ? 0 : c.counts->shown_seq;
    const bool known =
        c.sent != nullptr && c.sent->result == result && (c.sent->accepted() || !again);
    if (known || (result == 0 && (c.sent == nullptr || c.changed_utc_ns == 0))) continue;
    const auto identity = identities.of_pseudonym(pseudonym);
    if (!identity || identity->id.empty()) continue;  // forgotten
    out.push_back({c.counts == nullptr ? c.last_session : c.counts->seq, result, identity->id,
                   score_of(c, scales, say)});
  }
  return out;
}

const LedgerEntry& enter_passback(Ledger& ledger, const ScoreDue& sent, const std::string& platform,
                                  const std::string& line_item, int status,
                                  const std::string& answer) {
  std::string words = one_line(answer).substr(0, k_longest_answer);
  words.resize(whole_characters(words));
  return ledger.append([&](const LedgerContent&) {
    return PassbackEntry{sent.session, sent.result, platform, line_item, status, words};
  });
}

}  // namespace cavum::records
