#include "ui/report/ledger_facts.h"

#include <cmath>
#include <map>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "grading/records/decision.h"
#include "grading/records/erasure.h"
#include "grading/records/identities.h"
#include "grading/result/result_json.h"

namespace cavum::report {

using nlohmann::json;

namespace {

/// Per cent of the scale that a session reached, where that counts for a comparison of attempts.
std::optional<double> percent_of(const records::FiledSession& s, ReportReader reader) {
  const json& result = reader == ReportReader::student ? *s.shown : *s.result;
  if (s.doubtful() || !result.is_object() || !result.contains("score") ||
      !result["score"].is_object())
    return std::nullopt;
  const double max = result["score"].value("max", 0.0);
  return max > 0 ? std::optional(100 * result["score"].value("points", 0.0) / max) : std::nullopt;
}

/// How much marks vary from attempt to attempt in the class, and what that leaves of this
/// candidate's. Simulated candidates and people are compared with their like alone.
void add_progress(ReportFiling& f, const records::Registry& registry,
                  const records::FiledSession& session, ReportReader reader) {
  std::map<std::string, std::vector<double>> marks;
  std::vector<double> own;
  for (const auto& s : registry.sessions) {
    if (s.scenario_id != session.scenario_id || s.simulated.empty() != session.simulated.empty() ||
        s.made_up_by)
      continue;
    const auto percent = percent_of(s, reader);
    if (!percent) continue;
    marks[s.candidate].push_back(*percent);
    if (s.candidate == session.candidate && s.seq <= session.seq) own.push_back(*percent);
  }
  std::vector<std::vector<double>> of_class;
  for (auto& [candidate, of_one] : marks) of_class.push_back(std::move(of_one));
  f.scatter = cohort::attempt_scatter(of_class);
  if (f.scatter) f.progress = cohort::progress(own, *f.scatter);
}

/// What a session was filed with, and that another ending of it was.
std::vector<Message> doubts_of(const records::FiledSession& s) {
  std::vector<Message> out;
  for (const auto& f : s.findings) out.push_back(msg("filed with a finding: {}", f.message()));
  for (const auto other : s.contested_by)
    out.push_back(msg("contested by entry {}, another ending of this exam", other));
  return out;
}

/// All of this candidate's at this task that the reader may see.
void list_attempts(ReportFiling& f, const records::Registry& registry,
                   const records::FiledSession& session, ReportReader reader) {
  for (const auto& s : registry.sessions) {
    if (s.candidate != session.candidate || s.scenario_id != session.scenario_id) continue;
    const bool released = !s.shown->is_null();
    if (reader == ReportReader::student && !released) continue;
    const json& result = reader == ReportReader::student ? *s.shown : *s.result;
    ReportAttempt a;
    a.entry = s.seq;
    a.date = utc_text(s.received_utc_ns);
    a.released = reader == ReportReader::student ? released : s.released;
    a.this_one = s.seq == session.seq;
    a.regraded = (reader == ReportReader::student ? s.shown_seq : s.result_seq) != s.seq;
    a.simulated = !s.simulated.empty();
    if (const auto doubts = doubts_of(s); !doubts.empty()) a.doubt = doubts.front();
    if (result.is_object() && result.contains("score") && result["score"].is_object()) {
      a.verdict = grading::verdict_in(result);
      a.points = result["score"].value("points", 0.0);
      a.max = result["score"].value("max", 0.0);
    }
    f.attempts.push_back(std::move(a));
  }
}

}  // namespace

ReportLedger::ReportLedger(const std::string& folder)
    : places{folder}, content(records::read_ledger(places)) {
  if (!content.findings.empty())
    throw Error(folder, msg("does not hold ({})", content.findings.front().message()),
                msg("see `cavum ledger verify {}`", folder));
  registry = records::read_registry(content);
}

const records::FiledSession& ReportLedger::session(const std::string& file_sha256,
                                                   const std::string& path) const {
  for (const auto& s : registry.sessions)
    if (s.file_sha256 == file_sha256) return s;
  throw Error(
      path, msg("was never filed in the ledger {}", places.folder),
      msg("file it with `cavum ledger add {} {}`, or leave --ledger out", places.folder, path));
}

ReportFiling filing_of(const ReportLedger& ledger, const records::FiledSession& session,
                       ReportReader reader, bool with_name) {
  const Message entry = msg("entry {}", session.seq);
  const bool shown = !session.shown->is_null();
  if (reader == ReportReader::student && !shown)
    throw Error(
        entry, msg("is not released, and a student's report is of released results only"),
        session.doubtful()
            ? msg("release it with `cavum ledger release {} --session {} --with-findings`, or use --for instructor",
                  ledger.places.folder, session.seq)
            : msg("release it with `cavum ledger release {} --session {}`, or use --for instructor",
                  ledger.places.folder, session.seq));
  if (with_name && !shown)
    throw Error(msg("--with-name"),
                msg("{} is not released, and names stand with released results only", entry),
                msg("release it first"));
  ReportFiling f;
  f.entry = session.seq;
  f.ledger = ledger.content.id;
  f.school = ledger.content.school;
  f.public_key = ledger.content.public_key;
  f.date = utc_text(session.received_utc_ns);
  f.released = shown;
  f.findings = doubts_of(session);
  if (const records::Regrade* r = regrade_for(session, reader))
    f.regrade = ReportRegrade{r->seq,
                              utc_text(r->utc_ns),
                              r->reason,
                              r->person,
                              grading::verdict_in(*r->result),
                              records::verdict_by_program(session, r->seq)};
  for (const auto& c : ledger.content.checkpoints)  // the one that the receipt of this entry shows
    if (c.size > session.seq) {
      f.root = to_hex(c.root);
      f.entries = c.size;
      break;
    }
  if (with_name) {
    records::Identities identities(ledger.places.identities());
    records::remove_forgotten(ledger.content, identities);
    const auto who = identities.of_pseudonym(session.candidate);
    if (!who)
      throw Error(msg("--with-name"), msg("nobody is known behind {}", session.candidate),
                  msg("the identity was forgotten; leave --with-name out"));
    f.name = who->name.empty() ? who->id : who->name;
  }
  list_attempts(f, ledger.registry, session, reader);
  add_progress(f, ledger.registry, session, reader);
  return f;
}

const records::Regrade* regrade_for(const records::FiledSession& session, ReportReader reader) {
  return session.regrade(reader == ReportReader::student ? session.shown_seq : session.result_seq);
}

Message not_the_filed_result(const records::FiledSession& session, const grading::Result& result,
                             ReportReader reader) {
  constexpr double k_rounding = 1e-5;  // of the JSON
  const json& filed = reader == ReportReader::student ? *session.shown : *session.result;
  const std::string by_program = records::verdict_by_program(
      session, reader == ReportReader::student ? session.shown_seq : session.result_seq);
  const bool same = filed.is_object() && by_program == grading::verdict_name(result.verdict) &&
                    filed.contains("score") &&
                    std::fabs(filed["score"].value("points", -1.0) - result.points) < k_rounding &&
                    std::fabs(filed["score"].value("max", -1.0) - result.max_points) < k_rounding;
  if (same) return {};
  const auto of = [](const std::string& verdict, double points) {
    return msg("{}, {} points", Term{verdict}, as_points(points));
  };
  const Message held = filed.is_object() && filed.contains("score")
                           ? of(filed.value("verdict", ""), filed["score"].value("points", 0.0))
                           : msg("another"),
                ours = of(grading::verdict_name(result.verdict), result.points);
  return reader == ReportReader::student
             ? msg("the released result is {}, and this report's is {}", held, ours)
             : msg("the ledger's result is {}, and this report's is {}", held, ours);
}

void require_released_result(const records::FiledSession& session, const grading::Result& result) {
  if (const Message other = not_the_filed_result(session, result, ReportReader::student);
      !other.empty())
    throw Error(
        msg("entry {}", session.seq), other,
        msg("leave --rubric and --scenario out, or enter the regrade by them and release it; another version of the program may mark "
            "differently"));
}

}  // namespace cavum::report
