#include "engine/device/selfcheck/check_note.h"

#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/session/motion_source.h"
#include "engine/session/session_reader.h"

namespace cavum {

SessionCheck read_session_check(const std::string& note, const Where& where) {
  const nlohmann::json j = parse_json(note, where, k_json_part);
  SessionCheck s;
  s.check = read_check_entry(member_of(j, "check"), where);
  if (s.check.kind != CheckEntry::Kind::check)
    throw Error(where, msg("holds no check"), msg("use an intact copy"));
  if (member_of(j, "decision").is_null()) return s;
  s.decision = read_check_entry(member_of(j, "decision"), where);
  if (s.decision->kind != CheckEntry::Kind::decision)
    throw Error(where, msg("holds no decision"), msg("use an intact copy"));
  return s;
}

Message in_words(const SessionCheck& s) {
  const ArmFigures& f = s.check.figures;
  const CheckVerdict& v = s.check.verdict;
  const std::string on = utc_text(s.check.utc_ns);
  List parts{
      {f.doubt.empty() ? msg("{}, checked on {}: {} (friction {}, step {}, {}, {} earlier checks)",
                             s.check.station, on, word_of(v.outcome), as_n(f.friction_n()),
                             as_mm(f.quantum_mm, 4), as_unit(f.rate_hz, Unit::hz, 0), v.compared)
                       : msg("{}, checked on {}: {}", s.check.station, on, word_of(v.outcome))},
      true};
  if (v.outcome == CheckOutcome::changed || v.outcome == CheckOutcome::doubtful)
    parts.items.push_back(in_words(v));
  if (v.outcome == CheckOutcome::changed)
    parts.items.push_back(msg("since {}", utc_text(s.check.since_utc_ns)));
  if (s.decision) {
    const CheckEntry& d = *s.decision;
    parts.items.push_back(d.go_on ? msg("the {} decided to go on", d.by)
                                  : msg("the {} decided to stop", d.by));
    if (!d.reason.empty()) parts.items.push_back(msg("reason: {}", d.reason));
  }
  return msg("{}", parts);
}

SessionCheckFindings check_of_session(const SessionReader& session) {
  SessionCheckFindings out;
  const std::string note = session.fact(std::string("note.") + k_self_check_note);
  if (note.empty()) return out;
  SessionCheck s;
  try {
    s = read_session_check(note, msg("the station's self-check in the session"));
  } catch (const Error& e) {
    out.findings.push_back(e.message());
    return out;
  }
  const auto wrong = [&out](const Message& what) { out.findings.push_back(what); };
  const std::string key = session.fact("station_key");
  if (s.check.station_key != key || (s.decision && s.decision->station_key != key))
    wrong(msg("the station's self-check is of another station than the session's"));
  if (s.check.stylus.id != session.fact(k_source_name_fact) ||
      s.check.stylus.serial != session.fact(k_source_serial_fact))
    wrong(msg("the station's self-check is of another stylus than the session's"));
  if (s.check.utc_ns > session.created().utc_ns)
    wrong(msg("the station's self-check is later than the session"));
  if (s.decision &&
      (!(s.decision->stylus == s.check.stylus) || s.decision->utc_ns < s.check.utc_ns))
    wrong(msg("the station's self-check and the decision on it do not belong together"));
  if (s.check.verdict.outcome == CheckOutcome::changed && !(s.decision && s.decision->go_on))
    wrong(msg("the station's self-check found a change, and nobody decided to go on with it"));
  out.remarks.push_back(msg("self-check of {}", in_words(s)));
  return out;
}

}  // namespace cavum
