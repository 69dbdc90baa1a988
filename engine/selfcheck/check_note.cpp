#include "engine/selfcheck/check_note.h"

#include <fmt/core.h>

#include "engine/base/error.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/text.h"
#include "engine/session/motion_source.h"
#include "engine/session/session_reader.h"

namespace cavum {

SessionCheck read_session_check(const std::string& note, const std::string& where) {
  const nlohmann::json j = parse_json(note, where, k_json_part);
  SessionCheck s;
  s.check = read_check_entry(member_of(j, "check"), where);
  if (s.check.kind != CheckEntry::Kind::check) throw Error(where, msg("holds no check"), msg("use an intact copy"));
  if (member_of(j, "decision").is_null()) return s;
  s.decision = read_check_entry(member_of(j, "decision"), where);
  if (s.decision->kind != CheckEntry::Kind::decision) throw Error(where, msg("holds no decision"), msg("use an intact copy"));
  return s;
}

std::string in_words(const SessionCheck& s) {
  const ArmFigures& f = s.check.figures;
  std::string words =
      fmt::format("{}, checked on {}: {}", one_line(s.check.station), utc_text(s.check.utc_ns), outcome_name(s.check.verdict.outcome));
  if (f.doubt.empty())
    words += fmt::format(" (friction {:.2f} N, step {:.4f} mm, {:.0f} Hz, {} earlier checks)", f.friction_n(), f.quantum_mm, f.rate_hz,
                         s.check.verdict.compared);
  if (s.check.verdict.outcome == CheckOutcome::changed || s.check.verdict.outcome == CheckOutcome::doubtful)
    words += "; " + one_line(in_words(s.check.verdict));
  if (s.check.verdict.outcome == CheckOutcome::changed) words += "; since " + utc_text(s.check.since_utc_ns);
  if (s.decision)
    words += fmt::format("; the {} decided to {}{}", s.decision->by, s.decision->go_on ? "go on" : "stop",
                         s.decision->reason.empty() ? "" : ": " + one_line(s.decision->reason));
  return words;
}

SessionCheckFindings check_of_session(const SessionReader& session) {
  SessionCheckFindings out;
  const std::string note = session.fact(std::string("note.") + k_self_check_note);
  if (note.empty()) return out;
  SessionCheck s;
  try {
    s = read_session_check(note, "the station's self-check in the session");
  } catch (const Error& e) {
    out.findings.emplace_back(e.what());
    return out;
  }
  const auto wrong = [&out](const char* what) { out.findings.emplace_back(std::string("the station's self-check ") + what); };
  const std::string key = session.fact("station_key");
  if (s.check.station_key != key || (s.decision && s.decision->station_key != key)) wrong("is of another station than the session's");
  if (s.check.stylus.id != session.fact(k_source_name_fact) || s.check.stylus.serial != session.fact(k_source_serial_fact))
    wrong("is of another stylus than the session's");
  if (s.check.utc_ns > session.created().utc_ns) wrong("is later than the session");
  if (s.decision && (!(s.decision->stylus == s.check.stylus) || s.decision->utc_ns < s.check.utc_ns))
    wrong("and the decision on it do not belong together");
  if (s.check.verdict.outcome == CheckOutcome::changed && !(s.decision && s.decision->go_on))
    wrong("found a change, and nobody decided to go on with it");
  out.remarks.push_back("self-check of " + in_words(s));
  return out;
}

}  // namespace cavum
